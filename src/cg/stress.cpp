#include "dovetail/cg/stress.hpp"

#include <algorithm>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "sweep.hpp"

namespace dovetail::cg {

namespace {

constexpr std::size_t grain = 32;

Eigen::Vector3d eigen(const Vec3& a) { return {a.x, a.y, a.z}; }

void requireMatching(const BranchView& branches) {
  if (branches.from.size() != branches.to.size() || branches.from.size() != branches.force.size())
    throw InputError("there are " + std::to_string(branches.from.size()) + " starts, " +
                         std::to_string(branches.to.size()) + " ends and " + std::to_string(branches.force.size()) +
                         " forces",
                     "contact branches", "give one of each per contact");
}

}  // namespace

std::vector<Eigen::Matrix3d> contactStress(const Kernel& kernel, std::span<const Vec3> points,
                                           const BranchView& branches) {
  requireMatching(branches);
  requireValid(kernel);
  std::vector<Vec3> middle;
  double longest = 0.0;
  for (std::size_t i = 0; i < branches.from.size(); ++i) {
    middle.push_back(0.5 * (branches.from[i] + branches.to[i]));
    longest = std::max(longest, norm(branches.from[i] - branches.to[i]));
  }
  const AxisSweep sweep(middle, "contact branch");
  std::vector<Eigen::Matrix3d> stress(points.size(), Eigen::Matrix3d::Zero());
  parallelFor(points.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (int i : sweep.near(points[p], kernel.width + 0.5 * longest)) {
        const double mean = kernel.segmentMean(points[p] - branches.from[i], points[p] - branches.to[i]);
        stress[p] -= mean * eigen(branches.force[i]) * eigen(branches.from[i] - branches.to[i]).transpose();
      }
  });
  return stress;
}

std::vector<Eigen::Matrix3d> kineticStress(const Kernel& kernel, std::span<const Vec3> points,
                                           const ParticleView& particles) {
  const Fields fields = particleFields(kernel, points, particles);
  const double peak = kernel.peak();
  const AxisSweep sweep(particles.x, "particle");
  std::vector<Eigen::Matrix3d> stress(points.size(), Eigen::Matrix3d::Zero());
  parallelFor(points.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (int i : sweep.near(points[p], kernel.width)) {
        const Eigen::Vector3d fluctuation = eigen(particles.v[i] - fields.velocity[p]);
        const double share =
            particles.mass[i] * peak * profile(kernel.shape, norm(points[p] - particles.x[i]) / kernel.width);
        stress[p] -= share * fluctuation * fluctuation.transpose();
      }
  });
  return stress;
}

}  // namespace dovetail::cg
