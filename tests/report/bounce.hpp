// A small scene for the verbs of the program.
#pragma once

#include <string>

#include "../cantilever/program.hpp"

namespace dovetail::report {

using cantilever::test::Outcome;
using cantilever::test::runProgram;
using io::test::readText;
using io::test::ScratchFolder;
using io::test::writeText;

/// A grain on a spring-like wall: its energy is off by what the step leaves.
inline const char* const bouncing = R"({
  "title": "A grain bounces", "let": {"speed": "1 m/s", "share": 0.1}, "gravity": [0, 0, 0],
  "contact": {"law": "linear", "stiffness": 1e4, "restitution": 1},
  "particles": [{"from": "list", "density": 2500,
    "spheres": [{"at": [0, 0, 0.0101], "radius": "1 cm", "velocity": [0, 0, "-speed"]}]}],
  "walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
  "steps": {"dt": "auto", "safety": "share"}, "stages": [{"do": "run", "time": "0.5 ms"}],
  "output": {"series": "0.1 ms"}
})";

struct Bounce {
  ScratchFolder folder;
  std::string file = (folder / "bounce.json").string(), out = (folder / "out").string();
  Bounce() { writeText(file, bouncing); }
};

}  // namespace dovetail::report
