// Frequencies of the solids of a run.
#pragma once

#include <cstddef>
#include <filesystem>

#include "dovetail/io/provenance.hpp"
#include "dovetail/scene/build.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene {

/// Finds the lowest frequencies of all solids as they are now and writes them into a file, behind those that earlier
/// stages have found: a row per stage, solid and mode.
/// @param stage  that asks for them, counted from 0. @return a line for each solid
/// @throws as fem::modesOf, with the place of the stage
Lines findModes(const Built& built, const Scene& scene, std::size_t stage, const std::filesystem::path& file,
                const io::KeyValues& provenance);

}  // namespace dovetail::scene
