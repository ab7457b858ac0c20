// Grains that few contacts hold, taken out of the network of a cell of spheres.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <vector>

namespace dovetail::rve {

constexpr int perSphere = 6;
using SphereBlock = Eigen::Matrix<double, perSphere, perSphere>;
/// Rows of a matrix of 6 × 6 blocks that is symmetric in pattern: blocks by column.
using SphereRows = std::vector<std::map<int, SphereBlock>>;

Eigen::MatrixXd product(const SphereRows& rows, const Eigen::MatrixXd& x);
Eigen::MatrixXd transposedProduct(const SphereRows& rows, const Eigen::MatrixXd& x);

/// gᵀ K⁻¹ b, some nodes of which have been eliminated.
struct CondensedNetwork {
  SphereRows rows;         ///< Schur complement of the nodes that are left, in their order
  Eigen::MatrixXd b, g;    ///< right-hand sides of K x = b and Kᵀ y = g there
  Eigen::MatrixXd solved;  ///< what those eliminated add to gᵀ K⁻¹ b
};

/// Eliminates nodes in a minimum degree order, as long as one has at most `most` neighbours. Grains that few contacts
/// hold roll almost freely: their eigenvalues are of the order of contact forces, of either sign, and iterations on the
/// whole network stall. What is left has few more blocks and none of these.
CondensedNetwork condensed(SphereRows rows, Eigen::MatrixXd b, Eigen::MatrixXd g, std::size_t most);

}  // namespace dovetail::rve
