// Factors of sparse matrices that are sums of small dense ones.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <cstddef>
#include <vector>

namespace dovetail::rve {

/// L U of a matrix whose pattern is symmetric and whose parts each couple two nodes, front by front: the unknowns of
/// successive nodes are eliminated in one dense matrix, with pivots among these alone, and what is left is added to the
/// front of the next one concerned (Duff & Reid, ACM Trans. Math. Softw. 9, 1983). The order is of approximate minimum
/// degree, node `last` at the end.
class Fronts {
public:
  /// @param first  unknowns of node k are first[k] … first[k + 1] − 1
  /// @param last   node that is eliminated last, −1: any
  explicit Fronts(std::vector<int> first, int last = -1) : first_(std::move(first)), last_(last) {}

  /// Adds a dense matrix on the unknowns of nodes a and b, which may be the same; b = −1: of a alone.
  void add(int a, int b, const Eigen::Ref<const Eigen::MatrixXd>& part);
  /// @throws NumericalError if a pivot is zero
  void factor();
  /// Solution for each column, refined until the residual is round-off.
  /// @throws NumericalError if it does not get there
  Eigen::MatrixXd solve(const Eigen::MatrixXd& rightSide) const;

private:
  struct Part {
    std::array<int, 2> node;
    std::size_t at;  // in values_, by columns
  };
  struct Front {
    std::vector<int> own, later;  // places in the order of elimination
    int parent = -1;
    std::vector<int> unknowns;  // own ones first
    Eigen::PartialPivLU<Eigen::MatrixXd> pivots;
    Eigen::MatrixXd lower, upper;  // L₂₁, U₁₂
    Eigen::MatrixXd left;          // for the parent, until that has it
  };

  int size() const { return first_.back(); }
  int sizeOf(int node) const { return node < 0 ? 0 : first_[std::size_t(node) + 1] - first_[std::size_t(node)]; }
  Eigen::Map<const Eigen::MatrixXd> matrixOf(const Part& part) const;
  template <class Visit>
  void forUnknowns(const Part& part, const Visit& visit) const;
  void chooseOrder();
  void makeFronts();
  int frontThatTakes(const std::vector<int>& children, std::size_t later) const;
  void sortFronts();
  void eliminate(Front& front, const std::vector<int>& children, const std::vector<int>& parts);
  void substitute(Eigen::MatrixXd& x) const;

  std::vector<int> first_;
  int last_;
  std::vector<Part> parts_;
  std::vector<double> values_;
  std::vector<int> order_, place_;  // node at a place of the order, and back
  std::vector<Front> fronts_;       // children before parents
  std::vector<int> local_;          // by unknown: where it is in the front at hand
};

}  // namespace dovetail::rve
