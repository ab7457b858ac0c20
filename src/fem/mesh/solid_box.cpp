#include <algorithm>
#include <span>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"

namespace dovetail::fem {

namespace {

constexpr std::array<const char*, 6> sideNames = {"x-", "x+", "y-", "y+", "z-", "z+"};
using Place = std::array<int, 3>;

/// Places of the 27 nodes of a cell on a lattice of half cells, in VTK's order.
constexpr std::array<Place, 27> brickPlaces = {
    {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}, {1, 0, 0},
     {2, 1, 0}, {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2}, {1, 2, 2}, {0, 1, 2}, {0, 0, 1}, {2, 0, 1},
     {2, 2, 1}, {0, 2, 1}, {0, 1, 1}, {2, 1, 1}, {1, 0, 1}, {1, 2, 1}, {1, 1, 0}, {1, 1, 2}, {1, 1, 1}}};
/// Six tetrahedra around the diagonal 0–6, the same in every cell, so that neighbours fit (Kuhn 1960).
constexpr std::array<std::array<int, 4>, 6> kuhnTets = {
    {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}}};

/// The elements of one cell as places on its lattice.
std::vector<std::vector<Place>> cellPattern(ElementShape shape) {
  if (dimensionOf(shape) == 2) {
    std::vector<Place> places(brickPlaces.begin(), brickPlaces.begin() + 4);
    if (shape == ElementShape::quad8) places.insert(places.end(), brickPlaces.begin() + 8, brickPlaces.begin() + 12);
    return {places};
  }
  if (shape != ElementShape::tet4 && shape != ElementShape::tet10)
    return {std::vector<Place>(brickPlaces.begin(), brickPlaces.begin() + nodesOf(shape))};
  std::vector<std::vector<Place>> pattern;
  for (const auto& tet : kuhnTets) {
    std::vector<Place> places;
    for (const int corner : tet) places.push_back(brickPlaces[static_cast<std::size_t>(corner)]);
    if (shape == ElementShape::tet10)
      for (const auto& [a, b] : edgesOf(shape)) {
        const Place p = places[static_cast<std::size_t>(a)], q = places[static_cast<std::size_t>(b)];
        places.push_back({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
      }
    pattern.push_back(places);
  }
  return pattern;
}

/// The lattice of half cells over the whole box; places without a node hold −1.
class Lattice {
public:
  explicit Lattice(Place cells)
      : points_{2 * cells[0] + 1, 2 * cells[1] + 1, 2 * cells[2] + 1},
        node_(static_cast<std::size_t>(points_[0]) * static_cast<std::size_t>(points_[1]) *
                  static_cast<std::size_t>(points_[2]),
              -1) {}
  int& node(const Place& p) {
    const auto n = [](int i) { return static_cast<std::size_t>(i); };
    return node_[n(p[0]) + n(points_[0]) * (n(p[1]) + n(points_[1]) * n(p[2]))];
  }
  std::array<bool, 6> sides(const Place& p) const {
    return {p[0] == 0, p[0] == points_[0] - 1, p[1] == 0, p[1] == points_[1] - 1, p[2] == 0, p[2] == points_[2] - 1};
  }
  /// Calls visit(place) along x first, then y, then z.
  template <class Visit>
  void forEach(Visit&& visit) const {
    for (int k = 0; k < points_[2]; ++k)
      for (int j = 0; j < points_[1]; ++j)
        for (int i = 0; i < points_[0]; ++i) visit(Place{i, j, k});
  }
  Vec3 position(const Place& p, const Vec3& lower, const Vec3& upper) const {
    Vec3 X;
    for (int axis = 0; axis < 3; ++axis) {
      const int step = p[static_cast<std::size_t>(axis)], last = points_[static_cast<std::size_t>(axis)] - 1;
      // Halves of even numbers: corners lie where a lattice of whole cells has them, to the last bit.
      X[axis] = step == last ? upper[axis] : lower[axis] + (upper[axis] - lower[axis]) * (0.5 * step) / (0.5 * last);
    }
    return X;
  }

private:
  Place points_;
  std::vector<int> node_;
};

Place sum(const Place& a, const Place& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

template <class Visit>
void forEachCell(Place cells, Visit&& visit) {
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i) visit(Place{2 * i, 2 * j, 2 * k});
}

void addFaces(SolidMesh& mesh, std::span<const std::array<bool, 6>> sidesOfNode) {
  for (const Face& face : boundaryFaces(mesh)) {
    std::array<bool, 6> on = {true, true, true, true, true, true};
    for (int a = 0; a < nodesOf(face.shape); ++a)
      for (std::size_t side = 0; side < 6; ++side)
        on[side] = on[side] && sidesOfNode[static_cast<std::size_t>(face.node[static_cast<std::size_t>(a)])][side];
    for (std::size_t side = 0; side < 6; ++side)
      if (on[side]) mesh.faceSets[sideNames[side]].push_back(face);
    mesh.faceSets["skin"].push_back(face);
  }
}

void requireBox(ElementShape shape, const Place& cells, const Vec3& lower, const Vec3& upper) {
  if (dimensionOf(shape) == 2 && cells[2] != 1)
    throw InputError("there are " + std::to_string(cells[2]) + " layers of " + name(shape), "box of elements, axis z",
                     "give 1");
  for (int axis = 0; axis < 3; ++axis) {
    const std::string where = std::string("box of elements, axis ") + "xyz"[axis];
    if (cells[static_cast<std::size_t>(axis)] < 1)
      throw InputError("there are no elements along it", where, "give 1 or more");
    if (!isFinite(lower) || !isFinite(upper) || !(upper[axis] > lower[axis]))
      throw InputError("the box has no length", where, "give upper > lower");
  }
}

}  // namespace

SolidMesh boxOf(ElementShape shape, std::array<int, 3> cells, Vec3 lower, Vec3 upper) {
  requireBox(shape, cells, lower, upper);
  const auto pattern = cellPattern(shape);
  Lattice lattice(cells);
  forEachCell(cells, [&](const Place& cell) {
    for (const auto& element : pattern)
      for (const Place& place : element) lattice.node(sum(cell, place)) = 0;
  });
  SolidMesh mesh;
  std::vector<std::array<bool, 6>> sidesOfNode;
  lattice.forEach([&](const Place& place) {
    int& node = lattice.node(place);
    if (node < 0) return;
    node = static_cast<int>(mesh.X.size());
    mesh.X.push_back(lattice.position(place, lower, upper));
    std::array<bool, 6> on = lattice.sides(place);
    if (dimensionOf(shape) == 2) on[4] = on[5] = false;
    sidesOfNode.push_back(on);
    for (std::size_t side = 0; side < 6; ++side)
      if (on[side]) mesh.nodeSets[sideNames[side]].push_back(node);
    if (std::find(on.begin(), on.end(), true) != on.end()) mesh.nodeSets["skin"].push_back(node);
  });
  if (dimensionOf(shape) == 2) mesh.thickness = upper.z - lower.z;
  ElementGroup& group = mesh.groups.emplace_back(ElementGroup{shape, {}});
  forEachCell(cells, [&](const Place& cell) {
    for (const auto& element : pattern)
      for (const Place& place : element) group.node.push_back(lattice.node(sum(cell, place)));
  });
  addFaces(mesh, sidesOfNode);
  return mesh;
}

}  // namespace dovetail::fem
