#include "dovetail/arlequin/cells.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/shape.hpp"

namespace dovetail::arlequin {

namespace {

bool isTetrahedron(fem::ElementShape shape) {
  return shape == fem::ElementShape::tet4 || shape == fem::ElementShape::tet10;
}
bool isCurved(fem::ElementShape shape) { return shape != fem::ElementShape::hex8 && shape != fem::ElementShape::tet4; }

struct ParentPoint {
  Vec3 xi;
  double weight;
};

/// Gauss points of [−1, 1] cut into parts: two each, or three for cells with curved edges.
std::vector<std::array<double, 2>> linePoints(int parts, bool curved) {
  const double size = 1.0 / parts, two = 1.0 / std::sqrt(3.0), three = std::sqrt(0.6);
  std::vector<std::array<double, 2>> line;
  for (int c = 0; c < parts; ++c) {
    const auto at = [&](double side) { return -1.0 + size * (2.0 * c + 1.0 + side); };
    if (!curved)
      for (const double side : {-two, two}) line.push_back({at(side), size});
    else
      for (const double side : {-three, 0.0, three}) line.push_back({at(side), size * (side == 0.0 ? 8.0 : 5.0) / 9.0});
  }
  return line;
}

std::vector<ParentPoint> brickPoints(int parts, bool curved) {
  const auto line = linePoints(parts, curved);
  std::vector<ParentPoint> points;
  for (const auto& z : line)
    for (const auto& y : line)
      for (const auto& x : line) points.push_back({{x[0], y[0], z[0]}, x[1] * y[1] * z[1]});
  return points;
}

using Corners = std::array<Vec3, 4>;

/// Four points each, exact for the products of two vertex shape functions, of a tetrahedron halved `depth` times.
void addTetrahedron(const Corners& c, int depth, std::vector<ParentPoint>& points) {
  if (depth > 0) {
    const auto middle = [&](std::size_t a, std::size_t b) { return 0.5 * (c[a] + c[b]); };
    const Vec3 ab = middle(0, 1), bc = middle(1, 2), ca = middle(2, 0), ad = middle(0, 3), bd = middle(1, 3),
               cd = middle(2, 3);
    for (const Corners& part : {Corners{c[0], ab, ca, ad},
                                {ab, c[1], bc, bd},
                                {ca, bc, c[2], cd},
                                {ad, bd, cd, c[3]},
                                {ab, bc, ca, bd},
                                {ab, ca, ad, bd},
                                {ca, cd, ad, bd},
                                {ca, bc, cd, bd}})
      addTetrahedron(part, depth - 1, points);
    return;
  }
  const double volume = std::abs(dot(c[1] - c[0], cross(c[2] - c[0], c[3] - c[0]))) / 6.0;
  const double near = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0, far = (5.0 - std::sqrt(5.0)) / 20.0;
  for (std::size_t k = 0; k < 4; ++k) {
    Vec3 xi;
    for (std::size_t a = 0; a < 4; ++a) xi += (a == k ? near : far) * c[a];
    points.push_back({xi, 0.25 * volume});
  }
}

std::vector<ParentPoint> parentPoints(fem::ElementShape shape, int parts) {
  if (!isTetrahedron(shape)) return brickPoints(parts, isCurved(shape));
  std::vector<ParentPoint> points;
  int depth = isCurved(shape) ? 1 : 0;
  for (int cut = 1; cut < parts; cut *= 2) ++depth;
  addTetrahedron({Vec3{}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, depth, points);
  return points;
}

/// A row of shape functions written into an array.
void vertexShapesAt(fem::ElementShape shape, const Vec3& xi, std::span<double> vertexShape) {
  const std::vector<double> row = vertexShapes(shape, xi);
  std::copy(row.begin(), row.end(), vertexShape.begin());
}

}  // namespace

std::span<const int> Cell::corner() const { return node.first(static_cast<std::size_t>(fem::cornersOf(shape))); }

Cell cellOf(const fem::SolidMesh& mesh, int element) {
  auto first = static_cast<std::size_t>(element);
  for (const fem::ElementGroup& group : mesh.groups) {
    const auto nodes = static_cast<std::size_t>(fem::nodesOf(group.shape));
    if (first < group.size()) return {group.shape, std::span(group.node).subspan(first * nodes, nodes)};
    first -= group.size();
  }
  throw InputError("element " + std::to_string(element) + " does not exist", "overlap", "use numbers of the mesh");
}

void requireSpatialCells(const fem::SolidMesh& mesh) {
  for (const fem::ElementGroup& group : mesh.groups)
    if (fem::dimensionOf(group.shape) == 2)
      throw InputError(std::string("the mesh has ") + fem::name(group.shape) + " cells of plane strain", "overlap",
                       "give bricks or tetrahedra: particles are spheres");
}

std::vector<double> vertexShapes(fem::ElementShape shape, const Vec3& xi) {
  constexpr double roundOff = 1e-9;
  const Vec3 within = fem::nearestInParent(shape, xi);
  const Vec3 place = norm(within - xi) > roundOff ? within : xi;
  return fem::shapeRow(isTetrahedron(shape) ? fem::ElementShape::tet4 : fem::ElementShape::hex8, place);
}

std::vector<CellPoint> cellPoints(const fem::SolidMesh& mesh, std::span<const Vec3> position, int element, int parts) {
  const Cell cell = cellOf(mesh, element);
  std::vector<double> value(cell.node.size());
  std::vector<Vec3> gradient(cell.node.size());
  std::vector<CellPoint> points;
  for (const ParentPoint& at : parentPoints(cell.shape, parts)) {
    fem::shapeFunctions(cell.shape, at.xi, value, gradient);
    CellPoint& point = points.emplace_back();
    std::array<Vec3, 3> J;  // column j = ∂x/∂ξ_j
    for (std::size_t a = 0; a < cell.node.size(); ++a) {
      const Vec3& x = position[static_cast<std::size_t>(cell.node[a])];
      point.x += value[a] * x;
      for (std::size_t j = 0; j < 3; ++j) J[j] += gradient[a][static_cast<int>(j)] * x;
    }
    point.weight = at.weight * dot(J[0], cross(J[1], J[2]));
    vertexShapesAt(cell.shape, at.xi, point.vertexShape);
  }
  return points;
}

double cellVolume(const fem::SolidMesh& mesh, int element) {
  double volume = 0.0;
  for (const CellPoint& point : cellPoints(mesh, mesh.X, element, 1)) volume += point.weight;
  return volume;
}

double elementSize(const fem::SolidMesh& mesh, int element) {
  const double weight = isTetrahedron(cellOf(mesh, element).shape) ? 6.0 * std::numbers::sqrt2 : 1.0;
  return std::cbrt(weight * cellVolume(mesh, element));
}

std::vector<Vec3> positionsOf(std::span<const Vec3> X, std::span<const Vec3> u) {
  std::vector<Vec3> x(X.size());
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = X[n] + u[n];
  return x;
}

}  // namespace dovetail::arlequin
