// Scenes that are part of others.
#pragma once

#include <filesystem>
#include <string>

#include "json_tree.hpp"

namespace dovetail::scene {

/// The bytes of a scene file. @throws InputError telling `where` if it cannot be read
std::string textOfScene(const std::filesystem::path& file, const std::string& where);

/// The scene with all that it includes, and without the key "include". Included scenes come first, in their order:
/// values of the scene itself take the place of theirs, objects are put together key by key, lists of objects one
/// behind the other. What is included twice counts once. Names of files are relative to the scene that has them.
/// @param name    of the file, for messages
/// @param folder  that its names are relative to
/// @throws InputError with the place in the file at fault: a file that cannot be read or is no JSON, no list of texts,
///         or a scene that includes itself, with all files between
Node withIncludes(Node scene, const std::string& name, const std::filesystem::path& folder);

}  // namespace dovetail::scene
