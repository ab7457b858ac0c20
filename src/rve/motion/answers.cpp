// What a cell is asked: stress, balance, energies.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "contacts/bonded.hpp"
#include "contacts/touching.hpp"
#include "dovetail/rve/rve.hpp"
#include "projection.hpp"

namespace dovetail::rve {

Stress stress(const Rve& cell) {
  const Eigen::Matrix3d whole = cell.state.virial / volume(cell);
  Stress found;
  found.cauchy = 0.5 * (whole + whole.transpose());
  const double size = found.cauchy.norm();
  found.asymmetry = size > 0.0 ? (whole - found.cauchy).norm() / size : 0.0;
  found.pressure = -found.cauchy.trace() / cell.dimension();
  return found;
}

Eigen::Matrix3d nominalStress(const Rve& cell) {
  const Eigen::Matrix3d& F = cell.state.F;
  return F.determinant() * stress(cell).cauchy * F.inverse().transpose();
}

namespace {

/// Largest force on a grain that no reaction holds, N; NaN if one is not finite.
double largestFreeForce(const Rve& cell) {
  Components force, torque;
  freeForces(cell, force, torque);
  double most = 0.0;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    double force2 = 0.0, torque2 = 0.0;
    for (const std::vector<double>& component : force)
      if (!component.empty()) force2 += component[i] * component[i];
    for (const std::vector<double>& component : torque)
      if (!component.empty()) torque2 += component[i] * component[i];
    const double now = std::max(std::sqrt(force2), std::sqrt(torque2) / cell.radius[i]);
    if (!std::isfinite(force2 + torque2)) return std::nan("");
    most = std::max(most, now);
  }
  return most;
}

/// Of a contact that lies in several places of a framed cell, what is here.
double fractionHere(const Rve& cell, const Touch& touch) {
  if (cell.frame.empty()) return 1.0;
  return touch.stiffness / normalStiffness(cell.springs, cell.radius[touch.i], cell.radius[touch.j]);
}

}  // namespace

Balance balance(const Rve& cell) {
  Balance found;
  std::vector<char> touched(cell.size(), 0);
  double forces = 0.0, fractions = 0.0;
  forEachTouch(cell, [&](const Touch& touch) {
    ++found.contacts;
    touched[touch.i] = touched[touch.j] = 1;
    forces += norm(contactForce(cell, touch));
    fractions += fractionHere(cell, touch);
    if (isSliding(cell.springs, touch)) ++found.sliding;
  });
  forEachBond(cell, [&](const BondTouch& bond) {
    ++found.contacts;
    ++found.bonds;
    touched[bond.i] = touched[bond.j] = 1;
    forces += norm(bond.forceOnI());
    fractions += bond.fraction;
  });
  std::size_t grains = cell.size();
  if (!cell.frame.empty())
    for (const std::vector<int>& group : cell.frame.alike) grains -= group.size() - 1;
  found.rattlers = static_cast<int>(std::count(touched.begin(), touched.end(), 0));
  found.coordination = 2.0 * fractions / static_cast<double>(grains);
  const double most = largestFreeForce(cell);
  if (found.contacts > 0) found.meanForce = forces / found.contacts;
  found.unbalanced = most == 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
  if (found.meanForce > 0.0 && std::isfinite(most)) found.unbalanced = most / found.meanForce;
  return found;
}

Eigen::Matrix3d fabric(const Rve& cell) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  const auto add = [&sum](const Vec3& normal, double fraction) {
    const Eigen::Vector3d n(normal.x, normal.y, normal.z);
    sum += fraction * n * n.transpose();
  };
  forEachTouch(cell, [&](const Touch& touch) { add(touch.normal, fractionHere(cell, touch)); });
  forEachBond(cell, [&](const BondTouch& bond) { add(bond.normal, bond.fraction); });
  return sum.trace() > 0.0 ? Eigen::Matrix3d(sum / sum.trace()) : sum;
}

double storedEnergy(const Rve& cell) {
  double sum = 0.0;
  const double tangential = cell.springs.slides() ? cell.springs.tangential : 0.0;
  const double fraction = cell.springs.elasticSpheres() ? dem::hertzEnergy : 0.5;
  forEachTouch(cell, [&](const Touch& touch) {
    sum += fraction * touch.normalForce * touch.overlap +
           0.5 * tangential * touch.stiffness * squaredNorm(touch.stretch) +
           0.5 * rollingStiffness(cell, touch) * touch.roll * touch.roll;
  });
  forEachBond(cell, [&](const BondTouch& bond) { sum += bond.energy(); });
  return sum;
}

double kineticEnergy(const Rve& cell) {
  double twice = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < cell.state.v[k].size(); ++i)
      twice += cell.mass[i] * cell.state.v[k][i] * cell.state.v[k][i];
    for (std::size_t i = 0; i < cell.state.spin[k].size(); ++i)
      twice += cell.inertia[i] * cell.state.spin[k][i] * cell.state.spin[k][i];
  }
  return 0.5 * twice;
}

}  // namespace dovetail::rve
