// Warnings about a scene, one sentence each.
#pragma once

#include <string>
#include <vector>

#include "parts.hpp"

namespace dovetail::scene {

using Lines = std::vector<std::string>;

/// Three digits.
std::string rounded(double value);
inline std::string quoted(const std::string& name) { return "\"" + name + "\""; }

/// Widths, densities and moduli of the overlap with a solid, by its number.
void lookAtOverlap(const Built& built, const Scene& scene, std::size_t solid, const Overlap& overlap, Lines& lines);
/// Grains that came into solids where no overlap holds them.
Lines strangersIn(const Built& built);

}  // namespace dovetail::scene
