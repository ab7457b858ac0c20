#include "dovetail/mpm/fill.hpp"

#include <array>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"

namespace dovetail::mpm {

namespace {

struct Parts {
  Vec3 begin, edge;  ///< m
  std::array<int, 3> count;

  std::size_t size() const {
    return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) * static_cast<std::size_t>(count[2]);
  }
  Vec3 middle(std::size_t k, bool plane) const {
    const auto nx = static_cast<std::size_t>(count[0]), ny = static_cast<std::size_t>(count[1]);
    const auto along = [&](int axis, std::size_t i) {
      return begin[axis] + edge[axis] * (static_cast<double>(i) + 0.5);
    };
    return {along(0, k % nx), along(1, k / nx % ny), plane ? 0.0 : along(2, k / (nx * ny))};
  }
};

void validate(const GridOptions& grid, const geometry::Box& box, int perAxis) {
  validate(grid);
  if (perAxis < 1)
    throw InputError(std::to_string(perAxis) + " points along an axis of a cell", "perAxis", "give 2 or more");
  for (int c = 0; c < 3; ++c)
    if (!(box.upper[c] > box.lower[c]) || !std::isfinite(box.upper[c] - box.lower[c]))
      throw InputError(std::string("the box has no extent along ") + "xyz"[c], "box",
                       "give its lower and upper corner; in the plane its extent along z is the thickness");
}

}  // namespace

namespace {

Parts partsOf(const GridOptions& grid, const geometry::Box& box, int perAxis) {
  validate(grid, box, perAxis);
  const Vec3 extent = box.upper - box.lower;
  Parts parts{box.lower, extent, {1, 1, 1}};
  for (int c = 0; c < (grid.plane ? 2 : 3); ++c) {
    int& count = parts.count[static_cast<std::size_t>(c)];
    count = std::max(1, static_cast<int>(std::lround(perAxis * extent[c] / grid.spacing)));
    parts.edge[c] = extent[c] / count;
  }
  return parts;
}

/// Without elements, and nodes that no face has.
fem::SolidMesh facesOnly(const fem::SolidMesh& mesh) {
  fem::SolidMesh faces;
  faces.thickness = mesh.thickness;
  faces.faceSets = mesh.faceSets;
  std::vector<int> number(mesh.X.size(), -1);
  for (auto& [name, set] : faces.faceSets)
    for (fem::Face& face : set)
      for (int& node : face.node) {
        if (node < 0) continue;
        int& own = number[static_cast<std::size_t>(node)];
        if (own < 0) {
          own = static_cast<int>(faces.X.size());
          faces.X.push_back(mesh.X[static_cast<std::size_t>(node)]);
        }
        node = own;
      }
  for (const auto& [name, nodes] : mesh.nodeSets)
    for (const int node : nodes)
      if (const int own = number[static_cast<std::size_t>(node)]; own >= 0) faces.nodeSets[name].push_back(own);
  return faces;
}

}  // namespace

fem::SolidMesh facesOfBox(const GridOptions& grid, const geometry::Box& box, int perAxis) {
  const Parts parts = partsOf(grid, box, perAxis);
  fem::SolidMesh faces = facesOnly(
      fem::boxOf(grid.plane ? fem::ElementShape::quad4 : fem::ElementShape::hex8, parts.count, box.lower, box.upper));
  if (grid.plane)
    for (Vec3& x : faces.X) x.z = 0.0;
  return faces;
}

MaterialPoints fillBox(const GridOptions& grid, const geometry::Box& box, int perAxis, const Vec3& velocity) {
  const Parts parts = partsOf(grid, box, perAxis);
  MaterialPoints points;
  for (std::size_t k = 0; k < parts.size(); ++k) points.x.push_back(parts.middle(k, grid.plane));
  points.v.assign(parts.size(), velocity);
  points.volume.assign(parts.size(), parts.edge.x * parts.edge.y * parts.edge.z);
  return points;
}

MaterialPoints fillInside(const GridOptions& grid, const geometry::Box& box, int perAxis,
                          const std::function<bool(const Vec3&)>& inside, double volume, const Vec3& velocity) {
  validate(grid, box, perAxis);
  requirePositive(volume, "volume of the region");
  const double edge = grid.spacing / perAxis;
  Parts parts{grid.origin, {edge, edge, edge}, {1, 1, 1}};
  for (int c = 0; c < (grid.plane ? 2 : 3); ++c) {
    const double first = std::floor((box.lower[c] - grid.origin[c]) / edge);
    parts.begin[c] += edge * first;
    parts.count[static_cast<std::size_t>(c)] =
        static_cast<int>(std::ceil((box.upper[c] - grid.origin[c]) / edge) - first);
  }
  std::vector<std::uint8_t> isIn(parts.size());
  parallelFor(parts.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) isIn[k] = inside(parts.middle(k, grid.plane)) ? 1 : 0;
  });
  MaterialPoints points;
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (isIn[k] != 0) points.x.push_back(parts.middle(k, grid.plane));
  if (points.x.empty())
    throw InputError("no point lies inside: cells of " + formatNumber(grid.spacing) + " m are too coarse", "grid",
                     "take a smaller spacing, or look at the region");
  points.v.assign(points.x.size(), velocity);
  points.volume.assign(points.x.size(), volume / static_cast<double>(points.x.size()));
  return points;
}

}  // namespace dovetail::mpm
