#include "linear_contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace dovetail::rve {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d vector(const Vec3& a) { return {a.x, a.y, a.z}; }

Matrix3d skew(const Vector3d& a) {
  Matrix3d m;
  m << 0.0, -a[2], a[1], a[2], 0.0, -a[0], -a[1], a[0], 0.0;
  return m;
}

bool atLimit(double value, double limit) { return value >= (1.0 - 1e-9) * limit; }

/// Change of k_t u by the branch, and by the turn of a grain with this arm.
struct Hold {
  Matrix3d byBranch = Matrix3d::Zero();
  Matrix3d byTurnI = Matrix3d::Zero(), byTurnJ = Matrix3d::Zero();
};

Hold holdOf(const Rve& cell, const Touch& touch, const Linearisation& what, double armI, double armJ) {
  Hold tangentialForce;
  if (!cell.springs.slides()) return tangentialForce;
  const double k = cell.springs.tangential * touch.stiffness;
  const Vector3d n = vector(touch.normal), u = vector(touch.stretch);
  Matrix3d along = Matrix3d::Identity() - n * n.transpose();
  const double limit = slipLimit(cell.springs, touch);
  if (what.slips && atLimit(u.norm(), limit)) {
    const Vector3d slipping = u.normalized();
    along -= slipping * slipping.transpose();
    tangentialForce.byBranch = -cell.springs.friction * touch.stiffness * slipping * n.transpose();
  }
  tangentialForce.byBranch += k * along;
  tangentialForce.byTurnI = k * armI * along * skew(n);
  tangentialForce.byTurnJ = k * armJ * along * skew(n);
  if (!what.prestress) return tangentialForce;
  // The spring tilts with the normal, and turns about it with the mean of both grains.
  tangentialForce.byBranch -= k / touch.distance * n * u.transpose();
  const Matrix3d twist = 0.5 * k * n.cross(u) * n.transpose();
  tangentialForce.byTurnI += twist;
  tangentialForce.byTurnJ += twist;
  return tangentialForce;
}

/// Moment on i, less on j, of the rolling spring; about z.
void addRolling(const Rve& cell, const Touch& touch, const Linearisation& what, ContactMatrix& m) {
  if (!cell.springs.rolls()) return;
  const double k = rollingStiffness(cell, touch), ri = cell.radius[touch.i], rj = cell.radius[touch.j];
  const double fraction =
      cell.springs.rollingLimit / (cell.springs.tangential * cell.springs.rolling) * std::min(ri, rj) / (ri * rj);
  if (what.slips && atLimit(std::abs(touch.roll), fraction * touch.overlap)) {
    const Vec3 change = (touch.roll > 0.0 ? k * fraction : -k * fraction) * touch.normal;
    for (int a = 0; a < 3; ++a) {
      m(5, a) += change[a];
      m(8, a) -= change[a];
    }
    return;
  }
  m(5, 5) -= k;
  m(5, 8) += k;
  m(8, 5) += k;
  m(8, 8) -= k;
}

}  // namespace

ContactMatrix linearised(const Rve& cell, const Touch& touch, const Linearisation& what) {
  const double d = touch.distance, armI = 0.5 * (d + cell.radius[touch.i] - cell.radius[touch.j]), armJ = d - armI;
  const Vector3d n = vector(touch.normal);
  const Vector3d force = what.prestress ? vector(contactForce(cell, touch)) : Vector3d::Zero();
  const Matrix3d tilt = (Matrix3d::Identity() - n * n.transpose()) / d;
  const double normalForce = what.prestress ? touch.normalForce : 0.0;
  const Hold tangentialForce = holdOf(cell, touch, what, armI, armJ);
  ContactMatrix m = ContactMatrix::Zero();
  m.block<3, 3>(0, 0) = touch.stiffness * n * n.transpose() - normalForce * tilt + tangentialForce.byBranch;
  m.block<3, 3>(0, 3) = tangentialForce.byTurnI;
  m.block<3, 3>(0, 6) = tangentialForce.byTurnJ;
  const Eigen::Matrix<double, 3, 9> forces = m.topRows<3>();
  const Matrix3d arms = 0.5 * n.cross(force) * n.transpose();
  m.middleRows<3>(3) = armI * skew(n) * forces;
  m.middleRows<3>(6) = armJ * skew(n) * forces;
  m.block<3, 3>(3, 0) += arms - armI * skew(force) * tilt;
  m.block<3, 3>(6, 0) += arms - armJ * skew(force) * tilt;
  addRolling(cell, touch, what, m);
  return m;
}

}  // namespace dovetail::rve
