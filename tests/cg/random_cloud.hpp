// Particles, branches and wall contacts for tests of fields.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "dovetail/cg/fields.hpp"
#include "random_state.hpp"

namespace dovetail::cg::testing {

/// Particles, branches and wall contacts at random.
struct Cloud {
  std::vector<Vec3> x, v;
  std::vector<double> mass, volume;
  std::vector<Vec3> from, to, force;
  std::vector<Vec3> wallPoint, wallForce;
  geometry::Periodicity space{};
  SnapshotView snapshot() const { return viewOf(*this); }
  /// What has a place, and what has a direction.
  template <class Act>
  void forEachPlace(Act&& act) {
    for (auto* places : {&x, &from, &to, &wallPoint})
      for (Vec3& place : *places) act(place);
  }
  template <class Act>
  void forEachDirection(Act&& act) {
    for (auto* directions : {&v, &force, &wallForce})
      for (Vec3& direction : *directions) act(direction);
  }
};

inline Cloud randomCloud(RandomState& random, int n, int dimension) {
  Cloud cloud;
  cloud.x = random.vectors(n, -0.5, 0.5);
  cloud.v = random.vectors(n, -1.0, 1.0);
  for (int i = 0; i < n; ++i) {
    cloud.mass.push_back(random.number(0.5, 2.0));
    cloud.volume.push_back(random.number(0.001, 0.002));
    for (int c = dimension; c < 3; ++c) cloud.x[i][c] = 0.0;
  }
  return cloud;
}

/// With branches from very short to longer than the cloud, and walls.
inline Cloud randomContacts(RandomState& random, int n) {
  Cloud cloud = randomCloud(random, n, 3);
  for (int i = 0; i < n; ++i) {
    cloud.from.push_back(random.vector(-0.5, 0.5));
    cloud.to.push_back(cloud.from.back() + std::pow(10.0, random.number(-6.0, 0.3)) * random.vector(-1.0, 1.0));
  }
  cloud.force = random.vectors(n, -1.0, 1.0);
  cloud.wallPoint = random.vectors(n / 4, -0.5, 0.5);
  cloud.wallForce = random.vectors(n / 4, -1.0, 1.0);
  return cloud;
}

/// Largest difference of any field over its own largest value.
inline double difference(const Fields& a, const Fields& b) {
  const auto relative = [](const auto& x, const auto& y, auto&& size) {
    double largest = 0.0, off = 0.0;
    for (std::size_t p = 0; p < x.size(); ++p) {
      largest = std::max(largest, size(x[p]));
      off = std::max(off, size(x[p] - y[p]));
    }
    return off > 0.0 ? off / largest : 0.0;
  };
  const auto number = [](double x) { return std::abs(x); };
  const auto vector = [](const Vec3& x) { return norm(x); };
  const auto matrix = [](const Eigen::Matrix3d& x) { return x.norm(); };
  return std::max({relative(a.density, b.density, number), relative(a.solidFraction, b.solidFraction, number),
                   relative(a.temperature, b.temperature, number), relative(a.momentum, b.momentum, vector),
                   relative(a.velocity, b.velocity, vector), relative(a.wallForce, b.wallForce, vector),
                   relative(a.kineticStress, b.kineticStress, matrix),
                   relative(a.contactStress, b.contactStress, matrix)});
}

inline Eigen::Vector3d eigen(const Vec3& a) { return {a.x, a.y, a.z}; }

/// Every field by sums over everything.
inline Fields writtenOut(const Kernel& kernel, std::span<const Vec3> points, const Cloud& cloud) {
  const std::size_t n = points.size();
  const std::vector<Eigen::Matrix3d> zero(n, Eigen::Matrix3d::Zero());
  Fields sums{std::vector<double>(n),
              std::vector<double>(n),
              std::vector<Vec3>(n),
              std::vector<Vec3>(n),
              std::vector<double>(n),
              zero,
              zero,
              std::vector<Vec3>(n)};
  for (std::size_t p = 0; p < n; ++p) {
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
      const double w = kernel(norm(points[p] - cloud.x[i]));
      sums.density[p] += cloud.mass[i] * w;
      sums.solidFraction[p] += cloud.volume[i] * w;
      sums.momentum[p] += cloud.mass[i] * w * cloud.v[i];
    }
    if (sums.density[p] > 0.0) sums.velocity[p] = sums.momentum[p] / sums.density[p];
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
      const Eigen::Vector3d v = eigen(cloud.v[i] - sums.velocity[p]);
      sums.kineticStress[p] -= cloud.mass[i] * kernel(norm(points[p] - cloud.x[i])) * v * v.transpose();
    }
    if (sums.density[p] > 0.0) sums.temperature[p] = -sums.kineticStress[p].trace() / 3.0 / sums.density[p];
    for (std::size_t b = 0; b < cloud.from.size(); ++b)
      sums.contactStress[p] -= kernel.segmentMean(points[p] - cloud.from[b], points[p] - cloud.to[b]) *
                               eigen(cloud.force[b]) * eigen(cloud.from[b] - cloud.to[b]).transpose();
    for (std::size_t c = 0; c < cloud.wallPoint.size(); ++c)
      sums.wallForce[p] += kernel(norm(points[p] - cloud.wallPoint[c])) * cloud.wallForce[c];
  }
  return sums;
}

}  // namespace dovetail::cg::testing
