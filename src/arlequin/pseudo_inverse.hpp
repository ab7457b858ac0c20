// Inverse of symmetric, positive semidefinite matrices, whose rows may depend on each other.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>

namespace dovetail::arlequin {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A⁺, A scaled to a unit diagonal before its eigenvalues are judged: those below rankTolerance of the largest count as
/// zero.
Matrix pseudoInverse(Matrix A, double rankTolerance);

/// @throws InputError for more rows than a dense solve is sensible for
void requireFewRows(std::size_t rows, const std::string& where);

}  // namespace dovetail::arlequin
