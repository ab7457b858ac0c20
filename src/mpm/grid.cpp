#include "dovetail/mpm/grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::mpm {

namespace {

using Index = std::array<int, 3>;
constexpr std::size_t pointChunk = 512;
constexpr const char* axisName = "xyz";

int axesOf(const GridOptions& grid) { return grid.plane ? 2 : 3; }

double placeOf(const GridOptions& grid, int axis, double x) { return (x - grid.origin[axis]) / grid.spacing; }

Vec3 placeOf(const GridOptions& grid, const Index& node) {
  const Vec3 x = grid.origin + grid.spacing * Vec3{1.0 * node[0], 1.0 * node[1], 1.0 * node[2]};
  return grid.plane ? Vec3{x.x, x.y, 0.0} : x;
}

int nodeOf(const GridOptions& grid, const GridBorder& border) {
  return static_cast<int>(std::lround(placeOf(grid, border.axis, border.place)));
}

std::string textOf(const GridBorder& border) {
  std::string text = "border of ";
  text += axisName[border.axis];
  return text += border.above ? " above" : " below";
}

/// Weights of a point along all axes.
using Weights = std::array<LineWeights, 3>;

Weights weightsOf(const GridOptions& grid, const Vec3& x) {
  Weights weights;
  for (int axis = 0; axis < axesOf(grid); ++axis)
    weights[static_cast<std::size_t>(axis)] = weightsAt(grid.shape, placeOf(grid, axis, x[axis]), grid.gimpHalf);
  if (grid.plane) weights[2].value[0] = 1.0;
  return weights;
}

Index firstOf(const Weights& weights) { return {weights[0].first, weights[1].first, weights[2].first}; }

bool before(const Index& a, const Index& b) {
  return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
}

void sortUnique(std::vector<Index>& all) {
  std::ranges::sort(all, before);
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

int numberOf(const std::vector<Index>& sorted, const Index& one) {
  return static_cast<int>(std::ranges::lower_bound(sorted, one, before) - sorted.begin());
}

/// Puts a node beyond a border in the place of its mirror image. @return components with the other sign
std::uint8_t fold(const GridOptions& grid, Index& node) {
  std::uint8_t flip = 0;
  for (const GridBorder& border : grid.borders) {
    int& i = node[static_cast<std::size_t>(border.axis)];
    const int at = nodeOf(grid, border);
    if (border.above ? i <= at : i >= at) continue;
    i = 2 * at - i;
    flip ^= static_cast<std::uint8_t>(border.kind == BorderKind::held ? 7 : 1 << border.axis);
  }
  return flip;
}

std::uint8_t fixedAt(const GridOptions& grid, const Index& node) {
  std::uint8_t fixed = grid.plane ? 4 : 0;
  for (const GridBorder& border : grid.borders)
    if (node[static_cast<std::size_t>(border.axis)] == nodeOf(grid, border))
      fixed |= static_cast<std::uint8_t>(border.kind == BorderKind::held ? 7 : 1 << border.axis);
  return fixed;
}

void requireWithin(const GridOptions& grid, std::span<const Vec3> x, const std::string& name) {
  for (std::size_t p = 0; p < x.size(); ++p) {
    const std::string where = "point " + std::to_string(p) + " of \"" + name + "\"";
    if (!isFinite(x[p])) throw NumericalError("its place is not finite", where, "take a smaller step or load");
    for (const GridBorder& border : grid.borders)
      if (const double at = x[p][border.axis]; border.above ? at > border.place : at < border.place)
        throw NumericalError("it has passed the " + textOf(border), where, "take a smaller step or load");
  }
}

/// Calls visit(a, ix, iy, iz) for the nodes that a point reaches.
template <class Visit>
void eachOf(const GridOptions& grid, Visit&& visit) {
  const int reach = reachOf(grid.shape), layers = grid.plane ? 1 : reach;
  std::size_t a = 0;
  for (int k = 0; k < layers; ++k)
    for (int j = 0; j < reach; ++j)
      for (int i = 0; i < reach; ++i) visit(a++, i, j, k);
}

void findNodes(const GridOptions& grid, const std::vector<Index>& cells, GridRows& rows) {
  std::vector<Index> reached, nodes;
  reached.reserve(rows.perPoint * cells.size());
  for (const Index& first : cells)
    eachOf(grid, [&](std::size_t, int i, int j, int k) {
      Index node{first[0] + i, first[1] + j, first[2] + k};
      rows.reached.push_back(placeOf(grid, node));
      rows.flip.push_back(fold(grid, node));
      reached.push_back(node);
    });
  nodes = reached;
  sortUnique(nodes);
  for (const Index& node : reached) rows.node.push_back(numberOf(nodes, node));
  for (const Index& node : nodes) {
    rows.X.push_back(placeOf(grid, node));
    rows.fixed.push_back(fixedAt(grid, node));
  }
}

void findWeights(const GridOptions& grid, const std::vector<Weights>& along, GridRows& rows) {
  rows.weight.resize(rows.perPoint * along.size());
  rows.slope.resize(rows.weight.size());
  parallelFor(along.size(), pointChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const LineWeights &x = along[p][0], &y = along[p][1], &z = along[p][2];
      eachOf(grid, [&](std::size_t a, std::size_t i, std::size_t j, std::size_t k) {
        const double plane = x.value[i] * y.value[j];
        rows.weight[rows.perPoint * p + a] = plane * z.value[k];
        rows.slope[rows.perPoint * p + a] =
            1.0 / grid.spacing *
            Vec3{x.slope[i] * y.value[j] * z.value[k], x.value[i] * y.slope[j] * z.value[k], plane * z.slope[k]};
      });
    }
  });
}

