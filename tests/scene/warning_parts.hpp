// Scenes that are looked at for warnings.
#pragma once

#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {

/// All warnings about a scene, one behind the other.
inline std::string warningsOf(const Scene& scene) {
  const Built built = started(scene);
  std::string all;
  for (const std::string& one : warnings(built, scene)) all += one + "\n";
  return all;
}
inline std::string warningsOf(const std::string& middle, const std::filesystem::path& folder = "/") {
  return warningsOf(sceneOf(middle, folder));
}

inline const std::string heldBlock =
    R"("solids": [{"name": "b", "mesh": "box", "cells": [2, 2, 2], "box": [[0, 0, 0], [1, 1, 1]],
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000}, "supports": [{"on": "z-"}])";
inline const std::string onBlock = R"(}], "couplings": [{"type": "surface", "solid": "b", "kernel": "advised"}],)";

inline std::string spheres(const std::string& places) {
  return R"("particles": [{"from": "list", "density": 2500, "spheres": [)" + places + "]}],";
}
/// A grain that touches the block.
inline const std::string onTop = spheres(R"({"at": [0.5, 0.5, 1.1], "radius": 0.1})");
inline const std::string ground = R"("walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],)";

}  // namespace dovetail::scene::test
