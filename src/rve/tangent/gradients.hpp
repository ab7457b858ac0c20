// Bi-conjugate gradients on the network of a cell of spheres.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "condensation.hpp"

namespace dovetail::rve {

/// Systems K x = b and Kᵀ y = g, symmetric in pattern and nearly so in value, of as many right-hand sides at once as
/// vector registers have lanes. Fletcher's bi-conjugate gradients, preconditioned by symmetric Gauss and Seidel, whose
/// two triangular systems take the place of the product with the matrix (Eisenstat, SIAM J. Sci. Stat. Comput. 2,
/// 1981): a pass over the blocks down and one up are half an iteration. A few directions in which K is not positive do
/// no harm.
class BlockGradients {
public:
  static constexpr int columns = 8;

  explicit BlockGradients(const SphereRows& rows);

  /// Overwrites at most `columns` columns of b by x, and as many of g by y.
  /// @param tolerance  of the mean of both residuals, relative, in the norm of the preconditioner
  /// @return false if it does not converge
  bool solve(Eigen::MatrixXd& b, Eigen::MatrixXd& g, double tolerance, int iterations) const;

private:
  using Lanes = std::array<std::array<double, columns>, perSphere>;
  using Field = std::vector<Lanes>;
  using Numbers = std::array<double, perSphere * perSphere>;  // by columns
  struct Triangle {
    std::vector<int> first{0}, other;  // of each row; columns of blocks
    std::vector<Numbers> blocks;
  };
  /// K, or Kᵀ, with the roots taken out: 1 + O + L + U.
  struct Matrix {
    Triangle lower, upper;
    std::vector<Numbers> rest;  // 1 − O
  };
  static SphereBlock rootOf(const SphereBlock& whole);
  static void down(const Triangle& lower, const Field& from, Field& to);
  static void up(const Triangle& upper, const Field& from, Field& to);
  static void product(const Matrix& matrix, const Field& way, Field& work, Field& image);
  void addRow(const SphereRows& rows, std::size_t i);
  Field scaled(const Eigen::MatrixXd& b) const;
  void unscaled(const Field& x, Eigen::MatrixXd& b) const;

  std::vector<SphereBlock> root_;  // R with R D Rᵀ = 1 of a positive definite D close to that of a node
  Matrix plain_, transposed_;
};

}  // namespace dovetail::rve
