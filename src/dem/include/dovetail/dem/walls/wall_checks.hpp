// Checks of walls before the first step, and of meshes against a checkpoint.
#pragma once

#include <cstdint>
#include <limits>

#include "dovetail/dem/walls/mesh_wall.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"

namespace dovetail::dem {

/// @param materials  rows of the law table
/// @throws InputError: place, velocities or surface velocity not finite; an axis that is no unit vector; a radius that
///   is not > 0; a negative skin; a material without a law; a surface velocity that points out of the surface; a servo
///   without mass; a wall that does not repeat with the periods
void validate(const PrimitiveWall& wall, int materials = std::numeric_limits<int>::max(),
              const geometry::Periodicity& periodicity = {});
/// @throws InputError: arrays of unlike length, a vertex that is not finite, a facet without its vertices; a negative
///   skin; a material without a law; a surface velocity that is not finite; an empty motion, or one without offsets
void validate(const MeshWall& mesh, int materials = std::numeric_limits<int>::max());

/// Of what has been read from a state, whose bytes may be damaged: lists of unlike lengths, numbers that are not
/// finite.
/// @throws InputError
void requireWhole(const PrimitiveContacts& contacts);
void requireWhole(const WallContacts& contacts);

/// What the rows of contacts refer to.
struct WallRows {
  std::size_t particles, facets;
};
/// Memory of contacts, which follows every change in the particles' numbers.
/// @throws InputError naming a particle or facet that does not exist
void requireRows(const PrimitiveContacts& contacts, const WallRows& rows);
/// @param current  whether particles have the numbers that they had when contacts were found
void requireRows(const WallContacts& contacts, const WallRows& rows, bool current);

/// Of facets and the shape of the wall, wherever a motion has carried it: equal for equal meshes, and hardly ever for
/// others. The vertices of a wall moved by others do not count.
std::uint64_t fingerprint(const MeshWall& mesh);

}  // namespace dovetail::dem
