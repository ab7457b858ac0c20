// Stress and strain vectors are 11, 22, 33, 12, 23, 31 with engineering shears.
#include "hybrid_matrix.hpp"

#include <Eigen/Dense>

namespace dovetail::fem::detail {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using ModeMatrix = Eigen::Matrix<double, 6, 18>;

constexpr std::array<std::array<int, 2>, 6> pairOf = {{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}}};

Matrix6 compliance(const Material& material) {
  const double E = youngsModulus(material), nu = poissonRatio(material);
  Matrix6 C = Matrix6::Zero();
  C.topLeftCorner<3, 3>().setConstant(-nu / E);
  C.topLeftCorner<3, 3>().diagonal().setConstant(1.0 / E);
  C.bottomRightCorner<3, 3>().diagonal().setConstant(2.0 * (1.0 + nu) / E);
  return C;
}

Eigen::Matrix3d stressTensor(const Vector6& s) {
  Eigen::Matrix3d S;
  S << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return S;
}

/// The modes in the axes of space: S = J0 Ŝ J0ᵀ.
ModeMatrix pushedModes(const Matrix3& J0, const Vec3& xi) {
  const std::array<double, 108> parent = stressModes(xi);
  const Eigen::Map<const Eigen::Matrix<double, 6, 18, Eigen::RowMajor>> modes(parent.data());
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> J(J0.data());
  ModeMatrix pushed;
  for (int m = 0; m < 18; ++m) {
    const Eigen::Matrix3d S = J * stressTensor(modes.col(m)) * J.transpose();
    for (int r = 0; r < 6; ++r) pushed(r, m) = S(pairOf[r][0], pairOf[r][1]);
  }
  return pushed;
}

}  // namespace

std::array<double, 324> hybridStiffness(const BrickCorners& corners, const CornerValues& fraction,
                                        const Material& material) {
  const Matrix3 J0 = jacobian(corners, {0.0, 0.0, 0.0});
  const Matrix6 C = compliance(material);
  Eigen::Matrix<double, 18, 18> H = Eigen::Matrix<double, 18, 18>::Zero();
  for (int p = 0; p < 8; ++p) {
    const ModeMatrix P = pushedModes(J0, gaussPoint(p));
    H += interpolated(fraction, gaussPoint(p)) * determinant(jacobian(corners, gaussPoint(p))) * P.transpose() * C * P;
  }
  std::array<double, 324> result{};
  Eigen::Map<Eigen::Matrix<double, 18, 18>> inverse(result.data());
  inverse = H.ldlt().solve(Eigen::Matrix<double, 18, 18>::Identity());
  inverse = (0.5 * (inverse + inverse.transpose())).eval();
  return result;
}

}  // namespace dovetail::fem::detail
