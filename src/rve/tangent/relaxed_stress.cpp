// The relaxed answer of a network of spheres by iteration.
#include <cmath>

#include "gradients.hpp"
#include "network.hpp"

namespace dovetail::rve {

namespace {

using Columns = Eigen::MatrixXd;
constexpr double accuracy = 1e-5;  // of K X = B and Kᵀ Y = G, each column
constexpr int rounds = 3;          // of iterations that drifted from what they believed was left

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

void scaleTurns(Columns& rows, double factor) {
  for (Eigen::Index i = 0; i < rows.rows(); i += 6) rows.middleRows<3>(i + 3) *= factor;
}

struct Solved {
  Columns X, Y;     ///< K X = B, Kᵀ Y = G
  Columns restOfB;  ///< B − K X
};

/// Nothing where iterations do not get there.
std::optional<Solved> solveBoth(const SphereRows& rows, const Columns& B, const Columns& G) {
  const auto isThere = [](const Columns& rest, const Columns& of) {
    return (rest.colwise().norm().array() <= accuracy * of.colwise().norm().array()).all();
  };
  const BlockGradients gradients(rows);
  Columns X = Columns::Zero(B.rows(), B.cols()), Y = X, restOfB = B, restOfG = G;
  for (int round = 0; !(isThere(restOfB, B) && isThere(restOfG, G)); ++round) {
    if (round == rounds) return {};
    Columns dX = restOfB, dY = restOfG;
    if (!gradients.solve(dX, dY, 1e-6, 400)) return {};
    X += dX, Y += dY;
    restOfB = B - product(rows, X);
    restOfG = G - transposedProduct(rows, Y);
  }
  return Solved{X, Y, restOfB};
}

}  // namespace

/// Stiffness of all contacts, turns in lengths.
SphereRows Network::rowsOfSpheres(double r) const {
  SphereRows rows(static_cast<std::size_t>(nodes_));
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].emplace(static_cast<int>(i), slight * stiffest_ * SphereBlock::Identity());
  SphereBlock scale = SphereBlock::Identity();
  scale.diagonal().tail<3>().setConstant(1.0 / r);
  for (const Part& part : parts_) {
    const std::array<int, 2> node{part.a, part.b};
    for (const std::size_t i : {0, 1})
      for (const std::size_t j : {0, 1}) {
        const auto row = static_cast<Eigen::Index>(perSphere * i), column = static_cast<Eigen::Index>(perSphere * j);
        SphereBlock& block =
            rows[static_cast<std::size_t>(node[i])].try_emplace(node[j], SphereBlock::Zero()).first->second;
        block -= scale * part.forces.block<perSphere, perSphere>(row, column) * scale;
      }
  }
  return rows;
}

/// Gᵀ X + Yᵀ (B − K X), where K X = B and Kᵀ Y = G to some digits, is Gᵀ K⁻¹ B to twice as many. Turns of all press
/// nothing in a state of rest: they are left to that.
std::optional<Eigen::MatrixXd> Network::relaxedByGradients() const {
  const double r = 0.5 * meanDiameter(cell_);
  Columns byForce = forceByStrain_, byStress = -stressByUnknown_.transpose();
  scaleTurns(byForce, 1.0 / r);
  scaleTurns(byStress, 1.0 / r);
  const CondensedNetwork network = condensed(rowsOfSpheres(r), std::move(byForce), std::move(byStress), 3);
  const Eigen::Matrix<double, 9, 6> T = stretches();
  const Eigen::Matrix<double, 9, 3> W = turns();
  const Columns B = network.b * T, G = network.g * T;
  const std::optional<Solved> both = solveBoth(network.rows, B, G);
  if (!both) return {};
  const auto& [X, Y, restOfB] = *both;
  const Eigen::MatrixXd among = G.transpose() * X + Y.transpose() * restOfB;
  return stressByStrain_ - network.solved - T * among * T.transpose() -
         T * (Y.transpose() * network.b * W) * W.transpose() -
         W * (W.transpose() * network.g.transpose() * X) * T.transpose();
}

}  // namespace dovetail::rve
