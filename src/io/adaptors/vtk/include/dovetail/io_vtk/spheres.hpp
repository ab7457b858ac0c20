// Spheres from VTK's XML files, such as the frames of a run.
#pragma once

#include <filesystem>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::io {

struct SphereTable {
  std::vector<Vec3> position;  ///< m
  std::vector<double> radius;  ///< m
  std::vector<Vec3> velocity;  ///< m/s; empty if the file has none
};

/// The points of a VTP or VTU file with their point arrays "radius" (one component) and, if there, "velocity" (three);
/// cells and other arrays are passed over.
/// @throws InputError, naming the file and the point, if it cannot be read, is neither of the two, is not complete, has
/// no
///   points or no radii, holds a number that is not finite, or a radius that is not > 0
SphereTable readSpheres(const std::filesystem::path& path);

}  // namespace dovetail::io
