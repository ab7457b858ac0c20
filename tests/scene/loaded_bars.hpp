// Solids in load steps, for tests.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "scene_parts.hpp"

namespace dovetail::scene::test {

/// A bar of 1 × 1 × 4 along z, E = 1 MPa, ν = 0, held at z-.
inline std::string bar(const std::string& keys, const std::string& support = R"({"on": "z-"})") {
  return R"("solids": [{"name": "bar", "mesh": "box", "cells": [1, 1, 4], "box": [[0, 0, 0], [1, 1, 4]],
      "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6, "poisson_ratio": 0, "density": 1000},
      "supports": [)" +
         support + "], " + keys + "}],";
}
inline Scene staticScene(const std::string& middle, const std::string& stages) {
  return sceneFromText("{" + middle + R"("steps": {"dt": 1e-4}, "stages": [)" + stages + "]}", "s.json", "/");
}
/// All load steps of the first stage.
inline Built loaded(const Scene& scene) {
  Built built = started(scene);
  const auto& stage = std::get<Statics>(scene.stages.front().kind);
  for (std::int64_t k = 0; k < stage.loadSteps; ++k)
    built.run->loadStep(k, stage.loadSteps, stage.time.value_or(0.0) / static_cast<double>(stage.loadSteps));
  return built;
}
inline std::size_t nodeAt(const Built& built, const Vec3& at) {
  const std::vector<Vec3>& X = built.meshes[0].X;
  return static_cast<std::size_t>(std::ranges::min_element(X, {}, [&](const Vec3& x) { return squaredNorm(x - at); }) -
                                  X.begin());
}
inline Vec3 displacementAt(const Built& built, const Vec3& at) {
  return built.run->solid(0).nodes().u[nodeAt(built, at)];
}
inline double channel(Built& built, const std::string& name) {
  for (const auto& one : built.run->ledger().channels())
    if (one.name == name) return one.joules;
  ADD_FAILURE() << "no channel " << name;
  return 0.0;
}
inline const std::string pulled = R"("loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 1000]}])";

}  // namespace dovetail::scene::test
