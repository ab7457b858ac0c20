// Points that fill a region, some along each axis of a cell of the grid.
#pragma once

#include <functional>

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/geometry/box.hpp"
#include "dovetail/mpm/point_solid.hpp"

namespace dovetail::mpm {

/// In the middle of equal parts of the box, whose edges are the spacing over `perAxis` or as near to it as whole
/// numbers let them. In the plane at z = 0, the extent along z being the thickness.
/// @throws InputError for a grid that is not valid, perAxis < 1, or a box without volume
MaterialPoints fillBox(const GridOptions& grid, const geometry::Box& box, int perAxis, const Vec3& velocity = {});

/// The faces of the parts that are those of the box, as a mesh without elements: places for markers, face and node
/// sets "x-" … "z+", the face set "skin", in the plane lines with the thickness of the box. @throws InputError as
/// fillBox
fem::SolidMesh facesOfBox(const GridOptions& grid, const geometry::Box& box, int perAxis);

/// In the middle of cubes (squares) of the spacing over `perAxis`, which begin at the grid's origin, where `inside`
/// says so within a box. They share the volume in equal parts.
/// @param volume  of the region, m³
/// @throws InputError as fillBox, for a volume that is not positive, and where no point lies inside
MaterialPoints fillInside(const GridOptions& grid, const geometry::Box& box, int perAxis,
                          const std::function<bool(const Vec3&)>& inside, double volume, const Vec3& velocity = {});

}  // namespace dovetail::mpm
