// Edges and faces of the element shapes, by local node numbers.
#pragma once

#include <array>
#include <span>

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::fem {

/// Corners of a shape, 8 or 4; the first nodes of an element.
int cornersOf(CellShape shape);
int cornersOf(FaceShape shape);

/// Pairs of corners in the order of the mid-edge nodes; the shapes of first order have the same edges.
std::span<const std::array<int, 2>> edgesOf(CellShape shape);

/// Faces, counter-clockwise from outside, with the mid-edge and centre nodes that the shape has; −1 beyond them.
/// Bricks: x−, x+, y−, y+, z−, z+ of the parent cell. Tetrahedra: 021, 013, 123, 032.
std::span<const Face> localFacesOf(CellShape shape);

/// Face `side` of an element as node numbers of the mesh.
Face faceOf(const CellGroup& group, std::size_t element, std::size_t side);

/// "quad4" and so on.
const char* name(FaceShape shape);

}  // namespace dovetail::fem
