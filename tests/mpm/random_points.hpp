// Points at random places, with random velocities.
#pragma once

#include <random>

#include "dovetail/fem/laws/materials.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/mpm/point_solid.hpp"

namespace dovetail::mpm::test {

inline const std::vector<Shape> shapes{Shape::linear, Shape::gimp, Shape::quadratic, Shape::cubic};

struct Random {
  std::mt19937_64 engine{7};
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
  Vec3 vector(double size, bool plane) {
    return {within(-size, size), within(-size, size), plane ? 0.0 : within(-size, size)};
  }
};

inline constexpr double density = 1000.0;
inline std::shared_ptr<fem::PointField> elastic(double youngs = 1e6, double poisson = 0.3) {
  return fem::pointField(fem::pointMaterial(fem::neoHookean(youngs, poisson, density)));
}

/// In the box from (0, 0, 0) to (1, 1, 1), in the plane at z = 0.
inline MaterialPoints scattered(std::size_t count, bool plane, Random& random) {
  MaterialPoints points;
  for (std::size_t p = 0; p < count; ++p) {
    points.x.push_back({random.within(0.0, 1.0), random.within(0.0, 1.0), plane ? 0.0 : random.within(0.0, 1.0)});
    points.v.push_back(random.vector(1.0, plane));
    points.volume.push_back(random.within(0.01, 0.03));
  }
  return points;
}

/// A regular block, points half of the spacing off its faces.
inline MaterialPoints block(const Vec3& low, const Vec3& size, double spacing, bool plane) {
  MaterialPoints points;
  const auto along = [&](double length) { return static_cast<int>(std::lround(length / spacing)); };
  const int layers = plane ? 1 : along(size.z);
  for (int k = 0; k < layers; ++k)
    for (int j = 0; j < along(size.y); ++j)
      for (int i = 0; i < along(size.x); ++i) {
        points.x.push_back(
            {low.x + spacing * (i + 0.5), low.y + spacing * (j + 0.5), plane ? 0.0 : low.z + spacing * (k + 0.5)});
        points.volume.push_back(spacing * spacing * (plane ? 1.0 : spacing));
      }
  points.v.resize(points.x.size());
  return points;
}

}  // namespace dovetail::mpm::test
