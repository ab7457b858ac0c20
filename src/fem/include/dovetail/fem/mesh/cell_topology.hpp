// Edges and faces of the element shapes, by local node numbers.
#pragma once

#include <array>
#include <span>

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::fem {

/// Corners of a shape; the first nodes of an element.
int cornersOf(ElementShape shape);
int cornersOf(FaceShape shape);

/// Pairs of corners in the order of the mid-edge nodes; the shapes of first order have the same edges.
std::span<const std::array<int, 2>> edgesOf(ElementShape shape);

/// Faces, counter-clockwise from outside, with the mid-edge and centre nodes that the shape has; −1 beyond them.
/// Bricks: x−, x+, y−, y+, z−, z+ of the parent cell. Tetrahedra: 021, 013, 123, 032. Plane cells: the lines x−, x+,
/// y−, y+ of the parent cell, 30, 12, 01, 23.
std::span<const Face> localFacesOf(ElementShape shape);

/// Face `side` of an element as node numbers of the mesh.
Face faceOf(const ElementGroup& group, std::size_t element, std::size_t side);

/// The first node whose z differs from that of the first one by more than 1e-9 of the longest side of the mesh along x
/// and y; −1 if all lie in one plane.
int nodeOffPlane(std::span<const Vec3> X);

/// "quad4" and so on.
const char* name(FaceShape shape);

}  // namespace dovetail::fem
