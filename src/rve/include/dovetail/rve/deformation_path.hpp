// The way of a cell from one deformation to another.
#pragma once

#include <Eigen/Core>

#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// F(s) = R^s U^s F(0) for s from 0 to 1, with R U = F(1) F(0)⁻¹, R a turn and U a stretch: principal logarithmic
/// strains grow evenly along axes that turn evenly. A turn of F(1), or of both ends, turns what is between and strains
/// nothing; det F(s) goes from det F(0) to det F(1) by equal ratios.
class DeformationPath {
public:
  /// From the present deformation of a cell.
  /// @throws InputError if F is not finite, det F ≤ 0, or discs are to be deformed out of their plane
  DeformationPath(const Rve& cell, const Eigen::Matrix3d& F);

  /// F(s); F(1) to the last digit.
  Eigen::Matrix3d at(double s) const;
  /// Eigenvalues of log U, in ascending order; of discs one is 0.
  const Eigen::Vector3d& strains() const { return strains_; }
  /// Their Euclidean norm: how far F(1) is away.
  double strain() const { return strains_.norm(); }

private:
  Eigen::Matrix3d start_, end_;
  Eigen::Matrix3d axes_;  // of U, by columns
  Eigen::Vector3d strains_;
  Eigen::Vector3d axis_;  // of R
  double angle_ = 0.0;
  bool plane_;
};

}  // namespace dovetail::rve
