// Points that nodes carry: vertices of a skin, control points of a smooth surface.
#pragma once

#include <span>
#include <vector>

#include "dovetail/cg/projection.hpp"
#include "dovetail/coupling/nodal_load.hpp"
#include "dovetail/surface/patch_offsets.hpp"

namespace dovetail::surface {

/// Places the given points: x = X + S u and v = S v, and what goes with their patches.
void placePoints(const cg::Projection& carrier, std::span<const Vec3> X, PatchOffsets& offsets, std::span<const Vec3> u,
                 std::span<const Vec3> v, std::span<const int> points, std::span<Vec3> x, std::span<Vec3> velocity);

/// Whether there is a force on a touched point: at seven of the sixteen control points of a contact there is none.
inline bool bears(const coupling::NodalLoad& onPoints, int point) {
  return onPoints.force[static_cast<std::size_t>(point)] != Vec3{};
}

/// Adds what forces on points, N, are on the nodes: the transpose of placing.
void addLoadOfPoints(const cg::Projection& carrier, const PatchOffsets& offsets, const coupling::NodalLoad& onPoints,
                     coupling::NodalLoad& load);

}  // namespace dovetail::surface
