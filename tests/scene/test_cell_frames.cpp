// Points of solids and grains of their cells in frames.
#include <array>
#include <cmath>
#include <sstream>

#include "../io/scratch_folder.hpp"
#include "cell_blocks.hpp"
#include "dovetail/io_vtk/frame_reader.hpp"
#include "dovetail/scene/execute.hpp"

namespace dovetail::scene::test {
namespace {

using io::FrameArray;
using io::FrameContent;
using io::test::ScratchFolder;

/// Of a run of 10 ms. @param cells  value of "cells" of the output
std::string runWith(const std::string& cells, double time = 0.01) {
  return R"("steps": {"safety": 0.8}, "stages": [{"do": "run", "time": )" + std::to_string(time) +
         R"(}], "output": {"frames": 2e-3, "checkpoints": 4e-3, "cells": )" + cells +
         R"(, "contents": ["solids", "stress", "strain", "cells", "points", "contacts", "spin"]})";
}
const std::string corner = R"([{"name": "corner", "solid": "block", "at": [0, 0, 0]}])";
const Scene shown = blockScene(runWith(corner));

FrameContent lastFrame(const std::filesystem::path& pvd) {
  const auto frames = io::readPvd(pvd);
  return io::readFrame(frames.back().second);
}
const std::vector<double>& valuesOf(const FrameContent& frame, const char* name, bool perCell) {
  static const std::vector<double> none;
  const FrameArray* const array = frame.find(name, perCell);
  EXPECT_TRUE(array) << name;
  return array ? array->values : none;
}

TEST(CellFrames, PointsHaveWhatElementsHaveTheMeansOf) {
  const ScratchFolder folder;
  std::ostringstream log;
  ASSERT_TRUE(run(shown, {.folder = folder / "out", .progress = false}, log));
  const FrameContent points = lastFrame(folder / "out/points_block.pvd"),
                     solid = lastFrame(folder / "out/solid_block.pvd");
  ASSERT_EQ(points.position.size(), 4U);
  EXPECT_EQ(points.time, solid.time);
  EXPECT_EQ(valuesOf(points, "element", false), (std::vector<double>(4, 0.0)));
  for (const char* const name : {"void_ratio", "coordination", "sliding", "shear_strain", "volume_strain"}) {
    double mean = 0.0;
    for (const double value : valuesOf(points, name, false)) mean += 0.25 * value;
    EXPECT_NEAR(valuesOf(solid, name, true)[0], mean, 1e-12 * (1.0 + std::abs(mean))) << name;
  }
  // The nodes of one element move linearly along its edges: u is that of the map X + u.
  const std::vector<double>&u = valuesOf(points, "displacement", false),
        &F = valuesOf(points, "deformation_gradient", false);
  double across = 0.0;
  for (std::size_t p = 0; p < 4; ++p) across += 0.25 * F[9 * p + 4];
  EXPECT_LT(across, 1.0 - 1e-6);
  const auto [low, high] = std::ranges::minmax(std::array{u[1], u[4], u[7], u[10]});
  const double apart = 0.2 / std::sqrt(3.0);  // of the points, along y
  EXPECT_NEAR(high - low, apart * (1.0 - across), 1e-9);
}

TEST(CellFrames, GrainsOfACellCarryItsStress) {
  const ScratchFolder folder;
  std::ostringstream log;
  ASSERT_TRUE(run(shown, {.folder = folder / "out", .progress = false}, log));
  EXPECT_EQ(log.str().find("no grains"), std::string::npos);  // contacts and spins are those of the cell
  EXPECT_FALSE(std::filesystem::exists(folder / "out/contacts.pvd"));
  const FrameContent grains = lastFrame(folder / "out/cell_corner.pvd"),
                     lines = lastFrame(folder / "out/cell_corner_contacts.pvd"),
                     points = lastFrame(folder / "out/points_block.pvd");
  ASSERT_EQ(grains.position.size(), 60U);
  EXPECT_EQ(valuesOf(grains, "spin", false).size(), 3 * 60U);
  // Σ f ⊗ b over the volume is the stress of the point: with the area of the grains and the void ratio of the point.
  double area = 0.0, yy = 0.0, xy = 0.0, sliding = 0.0;  // xy: symmetric, as the stress is
  for (const double r : valuesOf(grains, "radius", false)) area += 3.14159265358979 * r * r;
  const std::vector<double>& force = valuesOf(lines, "force", true);
  for (std::size_t c = 0; c < lines.cells; ++c) {
    const Vec3 branch = lines.position[2 * c + 1] - lines.position[2 * c];
    yy += force[3 * c + 1] * branch.y;
    xy += 0.5 * (force[3 * c] * branch.y + force[3 * c + 1] * branch.x);
    sliding += valuesOf(lines, "sliding", true)[c] / static_cast<double>(lines.cells);
  }
  std::size_t nearest = 0;
  for (std::size_t p = 0; p < 4; ++p)
    if (norm(points.position[p]) < norm(points.position[nearest])) nearest = p;
  const double volume = 0.1 * area * (1.0 + valuesOf(points, "void_ratio", false)[nearest]);
  const double sigma = valuesOf(points, "stress", false)[9 * nearest + 4];
  EXPECT_NEAR(yy / volume, sigma, 1e-6 * std::abs(sigma));
  EXPECT_NEAR(xy / volume, valuesOf(points, "stress", false)[9 * nearest + 1], 1e-6 * std::abs(sigma));
  EXPECT_NEAR(sliding, valuesOf(points, "sliding", false)[nearest], 1e-12);
}

/// Bit by bit; the provenance, which names the threads, apart.
void expectSameFrames(const FrameContent& a, const FrameContent& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_TRUE(a.cellType == b.cellType && a.cellEnd == b.cellEnd && a.cellPoint == b.cellPoint);
  EXPECT_EQ(a.position, b.position);
  ASSERT_EQ(a.arrays.size(), b.arrays.size());
  for (std::size_t k = 0; k < a.arrays.size(); ++k) {
    EXPECT_EQ(a.arrays[k].name, b.arrays[k].name);
    EXPECT_EQ(a.arrays[k].values, b.arrays[k].values) << a.arrays[k].name;
  }
}

TEST(CellFrames, AreTheSameAfterABreak) {
  const ScratchFolder folder;
  std::ostringstream log;
  ASSERT_TRUE(run(shown, {.folder = folder / "whole", .progress = false, .threads = 1}, log));
  ASSERT_TRUE(
      run(blockScene(runWith(corner, 0.004)), {.folder = folder / "broken", .progress = false, .threads = 1}, log));
  ASSERT_TRUE(resume({.folder = folder / "broken", .progress = false, .until = 0.01, .threads = 2}, log));
  for (const std::string name : {"points_block", "cell_corner", "cell_corner_contacts"}) {
    SCOPED_TRACE(name);
    ASSERT_EQ(io::readPvd(folder / ("whole/" + name + ".pvd")).size(),
              io::readPvd(folder / ("broken/" + name + ".pvd")).size());
    expectSameFrames(lastFrame(folder / ("whole/" + name + ".pvd")), lastFrame(folder / ("broken/" + name + ".pvd")));
  }
}

TEST(CellFrames, WhatCannotBeShownIsRefused) {
  const auto refusal = [](const std::string& output) {
    const ScratchFolder folder;
    std::ostringstream log;
    try {
      run(blockScene(R"("steps": {"safety": 0.8}, "stages": [{"do": "run", "time": 0.01}], "output": )" + output),
          {.folder = folder / "out", .progress = false}, log);
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  expectParts(refusal(R"({"cells": [{"name": "a", "solid": "block", "at": [0, 0, 0]}]})"), {"cells", "no frames"});
  expectParts(refusal(R"({"frames": 1e-3, "cells": [{"name": "a", "solid": "blok", "at": [0, 0, 0]}]})"),
              {"output.cells.0", "blok"});
  expectParts(refusal(R"({"frames": 1e-3, "cells": [{"name": "a", "solid": "block", "at": [0, 0, 0]},
      {"name": "a", "solid": "block", "at": [1, 0, 0]}]})"),
              {"output.cells.1", "another cell"});
  expectParts(refusal(R"({"frames": 1e-3, "contents": ["stress"]})"), {"stress", "points"});
}

}  // namespace
}  // namespace dovetail::scene::test
