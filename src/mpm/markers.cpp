#include "dovetail/mpm/markers.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "anchors.hpp"
#include "cubes.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::mpm {

std::vector<Vec3> withImages(const Markers& markers, std::span<const Vec3> nodal) {
  std::vector<Vec3> all(nodal.begin(), nodal.end());
  for (const auto& [node, flip] : markers.images) all.push_back(flipped(nodal[static_cast<std::size_t>(node)], flip));
  return all;
}

std::vector<Vec3> valuesAt(const Markers& markers, std::span<const Vec3> nodal) {
  std::vector<Vec3> values(markers.X.size());
  cg::apply(markers.map, withImages(markers, nodal), values);
  return values;
}

void addTransposed(const Markers& markers, std::span<const Vec3> values, std::span<Vec3> nodal) {
  std::vector<Vec3> all(static_cast<std::size_t>(markers.map.columns));
  cg::applyTransposed(markers.map, values, all);
  const std::size_t nodes = markers.nodes();
  for (std::size_t n = 0; n < nodes; ++n) nodal[n] += all[n];
  for (std::size_t k = 0; k < markers.images.size(); ++k) {
    const auto& [node, flip] = markers.images[k];
    nodal[static_cast<std::size_t>(node)] += flipped(all[nodes + k], flip);
  }
}

namespace detail {

namespace {

constexpr double hardlyFarther = 1.1;

}  // namespace

Anchors nearestPoints(const GridOptions& grid, std::span<const Vec3> points, std::span<const Vec3> markers,
                      const std::string& name) {
  const Cubes cubes(grid.spacing, points);
  Anchors anchors;
  for (std::size_t m = 0; m < markers.size(); ++m) {
    double nearest = grid.spacing;
    if (isFinite(markers[m]))
      cubes.near(markers[m], [&](std::size_t, double far) { nearest = std::min(nearest, far); });
    if (!(nearest < grid.spacing))
      throw InputError("it is not finite, or farther than the spacing of the grid from every point",
                       "marker " + std::to_string(m) + " of \"" + name + "\"", "put markers on the faces of the body");
    cubes.near(markers[m], [&](std::size_t p, double far) {
      if (far <= hardlyFarther * nearest) anchors.point.push_back(p);
    });
    anchors.first.push_back(anchors.point.size());
  }
  return anchors;
}

namespace {

/// Weights at X of the nodes that a point at x reaches, in the order of rows.
std::vector<double> weightsBeside(const GridOptions& grid, const Vec3& X, const Vec3& x) {
  std::vector<double> weights{1.0};
  const int reach = reachOf(grid.shape);
  for (int axis = grid.plane ? 1 : 2; axis >= 0; --axis) {
    const auto place = [&](const Vec3& at) { return (at[axis] - grid.origin[axis]) / grid.spacing; };
    const LineWeights line = mpm::weightsBeside(grid.shape, place(X), place(x), grid.gimpHalf);
    std::vector<double> product;
    for (const double weight : weights)
      for (int k = 0; k < reach; ++k) product.push_back(weight * line.value[static_cast<std::size_t>(k)]);
    weights = std::move(product);
  }
  return weights;
}

/// Values and gradients of the point at the marker.
std::vector<double> tangentsAt(const GridRows& rows, std::size_t p, const Vec3& arm) {
  std::vector<double> weights(rows.perPoint);
  for (std::size_t a = 0; a < weights.size(); ++a) {
    const std::size_t k = rows.perPoint * p + a;
    weights[a] = rows.weight[k] + dot(rows.slope[k], arm);
  }
  return weights;
}

/// Calls visit(m, p, share) for the points of each marker.
template <class Visit>
void eachAnchor(const Anchors& anchors, Visit&& visit) {
  for (std::size_t m = 0; m + 1 < anchors.first.size(); ++m) {
    const std::size_t first = anchors.first[m], end = anchors.first[m + 1];
    for (std::size_t k = first; k < end; ++k) visit(m, anchors.point[k], 1.0 / static_cast<double>(end - first));
  }
}

/// Calls visit(a, entry) for the nodes that a point reaches.
template <class Visit>
void eachEntry(const GridRows& rows, std::size_t p, Visit&& visit) {
  for (std::size_t a = 0; a < rows.perPoint; ++a) visit(a, rows.perPoint * static_cast<std::size_t>(rows.cell[p]) + a);
}

/// Nodes at which a face bears many times what their mass is of that of points: pressure would throw them. On faces
/// along nodes it is 4 times, at corners there 16.
std::vector<char> lightNodes(const GridOptions& grid, const GridRows& rows, const Anchors& anchors,
                             std::span<const Vec3> x, const std::vector<Vec3>& X) {
  constexpr double most = 18.0;
  std::vector<double> face(rows.nodes(), 0.0), mass(rows.nodes(), 0.0);
  for (std::size_t p = 0; p < rows.points(); ++p)
    eachEntry(rows, p, [&](std::size_t a, std::size_t entry) {
      mass[static_cast<std::size_t>(rows.node[entry])] += rows.weight[rows.perPoint * p + a];
    });
  eachAnchor(anchors, [&](std::size_t m, std::size_t p, double share) {
    const std::vector<double> weight = weightsBeside(grid, X[m], x[p]);
    eachEntry(rows, p, [&](std::size_t a, std::size_t entry) {
      face[static_cast<std::size_t>(rows.node[entry])] += share * std::abs(weight[a]);
    });
  });
  std::vector<char> light(rows.nodes());
  for (std::size_t n = 0; n < light.size(); ++n) light[n] = face[n] > most * mass[n] ? 1 : 0;
  return light;
}

}  // namespace

void findMap(const GridOptions& grid, const GridRows& rows, const Anchors& anchors, std::span<const Vec3> x,
             Markers& markers) {
  const auto nodes = static_cast<int>(rows.nodes());
  const std::vector<char> light = lightNodes(grid, rows, anchors, x, markers.X);
  std::map<std::pair<int, std::uint8_t>, int> columnOf;
  markers.images.clear();
  std::vector<cg::ProjectionRow> map(markers.X.size());
  eachAnchor(anchors, [&](std::size_t m, std::size_t p, double share) {
    bool isLight = false;
    eachEntry(rows, p, [&](std::size_t, std::size_t entry) {
      isLight = isLight || light[static_cast<std::size_t>(rows.node[entry])] != 0;
    });
    const std::vector<double> weight =
        isLight ? tangentsAt(rows, p, markers.X[m] - x[p]) : weightsBeside(grid, markers.X[m], x[p]);
    eachEntry(rows, p, [&](std::size_t a, std::size_t entry) {
      int column = rows.node[entry];
      if (const std::uint8_t flip = rows.flip[entry]; flip != 0) {
        const auto [place, isNew] =
            columnOf.try_emplace({column, flip}, nodes + static_cast<int>(markers.images.size()));
        if (isNew) markers.images.push_back({column, flip});
        column = place->second;
      }
      map[m].emplace_back(column, share * weight[a]);
    });
  });
  markers.map = cg::fromRows(nodes + static_cast<int>(markers.images.size()), map);
}

}  // namespace detail

}  // namespace dovetail::mpm
