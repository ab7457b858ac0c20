// Square matrices of 3 × 3 blocks, one for every pair of nodes that a term couples.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::linalg {

class NodePairs;

/// Groups of nodes that share a term's tangent.
class MatrixPattern {
public:
  explicit MatrixPattern(std::size_t nodes) : neighbours_(nodes) {}
  /// Couples all nodes of the group with each other.
  void add(std::span<const int> group);
  /// Couples all pairs of another matrix.
  void add(const NodePairs& pairs);
  /// Whether a group has the node.
  bool couples(std::size_t node) const { return !neighbours_[node].empty(); }
  /// From now on it is that of matrices of which each rank of team() has a part, whose sum they are.
  /// @param owners  the rank of each node: its rows are whole there, once the ranks have told each other theirs
  void setOwners(std::vector<int> owners) { owners_ = std::move(owners); }
  std::size_t nodes() const { return neighbours_.size(); }

private:
  friend class NodePairs;
  std::vector<std::vector<int>> neighbours_;
  std::vector<int> owners_;
};

/// The pairs of nodes that a matrix has an entry for: compressed rows, columns ascending; every node is coupled with
/// itself.
class NodePairs {
public:
  NodePairs() = default;
  explicit NodePairs(MatrixPattern pattern);

  std::size_t nodes() const { return offsets_.empty() ? 0 : offsets_.size() - 1; }
  /// Distinguishes patterns, so that terms may keep the places of their entries.
  std::size_t patternId() const { return patternId_; }
  std::span<const int> offsets() const { return offsets_; }
  std::span<const int> columns() const { return columns_; }
  /// Place of the pair (row, column) in columns().
  /// @throws InputError if the pair is not coupled
  std::size_t place(int row, int column) const;

  /// Empty unless this is a part of a sum over ranks: see MatrixPattern::setOwners.
  std::span<const int> owners() const { return owners_; }
  bool isPart() const { return !owners_.empty(); }
  /// From now on matrices leave out what is added to rows of other ranks: for what all ranks add alike.
  void addOwnRowsOnly(bool only) { ownRowsOnly_ = only && isPart(); }
  /// Whether they take that row.
  bool takes(int row) const { return !ownRowsOnly_ || isOwn(row); }

protected:
  /// Σ over the ranks, if this is a part.
  void sumOverRanks(std::span<Vec3> y) const;

private:
  bool isOwn(int row) const;

  std::vector<int> offsets_, columns_, owners_;
  std::size_t patternId_ = 0;
  bool ownRowsOnly_ = false;
};

/// One number for every pair of nodes: the same for each component, as masses are.
class NodeMatrix : public NodePairs {
public:
  NodeMatrix() = default;
  explicit NodeMatrix(MatrixPattern pattern);

  std::span<const double> values() const { return values_; }
  std::span<double> values() { return values_; }
  /// Adds a row-major n × n matrix.
  void add(std::span<const int> nodes, std::span<const double> matrix);
  /// y = A x, in the order of the rows. Of a part of a sum over ranks: of all of it, by all of them.
  void multiply(std::span<const Vec3> x, std::span<Vec3> y) const;

private:
  std::vector<double> values_;
};

/// A 3 × 3 block for every pair of nodes; the nine values of a pair start at nine times its place.
class BlockMatrix : public NodePairs {
public:
  BlockMatrix() = default;
  explicit BlockMatrix(MatrixPattern pattern);
  /// With an entry for each of the pairs; all zero.
  explicit BlockMatrix(const NodePairs& pairs);
  std::span<const double> values() const { return values_; }
  std::span<double> values() { return values_; }

  void setZero();
  /// Adds a row-major (3n × 3n) matrix, rows 3a + c for nodes[a].
  void add(std::span<const int> nodes, std::span<const double> matrix);
  /// Adds a row-major 3 × 3 block.
  void addBlock(int row, int column, std::span<const double, 9> block);

  /// A = ½(A + Aᵀ).
  void symmetrise();

  /// y = A x, in the order of the rows: the same digits for any number of threads. Of a sum over ranks: of all of it,
  /// by all of them.
  void multiply(std::span<const Vec3> x, std::span<Vec3> y) const;

private:
  std::vector<double> values_;
};

}  // namespace dovetail::linalg
