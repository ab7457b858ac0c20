// Scenes of earlier versions.
#pragma once

#include <string>
#include <vector>

namespace dovetail::scene {

struct Upgrade {
  std::string text;                  ///< the scene with today's names; all else, comments too, as it was
  std::vector<std::string> changes;  ///< "scene.json:3:14: \"per_window\" is \"per_macro_step\""
};
/// Updates renamed keys and words of a scene. Files that it includes are not touched.
/// @param name  of the file, for messages
/// @throws InputError for what is no JSON
Upgrade upgraded(const std::string& text, const std::string& name);

}  // namespace dovetail::scene
