// Restores the first moments of kernel weights (a reproducing-kernel correction of first order).
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>

#include "dovetail/core/vec3.hpp"

namespace dovetail::cg {

/// Moments of weighted points about the centre: Σ w, Σ w d, Σ w d dᵀ.
struct PointMoments {
  double sum = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

  void add(double w, const Vec3& d) {
    const Eigen::Vector3d e(d.x, d.y, d.z);
    sum += w;
    first += w * e;
    second += w * e * e.transpose();
  }
};

/// Factor constant + slope·d on the weights.
struct LinearFactor {
  double constant = 1.0;
  Vec3 slope;
  double at(const Vec3& d) const { return constant + dot(slope, d); }
};

/// Finds the factor for which Σ w (a + β·d) = 1 and Σ w (a + β·d) d = 0: the least-norm, least-squares solution on the
/// directions in which the points are thicker than 1e-5 of their extent.
/// The caller still divides by the sum: with too few points the two conditions cannot both hold.
inline LinearFactor linearFactor(const PointMoments& moments) {
  const double extent = std::sqrt(moments.second.trace() / moments.sum);
  if (!(extent > 0.0)) return {};
  Eigen::Matrix4d system;
  system << moments.sum, moments.first.transpose() / extent, moments.first / extent, moments.second / (extent * extent);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> modes(system / moments.sum);
  Eigen::Vector4d solution = Eigen::Vector4d::Zero();
  for (int m = 0; m < 4; ++m) {
    const double eigenvalue = modes.eigenvalues()[m];
    if (eigenvalue > 1e-10 * modes.eigenvalues()[3])
      solution += (modes.eigenvectors()(0, m) / eigenvalue) * modes.eigenvectors().col(m);
  }
  const double scale = 1.0 / extent;
  return {solution[0], {solution[1] * scale, solution[2] * scale, solution[3] * scale}};
}

}  // namespace dovetail::cg
