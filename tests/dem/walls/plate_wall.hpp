// Closed plates cut at random.
#pragma once

#include <utility>
#include <vector>

#include "wall_scenes.hpp"

namespace dovetail::dem {

/// A closed plate of 5 × 5 squares from the origin, with a rough top and the same below.
inline TriangulatedWall plate(Random& random, double edge, double roughness, double thickness) {
  constexpr int n = 5, side = n + 1;
  std::vector<double> z(side * side);
  for (double& height : z) height = random(-roughness, roughness);
  std::vector<Vec3> x;
  for (const double down : {0.0, thickness})
    for (int k = 0; k < side * side; ++k)
      x.push_back({k % side * edge, k / side * edge, z[static_cast<std::size_t>(k)] - down});
  std::vector<geometry::Facet> facets;
  const auto quadrangle = [&](int a, int b, int c, int d, bool cut) {
    if (cut)
      facets.insert(facets.end(), {{a, b, c}, {a, c, d}});
    else
      facets.insert(facets.end(), {{a, b, d}, {b, c, d}});
  };
  const auto at = [&](int i, int j, int layer) { return (layer * side + j) * side + i; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      // The same above and below: a thin plate cut differently would cut itself.
      const bool cut = random(0, 1) < 0.5;
      quadrangle(at(i, j, 0), at(i + 1, j, 0), at(i + 1, j + 1, 0), at(i, j + 1, 0), cut);
      quadrangle(at(i, j, 1), at(i, j + 1, 1), at(i + 1, j + 1, 1), at(i + 1, j, 1), cut);
    }
  for (int i = 0; i < n; ++i) {
    quadrangle(at(i, 0, 1), at(i + 1, 0, 1), at(i + 1, 0, 0), at(i, 0, 0), random(0, 1) < 0.5);
    quadrangle(at(i + 1, n, 1), at(i, n, 1), at(i, n, 0), at(i + 1, n, 0), random(0, 1) < 0.5);
    quadrangle(at(0, i + 1, 1), at(0, i, 1), at(0, i, 0), at(0, i + 1, 0), random(0, 1) < 0.5);
    quadrangle(at(n, i, 1), at(n, i + 1, 1), at(n, i + 1, 0), at(n, i, 0), random(0, 1) < 0.5);
  }
  return makeWall(std::move(x), std::move(facets), true);
}

}  // namespace dovetail::dem
