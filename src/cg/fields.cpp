#include "dovetail/cg/fields.hpp"

#include <string>

#include "dovetail/cg/stress.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "sweep.hpp"

namespace dovetail::cg {

namespace {

constexpr std::size_t grain = 32;

void requireSame(std::size_t a, std::size_t b, const std::string& what) {
  if (a != b)
    throw InputError("the lengths " + std::to_string(a) + " and " + std::to_string(b) + " differ", what,
                     "give one value per item");
}

void requireDimension(const Kernel& kernel, int dimension) {
  requireValid(kernel);
  if (kernel.dimension != dimension)
    throw InputError("the kernel's dimension is " + std::to_string(kernel.dimension), "kernel dimension",
                     "give a kernel of dimension " + std::to_string(dimension));
}

/// Σ −f W(x − x_c) at the points.
std::vector<Vec3> spreadReactions(const Kernel& kernel, std::span<const Vec3> points, std::span<const Vec3> contact,
                                  std::span<const Vec3> force) {
  requireSame(contact.size(), force.size(), "contact points and forces");
  const double peak = kernel.peak();
  const AxisSweep sweep(contact, "contact");
  std::vector<Vec3> density(points.size());
  parallelFor(points.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (int i : sweep.near(points[p], kernel.width))
        density[p] -= peak * profile(kernel.shape, norm(points[p] - contact[i]) / kernel.width) * force[i];
  });
  return density;
}

}  // namespace

Fields particleFields(const Kernel& kernel, std::span<const Vec3> points, const ParticleView& particles) {
  requireSame(particles.x.size(), particles.v.size(), "particle positions and velocities");
  requireSame(particles.x.size(), particles.mass.size(), "particle positions and masses");
  const double peak = kernel.peak();
  const AxisSweep sweep(particles.x, "particle");
  Fields fields{std::vector<double>(points.size()), std::vector<Vec3>(points.size()), std::vector<Vec3>(points.size())};
  parallelFor(points.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      for (int i : sweep.near(points[p], kernel.width)) {
        const double share =
            particles.mass[i] * peak * profile(kernel.shape, norm(points[p] - particles.x[i]) / kernel.width);
        fields.density[p] += share;
        fields.momentum[p] += share * particles.v[i];
      }
      if (fields.density[p] > 0.0) fields.velocity[p] = fields.momentum[p] / fields.density[p];
    }
  });
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

std::vector<Vec3> boundaryForceDensity(const Kernel& kernel, std::span<const Vec3> points,
                                       std::span<const Vec3> contact, std::span<const Vec3> force) {
  return spreadReactions(kernel, points, contact, force);
}

std::vector<Vec3> surfaceTraction(const Kernel& kernel, std::span<const Vec3> points, std::span<const Vec3> contact,
                                  std::span<const Vec3> force) {
  requireDimension(kernel, 2);
  return spreadReactions(kernel, points, contact, force);
}

void addKineticTraction(const Kernel& kernel, std::span<const Vec3> points, std::span<const Vec3> normal,
                        const ParticleView& particles, std::span<Vec3> traction) {
  requireDimension(kernel, 3);
  requireSame(points.size(), normal.size(), "points and normals");
  requireSame(points.size(), traction.size(), "points and tractions");
  const std::vector<Eigen::Matrix3d> stress = kineticStress(kernel, points, particles);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Eigen::Vector3d t = stress[p] * Eigen::Vector3d(normal[p].x, normal[p].y, normal[p].z);
    traction[p] += {t[0], t[1], t[2]};
  }
}

}  // namespace dovetail::cg
