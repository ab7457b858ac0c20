// Small scenes of the tests.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "dovetail/scene/build.hpp"
#include "dovetail/scene/read.hpp"

namespace dovetail::scene::test {

inline const std::string law =
    R"("contact": {"law": "linear", "stiffness": 1e4, "restitution": 0.8, "friction": 0.3},)";
inline const std::string end = R"("steps": {"dt": 1e-5}, "stages": [{"do": "run", "time": 1e-3}])";

/// The message with which a scene is not built; empty if it is.
inline std::string refusalOf(const Scene& scene) {
  try {
    build(scene);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

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

/// @param laws  keys of contacts, with a comma behind
inline Built startedWith(const std::string& laws, const std::string& middle) {
  return started(sceneFromText("{" + laws + middle + end + "}", "s.json", "/"));
}
inline std::string refusalWith(const std::string& laws, const std::string& middle) {
  try {
    startedWith(laws, middle);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}
inline void expectParts(const std::string& message, std::initializer_list<const char*> parts) {
  for (const char* const part : parts) EXPECT_NE(message.find(part), std::string::npos) << part << " in " << message;
}

}  // namespace dovetail::scene::test
