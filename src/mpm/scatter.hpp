// Loops over cells of a grid, whose points share their nodes, and sums at nodes; their order does not depend on
// threads.
#pragma once

#include <array>
#include <type_traits>
#include <vector>

#include "dovetail/core/parallel.hpp"
#include "dovetail/mpm/grid.hpp"

namespace dovetail::mpm::detail {

constexpr std::size_t mostReached = mostInReach * mostInReach * mostInReach;
template <class Value>
using OfReached = std::array<Value, mostReached>;

/// Values of nodes as the points of a cell see them.
inline void look(const GridRows& rows, std::size_t cell, std::span<const Vec3> nodal, OfReached<Vec3>& seen) {
  const std::size_t begin = rows.perPoint * cell;
  for (std::size_t a = 0; a < rows.perPoint; ++a) {
    const Vec3& value = nodal[static_cast<std::size_t>(rows.node[begin + a])];
    const std::uint8_t flip = rows.flip[begin + a];
    seen[a] = flip == 0 ? value : flipped(value, flip);
  }
}

/// Calls visit(cell) on all threads.
template <class Visit>
void eachCell(const GridRows& rows, Visit&& visit) {
  constexpr std::size_t cellChunk = 64;
  parallelFor(rows.cells(), cellChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) visit(c);
  });
}

template <class Visit>
void eachPointOf(const GridRows& rows, std::size_t cell, Visit&& visit) {
  for (int k = rows.firstOfCell[cell]; k < rows.firstOfCell[cell + 1]; ++k)
    visit(static_cast<std::size_t>(rows.pointOfCell[static_cast<std::size_t>(k)]));
}

/// Calls run(axes) with the number of axes as a constant.
template <class Run>
void withAxes(bool plane, Run&& run) {
  if (plane)
    run(std::integral_constant<int, 2>{});
  else
    run(std::integral_constant<int, 3>{});
}

/// y += B x with nine numbers in rows, of the first axes.
template <int axes>
void addProduct(const double* B, const Vec3& x, Vec3& y) {
  if constexpr (axes == 2) {
    y.x += B[0] * x.x + B[1] * x.y, y.y += B[3] * x.x + B[4] * x.y;
  } else {
    y.x += B[0] * x.x + B[1] * x.y + B[2] * x.z;
    y.y += B[3] * x.x + B[4] * x.y + B[5] * x.z;
    y.z += B[6] * x.x + B[7] * x.y + B[8] * x.z;
  }
}

/// B += x ⊗ y.
template <int axes>
void addOuter(const Vec3& x, const Vec3& y, double* B) {
  B[0] += x.x * y.x, B[1] += x.x * y.y;
  B[3] += x.y * y.x, B[4] += x.y * y.y;
  if constexpr (axes == 3) {
    B[2] += x.x * y.z, B[5] += x.y * y.z;
    B[6] += x.z * y.x, B[7] += x.z * y.y, B[8] += x.z * y.z;
  }
}

inline Vec3 turned(const Vec3& value, std::uint8_t flip) { return flip == 0 ? value : flipped(value, flip); }
inline double turned(double value, std::uint8_t) { return value; }

/// to[node] += what points give: first those of a cell, then cells around a node.
/// @param give  give(point, sums) adds what the point gives to each of the nodes that it reaches, as it sees them
template <class Value, class Give>
void addToNodes(const GridRows& rows, std::span<Value> to, Give&& give) {
  constexpr std::size_t nodeChunk = 256;
  const std::size_t count = rows.perPoint;
  std::vector<Value> sums(rows.node.size());
  eachCell(rows, [&](std::size_t c) {
    OfReached<Value> own;
    std::fill_n(own.begin(), count, Value{});
    eachPointOf(rows, c, [&](std::size_t p) { give(p, own); });
    std::copy_n(own.begin(), count, sums.begin() + static_cast<std::ptrdiff_t>(count * c));
  });
  parallelFor(rows.nodes(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for (int k = rows.firstOfNode[n]; k < rows.firstOfNode[n + 1]; ++k) {
        const auto entry = static_cast<std::size_t>(rows.entryOfNode[static_cast<std::size_t>(k)]);
        to[n] += turned(sums[entry], rows.flip[entry]);
      }
  });
}

}  // namespace dovetail::mpm::detail
