// What the reader says to a text.
#pragma once

#include <filesystem>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/scene/read.hpp"

namespace dovetail::scene::test {

/// The message with which the text is refused; empty if it is read.
inline std::string refusal(const std::string& text, const std::vector<std::string>& settings = {}) {
  try {
    sceneFromText(text, "s.json", SCENES, settings);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// A small scene that has a bit of everything, one key per line.
inline const std::string smallScene = R"({
  "gravity": [0, 0, -9.81],
  "contact": {
    "law": "linear",
    "stiffness": "5 kN/m",
    "restitution": 0.5
  },
  "particles": [
    {"from": "list", "density": 2500,
     "spheres": [{"at": [0, 0, "15 mm"], "radius": "1 cm"}]}
  ],
  "walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
  "steps": {"dt": 1e-4},
  "stages": [{"do": "run", "time": 0.1}]
})";

inline std::filesystem::path starter(const std::string& name) {
  return std::filesystem::path(SCENES) / (name + ".json");
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("the scene has no " + from);
  return text.replace(at, from.size(), to);
}

}  // namespace dovetail::scene::test
