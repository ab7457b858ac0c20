// Any bytes as a state with a right checksum: it is refused by an InputError and the run stays as it was, or it is
// loaded and the run steps or breaks down with an Error. The same bytes as a whole file are refused or read.
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "checkpoints.hpp"
#include "dovetail/core/archive.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/scene/build.hpp"
#include "dovetail/scene/read.hpp"

using namespace dovetail;
namespace fs = std::filesystem;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using Bytes = std::vector<char>;

/// Grains with friction that rolls, a clump, a wall that moves, grains that come, a solid that yields under a surface
/// and one in an overlap.
constexpr const char* smallScene = R"({
  "gravity": [0, 0, -9.81],
  "contact": {"law": "linear", "stiffness": 2e4, "restitution": 0.5, "friction": 0.4, "rolling": {"friction": 0.1, "stiffness_ratio": 0.2}},
  "particles": [
    {"from": "list", "density": 2500, "spheres": [{"at": [0.05, 0.05, 0.1095], "radius": 0.01},
      {"at": [0.05, 0.062, 0.1255], "radius": 0.01}]},
    {"from": "lattice", "box": [[0, 0, 0.2], [0.04, 0.04, 0.28]], "radius": 0.01, "density": 2500}
  ],
  "walls": [{"shape": "plane", "point": [0, 0, 0.3], "normal": [0, 0, -1], "velocity": [0, 0, -0.1]}],
  "clumps": [{"spheres": [{"at": [-0.01, 0, 0], "radius": 0.012}, {"at": [0.01, 0, 0], "radius": 0.012}],
              "density": 2500, "at": [0.03, 0.02, 0.111]}],
  "insertions": [{"region": [[0, 0, 0.12], [0.1, 0.1, 0.18]], "radius": {"smallest": 0.004, "largest": 0.005},
                  "density": 2500, "number_per_second": 2000}],
  "solids": [
    {"name": "floor", "mesh": "box", "cells": [1, 1, 1], "box": [[0, 0, 0], [0.1, 0.1, 0.1]],
     "material": {"law": "J2", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1800, "yield_stress": 1e3},
     "supports": [{"on": "z-"}]},
    {"name": "lid", "mesh": "box", "cells": [1, 1, 6], "box": [[0, 0, 0.22], [0.04, 0.04, 0.34]],
     "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1800},
     "supports": [{"on": "z+"}]}
  ],
  "couplings": [{"type": "surface", "solid": "floor", "on": "z+"},
                {"type": "overlap", "solid": "lid", "axis": "z", "solid_border": 0.22, "particle_border": 0.28}],
  "steps": {"dt": 2e-5, "per_macro_step": 2},
  "stages": [{"do": "run", "time": 0.1}]
})";

const char* const hash = "0123456789abcdef";

scene::Built makeRun() {
  const scene::Scene file = scene::sceneFromText(smallScene, "s.json", "/");
  scene::Built built = scene::build(file);
  scene::start(built, file);
  built.run->advance(100);
  return built;
}

coupling::CoupledRun& run() {
  static scene::Built built = makeRun();
  return *built.run;
}
const Bytes& goodState() {
  static const Bytes state = run().save();
  return state;
}

/// In memory where the system has such a folder.
const fs::path& folder() {
  static const fs::path made = [] {
    const fs::path base = fs::exists("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path();
    fs::path path = base / ("dovetail-fuzz-" + std::to_string(getpid()));
    fs::create_directories(path);
    std::atexit([] { fs::remove_all(folder()); });
    return path;
  }();
  return made;
}

void requireSame(const Bytes& state, const char* what) {
  if (run().save() == state) return;
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

void loadBytes(const Bytes& bytes) {
  try {
    run().load(bytes);
  } catch (const InputError&) {
    requireSame(goodState(), "a refused state has changed the run");
    return;
  }
  try {
    run().advance(2);
  } catch (const Error&) {  // numbers may be wild
  }
  run().load(goodState());
  requireSame(goodState(), "after another state the good one is not what it was");
}

void readFile(const Bytes& bytes) {
  const fs::path file = folder() / "checkpoint.state";
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  try {
    scene::loadCheckpoint(file);
  } catch (const InputError&) {
  }
}

void readState(const Bytes& bytes) {
  const fs::path file = folder() / "whole.state";
  writeChecked(file, scene::checkpointKind, bytes);
  try {
    loadBytes(scene::loadCheckpoint(file).state);
  } catch (const InputError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Bytes bytes(data + 1, data + size);
  switch (data[0] % 8) {
    case 0:
      readFile(bytes);
      break;
    case 1:
      readState(bytes);
      break;
    default:
      loadBytes(bytes);
  }
  return 0;
}

/// Begins with states as runs write them.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  const auto begin = [&](std::uint8_t way, const Bytes& bytes) {
    if (bytes.size() + 1 > most) return LLVMFuzzerMutate(data, size, most);
    data[0] = way;
    std::copy(bytes.begin(), bytes.end(), data + 1);
    return 1 + LLVMFuzzerMutate(data + 1, bytes.size(), most - 1);
  };
  if (size > 64 && seed % 64 != 0) return LLVMFuzzerMutate(data, size, most);
  if (seed % 3 == 0) return begin(2, goodState());
  scene::writeCheckpoint(folder(), hash, scene::Progress{.frames = {0.0, 1e-3}}, run());
  if (seed % 3 == 1) return begin(1, readChecked(folder() / "checkpoint.state", scene::checkpointKind));
  std::ifstream stream(folder() / "checkpoint.state", std::ios::binary);
  return begin(0, Bytes(std::istreambuf_iterator<char>(stream), {}));
}
