#include "dovetail/rve/deformation_path.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "polar.hpp"

namespace dovetail::rve {

namespace {

/// Principal stretches in ascending order, and axes by columns.
void principal(const Eigen::Matrix3d& stretch, bool plane, Eigen::Vector3d& values, Eigen::Matrix3d& axes) {
  if (!plane) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(stretch);
    values = solver.eigenvalues();
    axes = solver.eigenvectors();
    return;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(stretch.topLeftCorner<2, 2>());
  values << solver.eigenvalues(), 1.0;
  axes.setIdentity();
  axes.topLeftCorner<2, 2>() = solver.eigenvectors();
  // 1 where it belongs.
  for (int k = 2; k > 0 && values[k] < values[k - 1]; --k) {
    std::swap(values[k], values[k - 1]);
    axes.col(k).swap(axes.col(k - 1));
  }
}

}  // namespace

DeformationPath::DeformationPath(const Rve& cell, const Eigen::Matrix3d& F)
    : start_(cell.state.F), end_(F), plane_(cell.shape == Shape::disc) {
  if (!F.allFinite() || !(F.determinant() > 0.0))
    throw InputError("the determinant of F is " + formatNumber(F.determinant()), "path of a cell",
                     "give an F that is finite and turns nothing inside out");
  const Polar parts = polar(relativeDeformation(cell, F));
  principal(parts.stretch, plane_, strains_, axes_);
  strains_ = strains_.array().log();
  const Eigen::AngleAxisd turn(parts.turn);
  axis_ = turn.axis();
  angle_ = turn.angle();
}

Eigen::Matrix3d DeformationPath::at(double s) const {
  if (s == 1.0) return end_;
  const Eigen::Vector3d stretches = (s * strains_).array().exp();
  Eigen::Matrix3d F =
      Eigen::AngleAxisd(s * angle_, axis_) * (axes_ * stretches.asDiagonal() * axes_.transpose()) * start_;
  if (plane_) {
    F.row(2) << 0.0, 0.0, 1.0;
    F.col(2) << 0.0, 0.0, 1.0;
  }
  return F;
}

}  // namespace dovetail::rve
