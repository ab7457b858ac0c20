#include "dovetail/cg/fields.hpp"

#include <cmath>

#include "checks.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "kernel_sum.hpp"
#include "near_items.hpp"
#include "segment_mean.hpp"

namespace dovetail::cg {

namespace {

using Eigen::Matrix3d;

constexpr std::size_t chunkSize = 32;

Eigen::Vector3d eigen(const Vec3& a) { return {a.x, a.y, a.z}; }

void check(const Kernel& kernel, std::span<const Vec3> points, const SnapshotView& snapshot) {
  if (!std::isfinite(kernel.peak()))
    throw InputError("the kernel's peak is beyond what a number can hold", "kernel width", "give a larger width");
  requireFiniteItems(points, "point", "position");
  const auto& [particles, branches, walls, space] = snapshot;
  requireSameLength(particles.x.size(), particles.v.size(), "particle positions and velocities");
  requireSameLength(particles.x.size(), particles.mass.size(), "particle positions and masses");
  if (!particles.volume.empty())
    requireSameLength(particles.x.size(), particles.volume.size(), "particle positions and volumes");
  requireSameLength(branches.from.size(), branches.to.size(), "starts and ends of contact branches");
  requireSameLength(branches.from.size(), branches.force.size(), "contact branches and forces");
  requireSameLength(walls.point.size(), walls.force.size(), "contact points on walls and forces");
  requireFiniteItems(particles.x, "particle", "position");
  requireFiniteItems(particles.v, "particle", "velocity");
  requireNotNegative(particles.mass, "particle", "mass");
  requireNotNegative(particles.volume, "particle", "volume");
  requireFiniteItems(branches.from, "contact branch", "start");
  requireFiniteItems(branches.to, "contact branch", "end");
  requireFiniteItems(branches.force, "contact branch", "force");
  requireFiniteItems(walls.point, "wall contact", "position");
  requireFiniteItems(walls.force, "wall contact", "force");
}

/// A particle in reach of a point, and its kernel there, 1/m^d.
struct Reached {
  std::size_t particle;
  double kernel;
};

void setFields(const ParticleView& particles, std::span<const Reached> reached, std::size_t p, Fields& fields) {
  double density = 0.0, volume = 0.0;
  Vec3 momentum;
  for (const auto& [i, kernel] : reached) {
    density += particles.mass[i] * kernel;
    momentum += (particles.mass[i] * kernel) * particles.v[i];
    if (!particles.volume.empty()) volume += particles.volume[i] * kernel;
  }
  fields.density[p] = density;
  fields.momentum[p] = momentum;
  if (!particles.volume.empty()) fields.solidFraction[p] = volume;
  if (!(density > 0.0)) return;
  const Vec3 mean = momentum / density;
  Matrix3d flux = Matrix3d::Zero();  // of momentum by fluctuations
  for (const auto& [i, kernel] : reached) {
    const Eigen::Vector3d v = eigen(particles.v[i] - mean);
    flux += (particles.mass[i] * kernel) * v * v.transpose();
  }
  fields.velocity[p] = mean;
  fields.kineticStress[p] = -flux;
  fields.temperature[p] = flux.trace() / (3.0 * density);
}

void addParticles(const Kernel& kernel, std::span<const Vec3> points, const SnapshotView& snapshot, Fields& fields) {
  const ParticleView& particles = snapshot.particles;
  const double peak = kernel.peak();
  const NearItems near(kernel, particles.x, {}, snapshot.space);
  parallelFor(points.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    std::vector<Reached> reached;
    for (std::size_t p = begin; p < end; ++p) {
      reached.clear();
      near.forEach(points[p], [&](std::size_t i, const Vec3& place) {
        const double value = profile(kernel.shape, norm(place - particles.x[i]) / kernel.width);
        if (value > 0.0) reached.push_back({i, peak * value});
      });
      setFields(particles, reached, p, fields);
    }
  });
}

void addBranches(const Kernel& kernel, std::span<const Vec3> points, const SnapshotView& snapshot, Fields& fields) {
  const BranchView& branches = snapshot.branches;
  std::vector<Vec3> middle(branches.from.size());
  std::vector<double> half(branches.from.size());
  for (std::size_t b = 0; b < middle.size(); ++b) {
    middle[b] = branches.from[b] + 0.5 * (branches.to[b] - branches.from[b]);
    half[b] = 0.5 * norm(branches.to[b] - branches.from[b]);
  }
  const double peak = kernel.peak();
  const NearItems near(kernel, middle, half, snapshot.space);
  parallelFor(points.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      Matrix3d sum = Matrix3d::Zero();
      near.forEach(points[p], [&](std::size_t b, const Vec3& place) {
        const double reach = kernel.width + half[b];
        if (squaredNorm(place - middle[b]) > reach * reach) return;
        const Vec3 &from = branches.from[b], &to = branches.to[b];
        const double mean = profileMean(kernel.shape, kernel.width, place - from, place - to);
        if (mean > 0.0) sum += mean * eigen(branches.force[b]) * eigen(from - to).transpose();
      });
      fields.contactStress[p] = -peak * sum;
    }
  });
}

}  // namespace

Fields sample(const Kernel& kernel, std::span<const Vec3> points, const SnapshotView& snapshot) {
  check(kernel, points, snapshot);
  const std::size_t n = points.size();
  Fields fields{.density = std::vector<double>(n),
                .solidFraction = std::vector<double>(snapshot.particles.volume.empty() ? 0 : n),
                .momentum = std::vector<Vec3>(n),
                .velocity = std::vector<Vec3>(n),
                .temperature = std::vector<double>(n),
                .kineticStress = std::vector<Matrix3d>(n, Matrix3d::Zero()),
                .contactStress = std::vector<Matrix3d>(n, Matrix3d::Zero()),
                .wallForce = std::vector<Vec3>(n)};
  addParticles(kernel, points, snapshot, fields);
  addBranches(kernel, points, snapshot, fields);
  addKernels(kernel, points, snapshot.walls, snapshot.space, 1.0, fields.wallForce);
  return fields;
}

std::vector<Vec3> gridPoints(const Grid& grid) {
  std::size_t total = 1;
  for (int c = 0; c < 3; ++c) {
    if (grid.count[c] < 1)
      throw InputError("a grid has " + std::to_string(grid.count[c]) + " points in direction " + std::to_string(c),
                       "grid count", "give 1 or more");
    if (grid.count[c] > 1) requirePositive(grid.spacing[c], "grid spacing");
    total *= static_cast<std::size_t>(grid.count[c]);
  }
  const auto place = [&](int c, int i) { return grid.lower[c] + (i > 0 ? i * grid.spacing[c] : 0.0); };
  std::vector<Vec3> points;
  points.reserve(total);
  for (int k = 0; k < grid.count[2]; ++k)
    for (int j = 0; j < grid.count[1]; ++j)
      for (int i = 0; i < grid.count[0]; ++i) points.push_back({place(0, i), place(1, j), place(2, k)});
  return points;
}

}  // namespace dovetail::cg
