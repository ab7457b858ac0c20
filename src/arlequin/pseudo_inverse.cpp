#include "pseudo_inverse.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "dovetail/core/error.hpp"

namespace dovetail::arlequin {

Matrix pseudoInverse(Matrix A, double rankTolerance) {
  Eigen::VectorXd scale = A.diagonal();
  for (Eigen::Index i = 0; i < scale.size(); ++i) scale[i] = scale[i] > 0.0 ? 1.0 / std::sqrt(scale[i]) : 0.0;
  A = scale.asDiagonal() * A * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(A);
  Eigen::VectorXd inverse = spectrum.eigenvalues();
  const double least = rankTolerance * inverse[inverse.size() - 1];
  for (Eigen::Index i = 0; i < inverse.size(); ++i) inverse[i] = inverse[i] > least ? 1.0 / inverse[i] : 0.0;
  const Eigen::MatrixXd& Q = spectrum.eigenvectors();
  return scale.asDiagonal() * (Q * inverse.asDiagonal() * Q.transpose()) * scale.asDiagonal();
}

void requireFewRows(std::size_t rows, const std::string& where) {
  constexpr std::size_t most = 4000;
  if (rows > most)
    throw InputError(std::to_string(rows) + " coupled nodes are too many for a dense solve", where,
                     "take the penalty with width 0, which needs no solve, or a coarser mesh (at most 4000 coupled "
                     "nodes)");
}

}  // namespace dovetail::arlequin
