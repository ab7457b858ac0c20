// Files of a run in its folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dovetail/scene/scene.hpp"

namespace dovetail::scene {

inline constexpr const char* modesFile = "modes.csv";  ///< of stages that find modes

/// What a run will write, frames apart. @param goesOn  states are there already, whole or damaged
std::vector<std::string> fileNames(const Scene& scene, bool goesOn);
/// Files that a new run may not write, or only at its end, with all frames.
void removeEarlierRun(const std::filesystem::path& folder);
/// What is said of a run that is done.
void removeEnd(const std::filesystem::path& folder);

/// A run puts its own files in place of earlier ones, but not of those that its scene reads.
/// @throws InputError if one of `files` is Dovetail's and in the folder, or in a folder within
void requireInputsElsewhere(const std::vector<std::string>& files, const std::filesystem::path& folder);

}  // namespace dovetail::scene
