// Clouds of spheres and the plain double loops that the grid is held against.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::geometry {

using Pairs = SpherePairs;

struct Cloud {
  std::vector<Vec3> x;
  std::vector<double> radius;
};

/// Centres uniform in [low, high]³, radii log-uniform in [1, ratio] × smallest.
inline Cloud randomCloud(std::size_t n, double ratio, double smallest, double low, double high, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> place(low, high), exponent(0.0, 1.0);
  Cloud cloud;
  for (std::size_t i = 0; i < n; ++i) {
    cloud.x.push_back({place(engine), place(engine), place(engine)});
    cloud.radius.push_back(smallest * std::pow(ratio, exponent(engine)));
  }
  if (n > 1) cloud.radius[0] = smallest, cloud.radius[n - 1] = smallest * ratio;
  return cloud;
}

/// Edge of the cube in which the cloud's spheres take up `solidFraction`.
inline double cubeFor(const Cloud& cloud, double solidFraction) {
  double volume = 0.0;
  for (double r : cloud.radius) volume += 4.0 / 3.0 * std::numbers::pi * r * r * r;
  return std::cbrt(volume / solidFraction);
}

inline Pairs allPairs(const Cloud& c, double skin = 0.0, const Periodicity& periodicity = {}) {
  Pairs pairs;
  for (std::size_t i = 0; i < c.x.size(); ++i)
    for (std::size_t j = i + 1; j < c.x.size(); ++j) {
      const double reach = (c.radius[i] + 0.5 * skin) + (c.radius[j] + 0.5 * skin);
      if (squaredNorm(periodicity.minimumImage(c.x[i] - c.x[j])) <= reach * reach)
        pairs.push_back({static_cast<int>(i), static_cast<int>(j)});
    }
  return pairs;
}

inline Pairs gridPairs(const Cloud& c, double skin = 0.0, const Periodicity& periodicity = {}) {
  HierarchicalGrid grid(periodicity);
  grid.build(c.x, c.radius, skin);
  return grid.pairs();
}

}  // namespace dovetail::geometry
