// Small scenes of the tests.
#pragma once

#include <string>

#include "dovetail/scene/build.hpp"
#include "dovetail/scene/read.hpp"

namespace dovetail::scene::test {

inline const std::string law =
    R"("contact": {"law": "linear", "stiffness": 1e4, "restitution": 0.8, "friction": 0.3},)";
inline const std::string end = R"("steps": {"dt": 1e-5}, "stages": [{"do": "run", "time": 1e-3}])";

inline Scene sceneOf(const std::string& middle, const std::filesystem::path& folder = "/") {
  return sceneFromText("{" + law + middle + end + "}", "s.json", folder);
}
inline Built started(const Scene& scene) {
  Built built = build(scene);
  start(built, scene);
  return built;
}
/// The message with which the run is refused.
inline std::string refusalOfRun(const std::string& middle) {
  try {
    started(sceneOf(middle));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace dovetail::scene::test
