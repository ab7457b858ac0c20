// The surface of a solid's frame as triangles, and its section by a plane.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "dovetail/io_vtk/frame_reader.hpp"
#include "dovetail/picture/draw.hpp"

namespace dovetail::scene {

/// What lies where sign · (x[axis] − at) > 0 is not drawn.
struct Cut {
  int axis = 0;
  double at = 0.0, sign = 1.0;
  double height(const Vec3& x) const { return sign * (x[axis] - at); }
};

/// Means over the cells that meet at each point.
std::vector<double> atPoints(const io::FrameContent& frame, const std::vector<double>& ofCells);

/// Faces that belong to one cell, and with a cut the section, with lines along the edges of cells.
/// @param place  of the points now, m @param value  per point, for the colours
std::vector<picture::Triangle> surfaceOf(const io::FrameContent& frame, const std::vector<Vec3>& place,
                                         const std::vector<float>& value, std::uint8_t paint,
                                         const std::optional<Cut>& cut);

/// Triangles without what the cut removes.
std::vector<picture::Triangle> behind(const std::vector<picture::Triangle>& triangles, const std::optional<Cut>& cut);

}  // namespace dovetail::scene
