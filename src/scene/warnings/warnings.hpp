// Warnings about a scene, one sentence each.
#pragma once

#include <string>
#include <vector>

#include "build/parts.hpp"

namespace dovetail::scene {

using Lines = std::vector<std::string>;

/// Three digits.
std::string rounded(double value);
/// "(0, 0, 0.1) m"
std::string placeText(const Vec3& x);
std::string percent(double fraction);
/// "walls.3"
inline std::string item(const std::string& list, std::size_t k) { return list + "." + std::to_string(k); }
inline std::string quoted(const std::string& name) { return "\"" + name + "\""; }

/// The first of the lines that differ in numbers and names alone, with the number of the others.
Lines onePerKind(const Lines& lines);
/// Widths, densities and moduli of the overlap with a solid, by its number.
void lookAtOverlap(const Built& built, const Scene& scene, std::size_t solid, const Overlap& overlap, Lines& lines);
/// Layers across thin parts of a solid, by its number, that bend otherwise than the material does.
void lookAtThickness(const Built& built, const Scene& scene, std::size_t number, Lines& lines);
/// Bands of a softening solid, by its number, that are too narrow for its elements or lock in them.
void lookAtBands(const Built& built, const Scene& scene, std::size_t number, Lines& lines);
/// Moduli, densities, sizes and steps that do not go with each other.
void lookAtRelations(const Built& built, const Scene& scene, Lines& lines);
/// Probes, insertions, solids, walls and paths that are not where the others are.
void lookAtCompany(const Built& built, const Scene& scene, Lines& lines);
/// Items of a list that say the same, and loads, supports, drives and overlaps that undo each other.
void lookForContradictions(const Built& built, const Scene& scene, Lines& lines);
/// Solids and walls that move into each other.
void lookForMeetings(const Built& built, const Scene& scene, Lines& lines);
/// Walls, couplings and bonds that do nothing of use, and places against periods, other solids or themselves.
void lookForIdleParts(const Built& built, const Scene& scene, Lines& lines);
/// Grains that nothing keeps from falling while a stage relaxes.
void lookForFalling(const Built& built, const Scene& scene, Lines& lines);
/// Grains in a solid that no overlap lets be there.
void lookForGrainsWithin(const Built& built, std::size_t solid, Lines& lines);
/// Insertions whose region lies in a solid.
void lookForStreamsWithin(const Built& built, const Scene& scene, std::size_t solid, Lines& lines);
/// Solids that lie in each other or in walls.
void lookForBodiesWithin(const Built& built, const Scene& scene, Lines& lines);
/// Surfaces of walls that are open, closed or cut themselves against what is written.
void lookAtWalls(const Built& built, Lines& lines);
/// Solids that hold much of their energy in hourglass stiffness, now.
Lines hourglassIn(const Built& built);
/// Grains that came into solids where no overlap holds them.
Lines strangersIn(const Built& built);

}  // namespace dovetail::scene
