#include "linear_correction.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace dovetail::cg {

LinearFactor linearFactor(const PointMoments& moments) {
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
