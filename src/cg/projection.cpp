#include "dovetail/cg/projection.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::cg {

namespace {

constexpr std::size_t chunkSize = 512, rowChunk = 64;
constexpr std::size_t fewChunks = 16;  // of loops with a work space as long as an input

std::string rowName(int row) { return "projection row " + std::to_string(row); }

void requireEntry(int row, int columns, int column, double weight) {
  if (column < 0 || column >= columns)
    throw InputError("column " + std::to_string(column) + " does not exist", rowName(row),
                     "use columns from 0 to " + std::to_string(columns - 1));
  if (!std::isfinite(weight))
    throw InputError("the weight of column " + std::to_string(column) + " is " + formatNumber(weight), rowName(row),
                     "give finite weights");
}

void requireLengths(const Projection& map, std::size_t perRow, std::size_t perColumn, const char* where) {
  if (perRow != static_cast<std::size_t>(map.rows()) || perColumn != static_cast<std::size_t>(map.columns))
    throw InputError("a map of " + std::to_string(map.rows()) + " rows and " + std::to_string(map.columns) +
                         " columns does not fit arrays of " + std::to_string(perRow) + " and " +
                         std::to_string(perColumn),
                     where, "give one value per row and one per column");
}

template <class Value>
void applyRows(const Projection& map, std::span<const Value> in, std::span<Value> out) {
  requireLengths(map, out.size(), in.size(), "apply");
  parallelFor(out.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const int r = static_cast<int>(row);
      out[row] = applyRow<Value>(map.rowColumns(r), map.rowWeights(r), in);
    }
  });
}

/// Serial: several rows add to one place, and their order decides the last bit.
template <class Value>
void scatterRows(const Projection& map, std::span<const Value> in, std::span<Value> out) {
  requireLengths(map, in.size(), out.size(), "applyTransposed");
  for (int row = 0; row < map.rows(); ++row) scatterRow<Value>(map.rowColumns(row), map.rowWeights(row), in[row], out);
}

}  // namespace

Projection fromRows(int columns, std::span<const ProjectionRow> rows) {
  const auto before = [](const auto& a, const auto& b) { return a.first < b.first; };
  const auto ascends = [](const auto& a, const auto& b) { return a.first >= b.first; };
  std::vector<ProjectionRow> sorted(rows.size());  // of those that are not in order
  Projection map;
  map.columns = columns;
  map.offsets.assign(rows.size() + 1, 0);
  parallelFor(rows.size(), rowChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      for (const auto& [column, weight] : rows[row]) requireEntry(static_cast<int>(row), columns, column, weight);
      map.offsets[row + 1] = static_cast<int>(rows[row].size());
      if (std::ranges::adjacent_find(rows[row], ascends) == rows[row].end()) continue;
      ProjectionRow& own = sorted[row] = rows[row];
      std::ranges::stable_sort(own, before);
      std::size_t last = 0;
      for (std::size_t k = 1; k < own.size(); ++k)
        if (own[k].first == own[last].first)
          own[last].second += own[k].second;
        else
          own[++last] = own[k];
      own.resize(last + 1);
      map.offsets[row + 1] = static_cast<int>(own.size());
    }
  });
  std::partial_sum(map.offsets.begin(), map.offsets.end(), map.offsets.begin());
  map.column.resize(static_cast<std::size_t>(map.offsets.back()));
  map.weight.resize(map.column.size());
  parallelFor(rows.size(), rowChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      auto place = static_cast<std::size_t>(map.offsets[row]);
      for (const auto& [column, weight] : sorted[row].empty() ? rows[row] : sorted[row]) {
        map.column[place] = column;
        map.weight[place++] = weight;
      }
    }
  });
  return map;
}

Projection identityProjection(int size) {
  if (size < 0) throw InputError("the size is " + std::to_string(size), "identityProjection", "give 0 or more");
  Projection map;
  map.columns = size;
  map.offsets.push_back(0);
  for (int i = 0; i < size; ++i) {
    map.column.push_back(i);
    map.weight.push_back(1.0);
    map.offsets.push_back(i + 1);
  }
  return map;
}

