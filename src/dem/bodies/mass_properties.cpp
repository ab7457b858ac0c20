#include "dovetail/dem/bodies/mass_properties.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/geometry/surface_checks.hpp"
#include "volume_moments.hpp"

namespace dovetail::dem {

namespace {

Eigen::Vector3d eigen(const Vec3& a) { return {a.x, a.y, a.z}; }

void check(std::span<const Vec3> centre, std::span<const double> radius) {
  if (centre.empty() || centre.size() != radius.size())
    throw InputError(
        "there are " + std::to_string(centre.size()) + " centres and " + std::to_string(radius.size()) + " radii",
        "spheres of a body", "give one of each per sphere, and at least one");
  for (std::size_t i = 0; i < centre.size(); ++i) {
    const std::string where = "sphere " + std::to_string(i) + " of a body";
    if (!isFinite(centre[i])) throw InputError("not a finite vector", where + ", centre", "give three finite numbers");
    requirePositive(radius[i], "radius of " + where);
  }
}

/// Moments lose no digits to a far origin: all is taken about a point of the body.
std::vector<Vec3> about(std::span<const Vec3> x, const Vec3& origin) {
  std::vector<Vec3> moved;
  for (const Vec3& p : x) moved.push_back(p - origin);
  return moved;
}

}  // namespace

MassProperties massProperties(const VolumeMoments& moments, const Vec3& origin, Density density) {
  requirePositive(density.value, "density of a body");
  const Eigen::Vector3d centre = moments.first / moments.volume;
  const Eigen::Matrix3d second = moments.second - moments.volume * centre * centre.transpose();
  const Eigen::Matrix3d inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);
  const Eigen::Quaterniond q(axes);
  const Eigen::Vector3d principal = density.value * solver.eigenvalues();
  return {density.value * moments.volume, origin + Vec3{centre[0], centre[1], centre[2]},
          Vec3{principal[0], principal[1], principal[2]}, normalized(Quaternion{q.w(), q.x(), q.y(), q.z()})};
}

MassProperties unionOfSpheres(std::span<const Vec3> centre, std::span<const double> radius, Density density) {
  check(centre, radius);
  return massProperties(unionMoments(about(centre, centre[0]), radius), centre[0], density);
}

MassProperties sumOfSpheres(std::span<const Vec3> centre, std::span<const double> radius, Density density) {
  check(centre, radius);
  VolumeMoments sum;
  for (std::size_t i = 0; i < centre.size(); ++i) {
    const Eigen::Vector3d c = eigen(centre[i] - centre[0]);
    const double volume = 4.0 / 3.0 * std::numbers::pi * radius[i] * radius[i] * radius[i];
    sum.volume += volume;
    sum.first += volume * c;
    sum.second += volume * (c * c.transpose() + 0.2 * radius[i] * radius[i] * Eigen::Matrix3d::Identity());
  }
  return massProperties(sum, centre[0], density);
}

MassProperties solidInside(std::span<const Vec3> x, std::span<const geometry::Facet> facets, Density density) {
  const geometry::SurfaceDefects defects = geometry::checkSurface(x, facets);
  if (facets.empty() || !defects.closedAndOriented())
    throw InputError("the surface is not closed and oriented", "surface of a body",
                     "close it; checkSurface lists the open edges, repairSurface orients");
  const auto at = [&](int v) { return x[static_cast<std::size_t>(v)]; };
  const Vec3 origin = at(facets[0][0]);
  VolumeMoments sum;
  for (const geometry::Facet& f : facets) {
    const Eigen::Vector3d a = eigen(at(f[0]) - origin), b = eigen(at(f[1]) - origin), c = eigen(at(f[2]) - origin);
    const Eigen::Vector3d s = a + b + c;
    const double volume = a.dot(b.cross(c)) / 6.0;
    sum.volume += volume;
    sum.first += 0.25 * volume * s;
    sum.second += 0.05 * volume * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  if (!(sum.volume > 0.0))
    throw InputError("the surface encloses a volume of " + formatNumber(sum.volume), "surface of a body",
                     "turn the facets so that their normals point outwards");
  return massProperties(sum, origin, density);
}

}  // namespace dovetail::dem
