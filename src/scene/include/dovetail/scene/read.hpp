// Scenes from JSON and back.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dovetail/scene/scene.hpp"

namespace dovetail::scene {

/// Reads a scene: JSON with // and /* */ comments. Numbers may be text with a unit ("5 mm"), or an expression of the
/// parameters in "let" ("2*radius"). Names of files are relative to the scene's folder.
/// @param settings  "key=value": a parameter, or a path of keys such as "steps.dt" or "walls.0.radius"
/// @throws InputError naming file, line and column for what cannot be read, keys that are unknown (with the nearest
///   name that is known), missing or twice, and values of a wrong type or unit or out of range
Scene readScene(const std::filesystem::path& file, const std::vector<std::string>& settings = {});
/// The same from text. @param name  for messages @param folder  that names of files are relative to
Scene sceneFromText(const std::string& text, const std::string& name, const std::filesystem::path& folder,
                    const std::vector<std::string>& settings = {});

/// The scene in full: every key with its value, in SI units; readScene gives the same scene.
std::string sceneText(const Scene& scene);

/// JSON Schema (draft 2020-12) of scene files.
std::string schemaText();
/// All keys with type, unit, default and help, as Markdown.
std::string referenceText();

}  // namespace dovetail::scene
