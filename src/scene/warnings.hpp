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
/// Layers across thin parts of a solid, by its number, that bend otherwise than the material does.
void lookAtThickness(const Built& built, const Solid& solid, std::size_t number, Lines& lines);
/// Solids that hold much of their energy in hourglass stiffness, now.
Lines hourglassIn(const Built& built);
/// Grains that came into solids where no overlap holds them.
Lines strangersIn(const Built& built);

}  // namespace dovetail::scene
