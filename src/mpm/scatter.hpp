// Sums of points at nodes, whose order does not depend on threads.
#pragma once

#include <vector>

#include "dovetail/core/parallel.hpp"
#include "dovetail/mpm/grid.hpp"

namespace dovetail::mpm::detail {

/// to[node] += Σ share(point, place of the node among those of the point), over all points that reach a node: first of
/// the points of each cell, then of the cells around a node. @param turn  turn(value, flip) as the node sees it
template <class Value, class Share, class Turn>
void addToNodes(const GridRows& rows, std::span<Value> to, Share&& share, Turn&& turn) {
  constexpr std::size_t cellChunk = 64, nodeChunk = 256;
  const std::size_t count = rows.perPoint;
  std::vector<Value> sums(rows.node.size(), Value{});
  parallelFor(rows.cells(), cellChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      for (int k = rows.firstOfCell[c]; k < rows.firstOfCell[c + 1]; ++k) {
        const auto p = static_cast<std::size_t>(rows.pointOfCell[static_cast<std::size_t>(k)]);
        for (std::size_t a = 0; a < count; ++a) sums[count * c + a] += share(p, a);
      }
  });
  parallelFor(rows.nodes(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      for (int k = rows.firstOfNode[n]; k < rows.firstOfNode[n + 1]; ++k) {
        const auto entry = static_cast<std::size_t>(rows.entryOfNode[static_cast<std::size_t>(k)]);
        to[n] += turn(sums[entry], rows.flip[entry]);
      }
  });
}

}  // namespace dovetail::mpm::detail
