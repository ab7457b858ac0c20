// The relaxed answer of a network of spheres by iteration.
#include <cmath>

#include "gradients.hpp"
#include "network.hpp"

namespace dovetail::rve {

namespace {

using Pairwise = Eigen::Matrix<double, 12, 12>;
using Columns = Eigen::MatrixXd;

/// Orthonormal strains, of 9 components by rows: stretches, and turns.
Eigen::Matrix<double, 9, 6> stretches() {
  Eigen::Matrix<double, 9, 6> basis = Eigen::Matrix<double, 9, 6>::Zero();
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    basis(4 * k, k) = 1.0;
    basis(3 * i + j, 3 + k) = basis(3 * j + i, 3 + k) = std::sqrt(0.5);
  }
  return basis;
}
Eigen::Matrix<double, 9, 3> turns() {
  Eigen::Matrix<double, 9, 3> basis = Eigen::Matrix<double, 9, 3>::Zero();
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    basis(3 * i + j, k) = std::sqrt(0.5);
    basis(3 * j + i, k) = -std::sqrt(0.5);
  }
  return basis;
}

/// Stiffness of two grains, turns in lengths.
struct Stiffness {
  int a, b;
  Pairwise matrix;
};

Columns product(const std::vector<Stiffness>& parts, double held, const Columns& x) {
  Columns y = held * x;
  Eigen::Matrix<double, 12, Eigen::Dynamic, 0, 12, 6> both(12, x.cols());
  for (const Stiffness& part : parts) {
    both << x.middleRows<6>(6 * part.a), x.middleRows<6>(6 * part.b);
    both = (part.matrix * both).eval();
    y.middleRows<6>(6 * part.a) += both.topRows<6>();
    y.middleRows<6>(6 * part.b) += both.bottomRows<6>();
  }
  return y;
}

BlockGradients gradientsOf(const std::vector<Stiffness>& parts, int nodes, double held) {
  std::vector<BlockGradients::Block> diagonal(static_cast<std::size_t>(nodes),
                                              held * BlockGradients::Block::Identity());
  std::vector<BlockGradients::Pair> pairs;
  for (const Stiffness& part : parts) {
    diagonal[static_cast<std::size_t>(part.a)] += part.matrix.topLeftCorner<6, 6>();
    diagonal[static_cast<std::size_t>(part.b)] += part.matrix.bottomRightCorner<6, 6>();
    const BlockGradients::Block ab = part.matrix.topRightCorner<6, 6>(), ba = part.matrix.bottomLeftCorner<6, 6>();
    if (part.a > part.b)
      pairs.push_back({part.a, part.b, ab, ba});
    else
      pairs.push_back({part.b, part.a, ba, ab});
  }
  return {diagonal, pairs};
}

void scaleTurns(Columns& rows, double factor) {
  for (Eigen::Index i = 0; i < rows.rows(); i += 6) rows.middleRows<3>(i + 3) *= factor;
}

}  // namespace

/// Gᵀ X + Yᵀ (B − K X), where K X = B and Kᵀ Y = G to some digits, is Gᵀ K⁻¹ B to twice as many. Turns of all press
/// nothing in a state of rest: they are left to that.
std::optional<Eigen::MatrixXd> Network::relaxedByGradients() const {
  const double r = 0.5 * meanDiameter(cell_), held = slight * stiffest_;
  Eigen::Vector<double, 12> scale = Eigen::Vector<double, 12>::Ones();
  scale.segment<3>(3).setConstant(1.0 / r);
  scale.tail<3>().setConstant(1.0 / r);
  std::vector<Stiffness> parts;
  for (const Part& part : parts_)
    parts.push_back({part.a, part.b, -(scale.asDiagonal() * part.forces * scale.asDiagonal())});
  Columns byForce = forceByStrain_, byStress = -stressByUnknown_.transpose();
  scaleTurns(byForce, 1.0 / r);
  scaleTurns(byStress, 1.0 / r);
  const Eigen::Matrix<double, 9, 6> T = stretches();
  const Eigen::Matrix<double, 9, 3> W = turns();
  const Columns B = byForce * T, G = byStress * T;
  Columns X = B, Y = G;
  if (!gradientsOf(parts, nodes_, held).solve(X, Y, 1e-6, 400)) return {};
  const Eigen::MatrixXd among = G.transpose() * X + Y.transpose() * (B - product(parts, held, X));
  return stressByStrain_ - T * among * T.transpose() - T * (Y.transpose() * byForce * W) * W.transpose() -
         W * (W.transpose() * byStress.transpose() * X) * T.transpose();
}

}  // namespace dovetail::rve
