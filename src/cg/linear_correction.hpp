// Restores the first moments of kernel weights (a reproducing-kernel correction of first order).
#pragma once

#include <Eigen/Core>

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
LinearFactor linearFactor(const PointMoments& moments);

}  // namespace dovetail::cg
