#include "dovetail/linalg/block_matrix.hpp"

#include <algorithm>
#include <atomic>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/core/team.hpp"

namespace dovetail::linalg {

namespace {

std::size_t nextPatternId() {
  static std::atomic<std::size_t> last{0};
  return ++last;
}

void sortAndUnite(std::vector<int>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

void MatrixPattern::add(std::span<const int> group) {
  for (const int a : group) {
    std::vector<int>& list = neighbours_[static_cast<std::size_t>(a)];
    list.insert(list.end(), group.begin(), group.end());
    if (list.size() > 4096) sortAndUnite(list);
  }
}

void MatrixPattern::add(const NodePairs& pairs) {
  for (std::size_t n = 0; n < pairs.nodes(); ++n) {
    const auto first = pairs.columns().begin() + pairs.offsets()[n],
               last = pairs.columns().begin() + pairs.offsets()[n + 1];
    neighbours_[n].insert(neighbours_[n].end(), first, last);
  }
}

NodePairs::NodePairs(MatrixPattern pattern) : owners_(std::move(pattern.owners_)), patternId_(nextPatternId()) {
  offsets_.assign(1, 0);
  for (std::size_t n = 0; n < pattern.neighbours_.size(); ++n) {
    std::vector<int>& list = pattern.neighbours_[n];
    list.push_back(static_cast<int>(n));
    sortAndUnite(list);
    columns_.insert(columns_.end(), list.begin(), list.end());
    offsets_.push_back(static_cast<int>(columns_.size()));
    std::vector<int>().swap(list);
  }
}

bool NodePairs::isOwn(int row) const { return owners_[static_cast<std::size_t>(row)] == team().rank(); }

void NodePairs::sumOverRanks(std::span<Vec3> y) const {
  if (isPart()) team().sum(std::span(y.empty() ? nullptr : &y[0].x, 3 * y.size()));
}

NodeMatrix::NodeMatrix(MatrixPattern pattern) : NodePairs(std::move(pattern)), values_(columns().size(), 0.0) {}

void NodeMatrix::add(std::span<const int> nodes, std::span<const double> matrix) {
  const std::size_t n = nodes.size();
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n && takes(nodes[a]); ++b) values_[place(nodes[a], nodes[b])] += matrix[n * a + b];
}

void NodeMatrix::multiply(std::span<const Vec3> x, std::span<Vec3> y) const {
  parallelFor(nodes(), 2048, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      Vec3 sum;
      for (int k = offsets()[n]; k < offsets()[n + 1]; ++k)
        sum +=
            values_[static_cast<std::size_t>(k)] * x[static_cast<std::size_t>(columns()[static_cast<std::size_t>(k)])];
      y[n] = sum;
    }
  });
  sumOverRanks(y);
}

BlockMatrix::BlockMatrix(const NodePairs& pairs) : NodePairs(pairs), values_(9 * columns().size(), 0.0) {}

BlockMatrix::BlockMatrix(MatrixPattern pattern) : NodePairs(std::move(pattern)), values_(9 * columns().size(), 0.0) {}

void BlockMatrix::setZero() {
  parallelFor(values_.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    std::fill(values_.begin() + static_cast<std::ptrdiff_t>(begin), values_.begin() + static_cast<std::ptrdiff_t>(end),
              0.0);
  });
}

std::size_t NodePairs::place(int row, int column) const {
  const auto first = columns_.begin() + offsets_[static_cast<std::size_t>(row)],
             last = columns_.begin() + offsets_[static_cast<std::size_t>(row) + 1];
  const auto found = std::lower_bound(first, last, column);
  if (found == last || *found != column)
    throw InputError("nodes " + std::to_string(row) + " and " + std::to_string(column) + " are not coupled",
                     "BlockMatrix", "name the group in addPattern() of the term");
  return static_cast<std::size_t>(found - columns_.begin());
}

void BlockMatrix::add(std::span<const int> nodes, std::span<const double> matrix) {
  const std::size_t n = nodes.size();
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n && takes(nodes[a]); ++b) {
      double* const block = &values_[9 * place(nodes[a], nodes[b])];
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t d = 0; d < 3; ++d) block[3 * c + d] += matrix[3 * n * (3 * a + c) + 3 * b + d];
    }
}

void BlockMatrix::addBlock(int row, int column, std::span<const double, 9> block) {
  if (!takes(row)) return;
  double* const target = &values_[9 * place(row, column)];
  for (std::size_t k = 0; k < 9; ++k) target[k] += block[k];
}

void BlockMatrix::symmetrise() {
  for (std::size_t n = 0; n < nodes(); ++n)
    for (int k = offsets()[n]; k < offsets()[n + 1]; ++k) {
      const int column = columns()[static_cast<std::size_t>(k)];
      if (column < static_cast<int>(n)) continue;
      double* const upper = &values_[9 * static_cast<std::size_t>(k)];
      double* const lower = &values_[9 * place(column, static_cast<int>(n))];
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t d = column == static_cast<int>(n) ? c : 0; d < 3; ++d)
          upper[3 * c + d] = lower[3 * d + c] = 0.5 * (upper[3 * c + d] + lower[3 * d + c]);
    }
}

void BlockMatrix::multiply(std::span<const Vec3> x, std::span<Vec3> y) const {
  parallelFor(nodes(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      Vec3 sum;
      for (int k = offsets()[n]; k < offsets()[n + 1]; ++k) {
        const double* const b = &values_[9 * static_cast<std::size_t>(k)];
        const Vec3& v = x[static_cast<std::size_t>(columns()[static_cast<std::size_t>(k)])];
        sum.x += b[0] * v.x + b[1] * v.y + b[2] * v.z;
        sum.y += b[3] * v.x + b[4] * v.y + b[5] * v.z;
        sum.z += b[6] * v.x + b[7] * v.y + b[8] * v.z;
      }
      y[n] = sum;
    }
  });
  sumOverRanks(y);
}

}  // namespace dovetail::linalg
