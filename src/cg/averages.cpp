#include "dovetail/cg/averages.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "checks.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "near_items.hpp"

namespace dovetail::cg {

namespace {

Eigen::Vector3d eigen(const Vec3& a) { return {a.x, a.y, a.z}; }

void requireBox(const AverageBox& box) {
  for (int k = 0; k < 3; ++k)
    if (!(std::isfinite(box.lower[k]) && std::isfinite(box.upper[k]) && box.lower[k] < box.upper[k]))
      throw InputError("the box is empty or not finite along axis " + std::to_string(k), "box to average over",
                       "give lower < upper");
}

void requireMatching(const BranchView& branches, const ParticleView& particles) {
  requireSameLength(branches.from.size(), branches.to.size(), "contact branches");
  requireSameLength(branches.from.size(), branches.force.size(), "contact branches and forces");
  requireSameLength(particles.x.size(), particles.v.size(), "particle positions and velocities");
  requireSameLength(particles.x.size(), particles.mass.size(), "particle positions and masses");
}

bool inside(const Vec3& x, const AverageBox& box) {
  for (int k = 0; k < 3; ++k)
    if (!(x[k] >= box.lower[k] && x[k] < box.upper[k])) return false;
  return true;
}

/// Fraction of a segment that lies in the box.
double fractionInside(const Vec3& from, const Vec3& to, const AverageBox& box) {
  double begin = 0.0, end = 1.0;
  for (int k = 0; k < 3; ++k) {
    const double d = to[k] - from[k];
    if (d == 0.0) {
      if (!(from[k] >= box.lower[k] && from[k] < box.upper[k])) return 0.0;
      continue;
    }
    const double low = (box.lower[k] - from[k]) / d, high = (box.upper[k] - from[k]) / d;
    begin = std::max(begin, std::min(low, high));
    end = std::min(end, std::max(low, high));
  }
  return std::max(0.0, end - begin);
}

template <class Wanted>
Eigen::Matrix3d kineticSum(const ParticleView& particles, Wanted&& wanted) {
  double mass = 0.0;
  Vec3 mean;
  for (std::size_t i = 0; i < particles.x.size(); ++i)
    if (wanted(i)) {
      mass += particles.mass[i];
      mean += particles.mass[i] * particles.v[i];
    }
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  if (mass > 0.0) mean = mean / mass;
  for (std::size_t i = 0; i < particles.x.size(); ++i)
    if (wanted(i)) {
      const Eigen::Vector3d v = eigen(particles.v[i] - mean);
      sum += particles.mass[i] * v * v.transpose();
    }
  return sum;
}

}  // namespace

Coordination coordination(std::span<const int> first, std::span<const int> second, int particles, int least) {
  requireSameLength(first.size(), second.size(), "particles of contacts");
  if (least < 0 || particles < 0)
    throw InputError("a number is below zero", "coordination", "give numbers of at least zero");
  for (std::size_t c = 0; c < first.size(); ++c)
    if (first[c] < 0 || first[c] >= particles || second[c] >= particles)
      throw InputError("there is no such particle", "contact " + std::to_string(c), "give numbers that exist");
  const auto n = static_cast<std::size_t>(particles);
  Coordination result;
  result.isRattler.assign(n, 0);
  const auto stays = [&](int i) { return i < 0 || !result.isRattler[static_cast<std::size_t>(i)]; };
  const auto count = [&] {
    std::vector<int> contacts(n, 0);
    for (std::size_t c = 0; c < first.size(); ++c) {
      if (!stays(first[c]) || !stays(second[c])) continue;
      ++contacts[static_cast<std::size_t>(first[c])];
      if (second[c] >= 0) ++contacts[static_cast<std::size_t>(second[c])];
    }
    return contacts;
  };
  const auto sum = [](const std::vector<int>& contacts) {
    double total = 0.0;
    for (const int k : contacts) total += k;
    return total;
  };
  result.contacts = count();
  std::vector<int> left = result.contacts;
  for (bool changed = true; changed; left = count()) {
    changed = false;
    for (std::size_t i = 0; i < n; ++i)
      if (!result.isRattler[i] && left[i] < least) {
        result.isRattler[i] = 1;
        ++result.rattlers;
        changed = true;
      }
  }
  if (n > 0) result.mean = sum(result.contacts) / static_cast<double>(n);
  if (particles > result.rattlers) result.withoutRattlers = sum(left) / (particles - result.rattlers);
  return result;
}

Eigen::Matrix3d fabric(std::span<const Vec3> normal) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Vec3& n : normal) sum += eigen(n) * eigen(n).transpose();
  return normal.empty() ? sum : Eigen::Matrix3d(sum / static_cast<double>(normal.size()));
}

std::vector<Eigen::Matrix3d> fabricField(const Kernel& kernel, std::span<const Vec3> points,
                                         std::span<const Vec3> contact, std::span<const Vec3> normal) {
  requireSameLength(contact.size(), normal.size(), "contact points and normals");
  requireValid(kernel);
  requireFiniteItems(points, "point", "position");
  requireFiniteItems(contact, "contact", "position");
  const NearItems near(kernel, contact, {}, {});
  std::vector<Eigen::Matrix3d> field(points.size(), Eigen::Matrix3d::Zero());
  parallelFor(points.size(), 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      double weight = 0.0;
      near.forEach(points[p], [&](std::size_t i, const Vec3& place) {
        const double w = profile(kernel.shape, norm(place - contact[i]) / kernel.width);
        weight += w;
        field[p] += w * eigen(normal[i]) * eigen(normal[i]).transpose();
      });
      if (weight > 0.0) field[p] /= weight;
    }
  });
  return field;
}

AverageStress loveWeberStress(const BranchView& branches, const ParticleView& particles, double volume) {
  requirePositive(volume, "volume to average over");
  requireMatching(branches, particles);
  AverageStress stress;
  for (std::size_t c = 0; c < branches.from.size(); ++c)
    stress.contact -= eigen(branches.force[c]) * eigen(branches.from[c] - branches.to[c]).transpose();
  stress.contact /= volume;
  stress.kinetic = -kineticSum(particles, [](std::size_t) { return true; }) / volume;
  return stress;
}

AverageStress loveWeberStress(const BranchView& branches, const ParticleView& particles, const AverageBox& box) {
  requireBox(box);
  requireMatching(branches, particles);
  AverageStress stress;
  for (std::size_t c = 0; c < branches.from.size(); ++c)
    stress.contact -= fractionInside(branches.from[c], branches.to[c], box) * eigen(branches.force[c]) *
                      eigen(branches.from[c] - branches.to[c]).transpose();
  stress.contact /= box.volume();
  stress.kinetic = -kineticSum(particles, [&](std::size_t i) { return inside(particles.x[i], box); }) / box.volume();
  return stress;
}

double solidFraction(std::span<const Vec3> x, std::span<const double> radius, const AverageBox& box) {
  requireSameLength(x.size(), radius.size(), "positions and radii");
  requireBox(box);
  const double filled = parallelSum(x.size(), 256, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += sphereInBox(x[i], radius[i], box);
    return sum;
  });
  return filled / box.volume();
}

}  // namespace dovetail::cg
