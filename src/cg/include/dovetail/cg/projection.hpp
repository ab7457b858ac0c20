// The sparse map that both couplings share: values there = weights × values here.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::cg {

/// Sparse matrix by rows. In a consistent map the rows sum to one, so that a constant stays that constant.
/// `apply` carries motion (consistent), `applyTransposed` carries loads (conservative); the two are adjoint, hence the
/// power is the same on both sides: (P v)·f = v·(Pᵀ f).
struct Projection {
  int columns = 0;             ///< length of an input
  std::vector<int> offsets;    ///< rows + 1 places in column and weight; empty for no rows
  std::vector<int> column;     ///< ascending within each row
  std::vector<double> weight;  ///< dimensionless

  int rows() const { return offsets.empty() ? 0 : static_cast<int>(offsets.size()) - 1; }
  std::span<const int> rowColumns(int row) const {
    return {column.data() + offsets[row], static_cast<std::size_t>(offsets[row + 1] - offsets[row])};
  }
  std::span<const double> rowWeights(int row) const {
    return {weight.data() + offsets[row], static_cast<std::size_t>(offsets[row + 1] - offsets[row])};
  }
};

using ProjectionRow = std::vector<std::pair<int, double>>;  ///< (column, weight), any order

/// Sorts each row by column and adds up repeated columns in the order given.
/// @throws InputError for a column out of range or a weight that is not finite (names the row)
Projection fromRows(int columns, std::span<const ProjectionRow> rows);
Projection identityProjection(int size);
/// Product: apply(product(a, b), x) = apply(a, apply(b, x)).
/// @throws InputError if a.columns != b.rows()
Projection product(const Projection& a, const Projection& b);

/// Pᵀ by rows: its `apply` gathers what applyTransposed(P) scatters.
Projection transposed(const Projection& map);

/// @throws InputError if the arrays disagree in length, columns are out of range or not ascending, or a weight is not
///         finite (names the row)
void requireValid(const Projection& map);
/// Largest |Σ weights of a row − 1|; 0 for no rows.
double rowSumError(const Projection& map);
/// @throws InputError naming the first row whose sum is farther than tolerance from one
void requireRowsSumToOne(const Projection& map, double tolerance = 1e-12);

/// out = P in. @param in columns values  @param out rows values, overwritten; must not overlap with in
/// @throws InputError if a length is wrong
void apply(const Projection& map, std::span<const Vec3> in, std::span<Vec3> out);
void apply(const Projection& map, std::span<const double> in, std::span<double> out);
/// out += Pᵀ in. @param in rows values  @param out columns values, added to
/// @throws InputError if a length is wrong
void applyTransposed(const Projection& map, std::span<const Vec3> in, std::span<Vec3> out);
void applyTransposed(const Projection& map, std::span<const double> in, std::span<double> out);

/// One row of P in. No checks: for loops over contacts. Value: Vec3 or double.
template <class Value>
Value applyRow(std::span<const int> column, std::span<const double> weight, std::span<const Value> in) {
  Value sum{};
  for (std::size_t k = 0; k < column.size(); ++k) sum += weight[k] * in[column[k]];
  return sum;
}
inline Vec3 applyRow(const Projection& map, int row, std::span<const Vec3> in) {
  return applyRow<Vec3>(map.rowColumns(row), map.rowWeights(row), in);
}

/// out += (that row)ᵀ value: the adjoint of applyRow. No checks.
template <class Value>
void scatterRow(std::span<const int> column, std::span<const double> weight, const Value& value, std::span<Value> out) {
  for (std::size_t k = 0; k < column.size(); ++k) out[column[k]] += weight[k] * value;
}
inline void scatterRow(const Projection& map, int row, const Vec3& value, std::span<Vec3> out) {
  scatterRow<Vec3>(map.rowColumns(row), map.rowWeights(row), value, out);
}

}  // namespace dovetail::cg
