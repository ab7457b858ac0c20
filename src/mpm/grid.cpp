#include "dovetail/mpm/grid.hpp"

#include <array>
#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "grid_nodes.hpp"

namespace dovetail::mpm {

namespace {

using detail::axesOf;
using detail::nodeOf;
constexpr std::size_t pointChunk = 512;
constexpr const char* axisName = "xyz";

double placeOf(const GridOptions& grid, int axis, double x) { return (x - grid.origin[axis]) / grid.spacing; }

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

detail::Index firstOf(const Weights& weights) { return {weights[0].first, weights[1].first, weights[2].first}; }

/// Why a point has no weights; empty if it has.
std::string whyOutside(const GridOptions& grid, const Vec3& x) {
  if (!isFinite(x)) return "its place is not finite";
  for (int axis = 0; axis < axesOf(grid); ++axis)
    if (std::abs(placeOf(grid, axis, x[axis])) > detail::mostCells)
      return "it lies at " + formatNumber(x[axis]) + " m, too many cells from the origin of the grid";
  for (const GridBorder& border : grid.borders)
    if (const double at = x[border.axis]; border.above ? at > border.place : at < border.place)
      return "it has passed the " + textOf(border);
  return {};
}

void requireWithin(const GridOptions& grid, std::span<const Vec3> x, const std::string& name) {
  for (std::size_t p = 0; p < x.size(); ++p)
    if (const std::string reason = whyOutside(grid, x[p]); !reason.empty())
      throw NumericalError(reason, "point " + std::to_string(p) + " of \"" + name + "\"",
                           "take a smaller step or load");
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
  std::vector<detail::Index> first(x.size());
  parallelFor(x.size(), pointChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      along[p] = weightsOf(grid, x[p]);
      first[p] = firstOf(along[p]);
    }
  });
  detail::findNodes(grid, first, name, rows);
  findWeights(grid, along, rows);
  return rows;
}

}  // namespace dovetail::mpm
