// A model's matrix by rows of all components where ranks share its elements.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dovetail/fem/model/constraints.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "dovetail/linalg/multigrid.hpp"

namespace dovetail::fem::detail {

/// As NodeRows, of the nodes of this rank; rows that other ranks have a part of are sums of all parts. Nodes are
/// numbered anew, rank after rank. All calls are made by all ranks.
class RankRows {
public:
  /// @throws InputError for ties
  explicit RankRows(const DofMap& dofs);
  void update(const linalg::BlockMatrix& K);
  linalg::SharedRows& matrix() { return rows_; }
  std::size_t patternId() const { return patternId_; }
  /// Largest entry on the diagonal, N/m, of all ranks.
  double largestDiagonal() const { return largestDiagonal_; }
  bool isFinite() const;
  /// Nodes of this rank, in the order of its rows.
  std::span<const int> nodes() const { return nodes_; }

  /// Free components to those of this rank's nodes, and back from what all ranks have.
  std::vector<double> expanded(std::span<const double> q) const;
  void gather(std::span<const double> own, std::span<double> q) const;

private:
  /// Rows of K that are another rank's.
  struct Leaving {
    std::vector<int> row;             ///< node
    std::vector<std::size_t> blocks;  ///< of each
  };
  /// What another rank has in rows of this one, and where it goes.
  struct Arriving {
    std::vector<int> row;         ///< place among nodes_, ascending
    std::vector<int> offsets{0};  ///< of its blocks
    std::vector<int> column;      ///< node
    std::vector<int> place;
  };

  int freeRow(int node, int c) const {
    return dofs_->freeRow()[3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(c)];
  }
  bool isFree(int node, int c) const { return freeRow(node, c) >= 0; }
  void analyse(const linalg::BlockMatrix& K);
  void number(const linalg::BlockMatrix& K);
  void announce(const linalg::BlockMatrix& K);
  void lay(const linalg::BlockMatrix& K);
  void layRow(std::size_t row, std::span<const int> columns, std::span<const int> nodeOf);
  int placeOf(std::size_t row, int column) const;
  void add(std::size_t row, std::span<const int> columns, std::span<const int> places, const double* blocks);
  void addOwn(const linalg::BlockMatrix& K);
  void addOthers(const linalg::BlockMatrix& K);
  void setDiagonals();

  const DofMap* dofs_;
  linalg::SharedRows rows_;
  std::vector<int> nodes_;          // of this rank
  std::vector<int> numberOf_;       // of every node among all
  std::vector<Leaving> leaving_;    // to each rank
  std::vector<Arriving> arriving_;  // from each
  // Of the blocks of K in rows of this rank: twice where a block begins in its rows, plus 1 if among the others.
  std::vector<int> place_;
  std::vector<int> blockOffsets_, blockColumns_, blockPlaces_;  // while rows are laid; columns by their numbers
  std::size_t patternId_ = 0;
  double largestDiagonal_ = 0.0;
};

}  // namespace dovetail::fem::detail
