// Bi-conjugate gradients on the network of a cell of spheres.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace dovetail::rve {

/// Systems K x = b and Kᵀ y = g of 6 × 6 blocks, symmetric in pattern and nearly so in value, of as many right-hand
/// sides at once as vector registers have lanes. Fletcher's bi-conjugate gradients, preconditioned by symmetric Gauss
/// and Seidel, whose two triangular systems take the place of the product with the matrix (Eisenstat, SIAM J. Sci.
/// Stat. Comput. 2, 1981): a pass over the blocks down and one up are half an iteration. A few directions in which K is
/// not positive do no harm.
class BlockGradients {
public:
  static constexpr int perNode = 6, columns = 8;
  using Block = Eigen::Matrix<double, perNode, perNode, Eigen::RowMajor>;
  struct Pair {
    int row, column;     ///< row > column
    Block lower, upper;  ///< at (row, column), and at (column, row)
  };

  /// @param diagonal  of each node
  BlockGradients(const std::vector<Block>& diagonal, const std::vector<Pair>& pairs);

  /// Overwrites at most `columns` columns of b by x, and as many of g by y.
  /// @param tolerance  of the mean of both residuals, relative, in the norm of the preconditioner
  /// @return false if it does not converge
  bool solve(Eigen::MatrixXd& b, Eigen::MatrixXd& g, double tolerance, int iterations) const;

private:
  using Lanes = std::array<std::array<double, columns>, perNode>;
  using Field = std::vector<Lanes>;
  using Numbers = std::array<double, perNode * perNode>;
  enum class Use { plain, transposed };
  void takeRoot(std::size_t node, const Block& whole);
  template <Use use>
  void down(const Field& from, Field& to) const;
  template <Use use>
  void up(const Field& from, Field& to) const;
  template <Use use>
  void product(const Field& way, Field& work, Field& image) const;
  Field scaled(const Eigen::MatrixXd& b) const;
  void unscaled(const Field& x, Eigen::MatrixXd& b) const;

  std::vector<Block> root_;   // R with R D Rᵀ = 1 of a positive definite D close to that of a node
  std::vector<Numbers> off_;  // what R D Rᵀ differs from 1 for the node's own
  std::vector<int> first_{0}, other_;
  std::vector<Numbers> lower_, upper_;  // with the roots of both nodes taken out
};

}  // namespace dovetail::rve
