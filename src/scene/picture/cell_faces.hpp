// The surface of a solid's frame as triangles, and its section by a plane.
#pragma once

#include <cmath>
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
  double blur = 0.0;  ///< m: what is no farther away lies on the plane, as nodes do that it was laid through
  double height(const Vec3& x) const {
    const double away = sign * (x[axis] - at);
    return std::abs(away) > blur ? away : 0.0;
  }
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