/// Places of values 0 … count − 1 in `of`, ascending: CSR.
void sortInto(const std::vector<int>& of, std::size_t count, std::vector<int>& first, std::vector<int>& places) {
  first.assign(count + 1, 0);
  for (const int value : of) ++first[static_cast<std::size_t>(value) + 1];
  for (std::size_t k = 0; k < count; ++k) first[k + 1] += first[k];
  places.resize(of.size());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (std::size_t k = 0; k < of.size(); ++k)
    places[static_cast<std::size_t>(next[static_cast<std::size_t>(of[k])]++)] = static_cast<int>(k);
}

}  // namespace

void validate(const GridOptions& grid) {
  requirePositive(grid.spacing, "spacing of the grid");
  if (!(grid.gimpHalf > 0.0 && grid.gimpHalf <= 0.5))
    throw InputError("gimpHalf is " + formatNumber(grid.gimpHalf), "GridOptions", "give a number above 0, up to 0.5");
  for (std::size_t k = 0; k < grid.borders.size(); ++k) {
    const GridBorder& border = grid.borders[k];
    if (border.axis < 0 || border.axis >= axesOf(grid))
      throw InputError("a border has the axis " + std::to_string(border.axis), "GridOptions",
                       grid.plane ? "give 0 or 1 in the plane" : "give 0, 1 or 2");
    const double at = placeOf(grid, border.axis, border.place);
    if (!std::isfinite(at)) throw InputError("the " + textOf(border) + " is nowhere", "GridOptions", "give a place");
    if (std::abs(at - std::round(at)) > 1e-9)
      throw InputError("the " + textOf(border) + " lies between nodes", "GridOptions",
                       "move the origin of the grid, or take a spacing that divides the distance of borders");
    for (std::size_t other = 0; other < k; ++other) {
      if (grid.borders[other].axis != border.axis) continue;
      if (grid.borders[other].above == border.above)
        throw InputError("there are two " + textOf(border), "GridOptions", "give one");
      const GridBorder &top = border.above ? border : grid.borders[other],
                       &bottom = border.above ? grid.borders[other] : border;
      if (nodeOf(grid, top) - nodeOf(grid, bottom) < reachOf(grid.shape))
        throw InputError("borders of " + std::string(1, axisName[border.axis]) + " are " +
                             std::to_string(nodeOf(grid, top) - nodeOf(grid, bottom)) + " cells apart",
                         "GridOptions", "give " + std::to_string(reachOf(grid.shape)) + " or more: a finer grid");
    }
  }
}

GridRows rowsAt(const GridOptions& grid, std::span<const Vec3> x, const std::string& name) {
  requireWithin(grid, x, name);
  GridRows rows;
  const auto reach = static_cast<std::size_t>(reachOf(grid.shape));
  rows.perPoint = reach * reach * (grid.plane ? 1 : reach);
  std::vector<Weights> along(x.size());
  parallelFor(x.size(), pointChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) along[p] = weightsOf(grid, x[p]);
  });
  std::vector<Index> cells;
  for (const Weights& one : along) cells.push_back(firstOf(one));
  sortUnique(cells);
  rows.cell.resize(x.size());
  parallelFor(x.size(), pointChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) rows.cell[p] = numberOf(cells, firstOf(along[p]));
  });
  findNodes(grid, cells, rows);
  findWeights(grid, along, rows);
  sortInto(rows.cell, cells.size(), rows.firstOfCell, rows.pointOfCell);
  sortInto(rows.node, rows.nodes(), rows.firstOfNode, rows.entryOfNode);
  return rows;
}

}  // namespace dovetail::mpm
