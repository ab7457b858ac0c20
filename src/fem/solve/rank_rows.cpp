#include "rank_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/lost_error.hpp"
#include "dovetail/core/team.hpp"

namespace dovetail::fem::detail {

namespace {

/// Numbers as bytes, and back.
template <class T>
std::vector<char> bytesOf(std::span<const T> values) {
  std::vector<char> bytes(values.size_bytes());
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}
template <class T>
std::vector<T> valuesOf(const std::vector<char>& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

/// The blocks of a row of K.
std::span<const int> columnsOf(const linalg::BlockMatrix& K, int node) {
  const auto begin = static_cast<std::size_t>(K.offsets()[static_cast<std::size_t>(node)]);
  const auto end = static_cast<std::size_t>(K.offsets()[static_cast<std::size_t>(node) + 1]);
  return K.columns().subspan(begin, end - begin);
}

template <class T>
std::span<const T> rowOf(const std::vector<int>& offsets, const std::vector<T>& all, std::size_t row) {
  const auto begin = static_cast<std::size_t>(offsets[row]);
  return std::span(all).subspan(begin, static_cast<std::size_t>(offsets[row + 1]) - begin);
}

}  // namespace

RankRows::RankRows(const DofMap& dofs) : dofs_(&dofs) {
  if (dofs.hasTies())
    throw InputError("nodes are tied to others, and elements are shared by ranks", "linear solver",
                     "run it by one process, or on one mesh without periodic ties");
}

void RankRows::update(const linalg::BlockMatrix& K) {
  if (patternId_ != K.patternId()) analyse(K);
  std::ranges::fill(rows_.own.value, 0.0);
  std::ranges::fill(rows_.others.value, 0.0);
  addOwn(K);
  addOthers(K);
  setDiagonals();
}

void RankRows::analyse(const linalg::BlockMatrix& K) {
  number(K);
  announce(K);
  lay(K);
  patternId_ = K.patternId();
}

void RankRows::number(const linalg::BlockMatrix& K) {
  const auto ranks = static_cast<std::size_t>(team().size());
  std::vector<int> next(ranks + 1, 0);
  for (const int owner : K.owners()) ++next[static_cast<std::size_t>(owner) + 1];
  for (std::size_t rank = 0; rank < ranks; ++rank) next[rank + 1] += next[rank];
  rows_.firsts.clear();
  for (const int first : next) rows_.firsts.push_back(3 * first);
  numberOf_.resize(K.nodes());
  nodes_.clear();
  for (std::size_t n = 0; n < K.nodes(); ++n) {
    numberOf_[n] = next[static_cast<std::size_t>(K.owners()[n])]++;
    if (K.owners()[n] == team().rank()) nodes_.push_back(static_cast<int>(n));
  }
}

/// Ranks tell each other which blocks they have in rows of others.
void RankRows::announce(const linalg::BlockMatrix& K) {
  const auto ranks = static_cast<std::size_t>(team().size());
  leaving_.assign(ranks, {});
  arriving_.assign(ranks, {});
  std::vector<std::vector<int>> words(ranks);
  for (int node = 0; node < static_cast<int>(K.nodes()); ++node) {
    const auto owner = static_cast<std::size_t>(K.owners()[static_cast<std::size_t>(node)]);
    const std::span<const int> columns = columnsOf(K, node);
    if (owner == static_cast<std::size_t>(team().rank()) || columns.size() < 2) continue;
    leaving_[owner].row.push_back(node);
    leaving_[owner].blocks.push_back(columns.size());
    words[owner].push_back(node);
    words[owner].push_back(static_cast<int>(columns.size()));
    words[owner].insert(words[owner].end(), columns.begin(), columns.end());
  }
  std::vector<std::vector<char>> letters;
  for (const std::vector<int>& rank : words) letters.push_back(bytesOf<int>(rank));
  letters = team().exchange(std::move(letters));
  for (std::size_t rank = 0; rank < ranks; ++rank) {
    const std::vector<int> said = valuesOf<int>(letters[rank]);
    Arriving& arriving = arriving_[rank];
    for (std::size_t k = 0; k < said.size(); k += 2 + static_cast<std::size_t>(said[k + 1])) {
      arriving.row.push_back(static_cast<int>(std::ranges::lower_bound(nodes_, said[k]) - nodes_.begin()));
      const auto first = said.begin() + static_cast<std::ptrdiff_t>(k) + 2;
      arriving.column.insert(arriving.column.end(), first, first + said[k + 1]);
      arriving.offsets.push_back(static_cast<int>(arriving.column.size()));
    }
  }
}

/// The rows with the blocks of all ranks, and where each block goes.
void RankRows::lay(const linalg::BlockMatrix& K) {
  rows_.own = {}, rows_.others = {};
  rows_.own.size = rows_.others.size = static_cast<int>(3 * nodes_.size());
  blockOffsets_.assign(1, 0);
  blockColumns_.clear(), blockPlaces_.clear();
  std::vector<int> nodeOf(numberOf_.size());
  for (std::size_t n = 0; n < numberOf_.size(); ++n)
    nodeOf[static_cast<std::size_t>(numberOf_[n])] = static_cast<int>(n);
  std::vector<std::size_t> next(arriving_.size(), 0);
  std::vector<int> columns;
  for (std::size_t row = 0; row < nodes_.size(); ++row) {
    columns.clear();
    for (const int node : columnsOf(K, nodes_[row])) columns.push_back(numberOf_[static_cast<std::size_t>(node)]);
    for (std::size_t rank = 0; rank < arriving_.size(); ++rank) {
      const Arriving& from = arriving_[rank];
      if (next[rank] == from.row.size() || from.row[next[rank]] != static_cast<int>(row)) continue;
      for (const int node : rowOf(from.offsets, from.column, next[rank]++))
        columns.push_back(numberOf_[static_cast<std::size_t>(node)]);
    }
    std::ranges::sort(columns);
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    layRow(row, columns, nodeOf);
  }
  rows_.own.value.resize(rows_.own.column.size());
  rows_.others.value.resize(rows_.others.column.size());
  place_.clear();
  for (std::size_t row = 0; row < nodes_.size(); ++row)
    for (const int node : columnsOf(K, nodes_[row])) place_.push_back(placeOf(row, node));
  for (Arriving& from : arriving_) {
    from.place.clear();
    for (std::size_t k = 0; k < from.row.size(); ++k)
      for (const int node : rowOf(from.offsets, from.column, k))
        from.place.push_back(placeOf(static_cast<std::size_t>(from.row[k]), node));
  }
  for (std::vector<int>* used : {&blockOffsets_, &blockColumns_, &blockPlaces_}) std::vector<int>().swap(*used);
}

/// The three rows of a node; blocks stand in all that are free at the same place.
void RankRows::layRow(std::size_t row, std::span<const int> columns, std::span<const int> nodeOf) {
  const auto own = static_cast<std::size_t>(team().rank());
  const int first = rows_.firsts[own] / 3, last = rows_.firsts[own + 1] / 3;
  std::array<int, 2> width{};
  for (const int column : columns) {
    const bool isOther = column < first || column >= last;
    blockColumns_.push_back(column);
    blockPlaces_.push_back(2 * width[isOther] + isOther);
    for (int d = 0; d < 3; ++d) width[isOther] += isFree(nodeOf[static_cast<std::size_t>(column)], d);
  }
  blockOffsets_.push_back(static_cast<int>(blockColumns_.size()));
  for (int c = 0; c < 3; ++c) {
    if (!isFree(nodes_[row], c)) {
      rows_.own.column.push_back(static_cast<int>(3 * row) + c);
    } else {
      for (const int column : columns) {
        const bool isOther = column < first || column >= last;
        linalg::RowMatrix& part = isOther ? rows_.others : rows_.own;
        for (int d = 0; d < 3; ++d)
          if (isFree(nodeOf[static_cast<std::size_t>(column)], d))
            part.column.push_back(3 * (isOther ? column : column - first) + d);
      }
    }
    for (linalg::RowMatrix* part : {&rows_.own, &rows_.others}) {
      if (part->column.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw LostError("the rows of a rank have more than 2147483647 entries", "linear solver", "take more ranks");
      part->offsets.push_back(static_cast<int>(part->column.size()));
    }
  }
}

int RankRows::placeOf(std::size_t row, int column) const {
  const auto first = blockColumns_.begin() + blockOffsets_[row], last = blockColumns_.begin() + blockOffsets_[row + 1];
  const auto found = std::lower_bound(first, last, numberOf_[static_cast<std::size_t>(column)]);
  return blockPlaces_[static_cast<std::size_t>(found - blockColumns_.begin())];
}

void RankRows::add(std::size_t row, std::span<const int> columns, std::span<const int> places, const double* blocks) {
  for (int c = 0; c < 3; ++c) {
    if (!isFree(nodes_[row], c)) continue;
    const std::size_t scalar = 3 * row + static_cast<std::size_t>(c);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      linalg::RowMatrix& part = places[k] % 2 == 1 ? rows_.others : rows_.own;
      auto to = static_cast<std::size_t>(part.offsets[scalar] + places[k] / 2);
      for (int d = 0; d < 3; ++d)
        if (isFree(columns[k], d))
          part.value[to++] += blocks[9 * k + 3 * static_cast<std::size_t>(c) + static_cast<std::size_t>(d)];
    }
  }
}

void RankRows::addOwn(const linalg::BlockMatrix& K) {
  std::size_t next = 0;
  for (std::size_t row = 0; row < nodes_.size(); ++row) {
    const std::span<const int> columns = columnsOf(K, nodes_[row]);
    const auto from = static_cast<std::size_t>(K.offsets()[static_cast<std::size_t>(nodes_[row])]);
    add(row, columns, std::span(place_).subspan(next, columns.size()), &K.values()[9 * from]);
    next += columns.size();
  }
}

void RankRows::addOthers(const linalg::BlockMatrix& K) {
  std::vector<std::vector<char>> letters;
  for (const Leaving& to : leaving_) {
    std::vector<double> values;
    for (std::size_t k = 0; k < to.row.size(); ++k) {
      const auto from = static_cast<std::size_t>(K.offsets()[static_cast<std::size_t>(to.row[k])]);
      const std::span<const double> blocks = K.values().subspan(9 * from, 9 * to.blocks[k]);
      values.insert(values.end(), blocks.begin(), blocks.end());
    }
    letters.push_back(bytesOf<double>(values));
  }
  letters = team().exchange(std::move(letters));
  for (std::size_t rank = 0; rank < letters.size(); ++rank) {
    const std::vector<double> values = valuesOf<double>(letters[rank]);
    const Arriving& from = arriving_[rank];
    for (std::size_t k = 0; k < from.row.size(); ++k)
      add(static_cast<std::size_t>(from.row[k]), rowOf(from.offsets, from.column, k),
          rowOf(from.offsets, from.place, k), &values[9 * static_cast<std::size_t>(from.offsets[k])]);
  }
}

/// As NodeRows does.
void RankRows::setDiagonals() {
  std::array<double, 2> sums{};  // of the free ones, and how many
  double largest = 0.0;
  const auto eachRow = [&](const auto& visit) {
    for (std::size_t row = 0; row < nodes_.size(); ++row)
      for (int c = 0; c < 3; ++c) {
        const std::size_t scalar = 3 * row + static_cast<std::size_t>(c);
        const auto first = rows_.own.column.begin() + rows_.own.offsets[scalar],
                   last = rows_.own.column.begin() + rows_.own.offsets[scalar + 1];
        const auto diagonal = std::lower_bound(first, last, static_cast<int>(scalar)) - rows_.own.column.begin();
        visit(isFree(nodes_[row], c), rows_.own.value[static_cast<std::size_t>(diagonal)]);
      }
  };
  eachRow([&](bool free, double value) {
    if (free) sums[0] += std::abs(value), sums[1] += 1.0, largest = std::max(largest, std::abs(value));
  });
  team().sum(sums);
  largestDiagonal_ = team().largest(largest);
  eachRow([&](bool free, double& value) {
    if (!free) value = sums[1] > 0.0 ? sums[0] / sums[1] : 1.0;
  });
}

bool RankRows::isFinite() const {
  const auto finite = [](double v) { return std::isfinite(v); };
  const bool own = std::ranges::all_of(rows_.own.value, finite) && std::ranges::all_of(rows_.others.value, finite);
  return team().largest(own ? 0.0 : 1.0) == 0.0;
}

std::vector<double> RankRows::expanded(std::span<const double> q) const {
  std::vector<double> own;
  own.reserve(3 * nodes_.size());
  for (const int node : nodes_)
    for (int c = 0; c < 3; ++c) own.push_back(isFree(node, c) ? q[static_cast<std::size_t>(freeRow(node, c))] : 0.0);
  return own;
}

void RankRows::gather(std::span<const double> own, std::span<double> q) const {
  const std::vector<std::vector<char>> letters = team().gather(bytesOf(own));
  std::vector<double> all;
  for (const std::vector<char>& letter : letters) {
    const std::vector<double> values = valuesOf<double>(letter);
    all.insert(all.end(), values.begin(), values.end());
  }
  for (std::size_t n = 0; n < numberOf_.size(); ++n)
    for (int c = 0; c < 3; ++c)
      if (const int free = freeRow(static_cast<int>(n), c); free >= 0)
        q[static_cast<std::size_t>(free)] =
            all[3 * static_cast<std::size_t>(numberOf_[n]) + static_cast<std::size_t>(c)];
}

}  // namespace dovetail::fem::detail
