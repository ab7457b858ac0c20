// Picks the particles that are near a triangulated wall, in one pass over all of them.
#pragma once

#include <vector>

#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/walls/wall.hpp"
#include "dovetail/dem/walls/wall_search.hpp"

namespace dovetail::dem {

/// Particles, or images of them, in the neighbourhood of a wall; by particle, then image.
struct NearWall {
  std::vector<int> particle;
  std::vector<Image> image;  ///< empty unless space repeats
  std::vector<Vec3> x;       ///< of the image, m
  std::vector<double> radius;
  double smallestRadius = 0.0;  ///< of all particles, m
};

/// All that are within radius + margin of a facet, and some more.
/// @throws NumericalError naming a particle whose position is not finite
NearWall nearWall(const Particles& particles, const TriangulatedWall& wall, double margin, const Vec3& period);

}  // namespace dovetail::dem
