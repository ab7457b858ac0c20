// Stress and strain vectors are 11, 22, 33, 12, 23, 31 with engineering shears.
#include "hybrid_matrix.hpp"

#include <Eigen/Dense>

namespace dovetail::fem::detail {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix24 = Eigen::Matrix<double, 24, 24>;
using StrainMatrix = Eigen::Matrix<double, 6, 24>;
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

Eigen::Matrix3d deformationGradient(const GaussData& point, const BrickCorners& u) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  for (std::size_t a = 0; a < 8; ++a)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) F(i, j) += u[a][i] * point.gradient[a][j];
  return F;
}

/// δE = B δu with engineering shears.
StrainMatrix strainMatrix(const GaussData& point, const Eigen::Matrix3d& F) {
  StrainMatrix B;
  for (int r = 0; r < 6; ++r) {
    const auto [i, j] = pairOf[r];
    for (std::size_t a = 0; a < 8; ++a)
      for (int c = 0; c < 3; ++c) {
        const Vec3& g = point.gradient[a];
        B(r, static_cast<int>(3 * a) + c) = i == j ? F(c, i) * g[i] : F(c, i) * g[j] + F(c, j) * g[i];
      }
  }
  return B;
}

/// K += weight ∂ψ_a/∂X · S · ∂ψ_b/∂X on every component.
void addGeometricStiffness(const GaussData& point, const Vector6& stress, Matrix24& K) {
  const Eigen::Matrix3d S = stressTensor(stress);
  for (std::size_t a = 0; a < 8; ++a)
    for (std::size_t b = 0; b < 8; ++b) {
      const Vec3 &ga = point.gradient[a], &gb = point.gradient[b];
      double sum = 0.0;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum += ga[i] * S(i, j) * gb[j];
      for (int c = 0; c < 3; ++c) K(static_cast<int>(3 * a) + c, static_cast<int>(3 * b) + c) += point.weight * sum;
    }
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

std::array<double, 324> hybridStiffness(const BrickCorners& corners, const CornerValues& share,
                                        const Material& material) {
  const Matrix3 J0 = jacobian(corners, {0.0, 0.0, 0.0});
  const Matrix6 C = compliance(material);
  Eigen::Matrix<double, 18, 18> H = Eigen::Matrix<double, 18, 18>::Zero();
  for (int p = 0; p < 8; ++p) {
    const ModeMatrix P = pushedModes(J0, gaussPoint(p));
    H += interpolated(share, gaussPoint(p)) * determinant(jacobian(corners, gaussPoint(p))) * P.transpose() * C * P;
  }
  std::array<double, 324> result{};
  Eigen::Map<Eigen::Matrix<double, 18, 18>> inverse(result.data());
  inverse = H.ldlt().solve(Eigen::Matrix<double, 18, 18>::Identity());
  inverse = (0.5 * (inverse + inverse.transpose())).eval();
  return result;
}

std::array<double, 576> hybridTangent(const BrickCorners& corners, const CornerValues& share, const BrickCorners& u,
                                      const Material& material) {
  const Matrix3 J0 = jacobian(corners, {0.0, 0.0, 0.0});
  const std::array<double, 324> raw = hybridStiffness(corners, share, material);
  const Eigen::Map<const Eigen::Matrix<double, 18, 18>> stiffness(raw.data());
  const std::array<GaussData, 8> points = gaussData(corners, share);
  std::array<ModeMatrix, 8> modes;
  Eigen::Matrix<double, 18, 24> L = Eigen::Matrix<double, 18, 24>::Zero();
  Eigen::Matrix<double, 18, 1> moments = Eigen::Matrix<double, 18, 1>::Zero();
  for (std::size_t p = 0; p < 8; ++p) {
    modes[p] = pushedModes(J0, gaussPoint(static_cast<int>(p)));
    const Eigen::Matrix3d F = deformationGradient(points[p], u);
    const Eigen::Matrix3d E = 0.5 * (F.transpose() * F - Eigen::Matrix3d::Identity());
    Vector6 strain;
    for (int r = 0; r < 6; ++r) strain[r] = (r < 3 ? 1.0 : 2.0) * E(pairOf[r][0], pairOf[r][1]);
    L += points[p].weight * modes[p].transpose() * strainMatrix(points[p], F);
    moments += points[p].weight * modes[p].transpose() * strain;
  }
  const Eigen::Matrix<double, 18, 1> beta = stiffness * moments;
  Matrix24 K = L.transpose() * (stiffness * L);
  for (std::size_t p = 0; p < 8; ++p) addGeometricStiffness(points[p], modes[p] * beta, K);
  std::array<double, 576> result{};
  Eigen::Map<Eigen::Matrix<double, 24, 24, Eigen::RowMajor>> rows(result.data());
  rows = K;
  return result;
}

}  // namespace dovetail::fem::detail