Projection product(const Projection& a, const Projection& b) {
  if (a.columns != b.rows())
    throw InputError(
        "the left map takes " + std::to_string(a.columns) + " values, the right one gives " + std::to_string(b.rows()),
        "product", "give maps with matching sizes");
  const auto size = static_cast<std::size_t>(a.rows());
  std::vector<ProjectionRow> rows(size);
  parallelFor(size, std::max(rowChunk, size / fewChunks), [&](std::size_t begin, std::size_t end) {
    std::vector<double> sum(static_cast<std::size_t>(b.columns), 0.0);
    std::vector<char> isSeen(sum.size(), 0);
    std::vector<int> seen;
    for (std::size_t row = begin; row < end; ++row) {
      for (int k = a.offsets[row]; k < a.offsets[row + 1]; ++k)
        for (int m = b.offsets[a.column[k]]; m < b.offsets[a.column[k] + 1]; ++m) {
          const auto column = static_cast<std::size_t>(b.column[m]);
          if (!isSeen[column]) seen.push_back(b.column[m]);
          isSeen[column] = 1;
          sum[column] += a.weight[k] * b.weight[m];
        }
      std::ranges::sort(seen);
      for (const int column : seen) {
        const auto at = static_cast<std::size_t>(column);
        rows[row].emplace_back(column, std::exchange(sum[at], 0.0));
        isSeen[at] = 0;
      }
      seen.clear();
    }
  });
  return fromRows(b.columns, rows);
}

Projection transposed(const Projection& map) {
  Projection result;
  result.columns = map.rows();
  result.offsets.assign(static_cast<std::size_t>(map.columns) + 1, 0);
  for (const int column : map.column) ++result.offsets[column + 1];
  for (int column = 0; column < map.columns; ++column) result.offsets[column + 1] += result.offsets[column];
  result.column.resize(map.column.size());
  result.weight.resize(map.weight.size());
  std::vector<int> next(result.offsets.begin(), result.offsets.end() - 1);
  for (int row = 0; row < map.rows(); ++row)
    for (int k = map.offsets[row]; k < map.offsets[row + 1]; ++k) {
      const int place = next[map.column[k]]++;
      result.column[place] = row;
      result.weight[place] = map.weight[k];
    }
  return result;
}

void requireValid(const Projection& map) {
  if (map.columns < 0)
    throw InputError("the number of columns is " + std::to_string(map.columns), "projection", "give 0 or more");
  if (map.column.size() != map.weight.size() ||
      (map.offsets.empty() ? 0 : map.offsets.back()) != static_cast<int>(map.column.size()) ||
      (!map.offsets.empty() && map.offsets.front() != 0))
    throw InputError("offsets, columns and weights disagree in length", "projection",
                     "give rows + 1 offsets from 0 to the number of weights");
  for (int row = 0; row < map.rows(); ++row) {
    if (map.offsets[row + 1] < map.offsets[row] || map.offsets[row + 1] > map.offsets.back())
      throw InputError("the offsets are not ascending", rowName(row), "give rows + 1 ascending offsets");
    for (int k = map.offsets[row]; k < map.offsets[row + 1]; ++k) {
      requireEntry(row, map.columns, map.column[k], map.weight[k]);
      if (k > map.offsets[row] && map.column[k] <= map.column[k - 1])
        throw InputError("the columns are not ascending", rowName(row), "sort them (fromRows does)");
    }
  }
}

double rowSumError(const Projection& map) {
  double largest = 0.0;
  for (int row = 0; row < map.rows(); ++row) {
    double sum = 0.0;
    for (double weight : map.rowWeights(row)) sum += weight;
    if (!(std::abs(sum - 1.0) <= largest)) largest = std::abs(sum - 1.0);
  }
  return largest;
}

void requireRowsSumToOne(const Projection& map, double tolerance) {
  for (int row = 0; row < map.rows(); ++row) {
    double sum = 0.0;
    for (double weight : map.rowWeights(row)) sum += weight;
    if (!(std::abs(sum - 1.0) <= tolerance))
      throw InputError("the weights sum to " + formatNumber(sum), rowName(row),
                       "divide them by their sum, or give the row at least one weight");
  }
}

void apply(const Projection& map, std::span<const Vec3> in, std::span<Vec3> out) { applyRows<Vec3>(map, in, out); }
void apply(const Projection& map, std::span<const double> in, std::span<double> out) {
  applyRows<double>(map, in, out);
}
void applyTransposed(const Projection& map, std::span<const Vec3> in, std::span<Vec3> out) {
  scatterRows<Vec3>(map, in, out);
}
void applyTransposed(const Projection& map, std::span<const double> in, std::span<double> out) {
  scatterRows<double>(map, in, out);
}

}  // namespace dovetail::cg
