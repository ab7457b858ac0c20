#include "dovetail/fem/mesh/mesh.hpp"

#include <algorithm>

#include "../elements/brick.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::fem {

namespace {

// Local faces of a brick, counter-clockwise from outside: x−, x+, y−, y+, z−, z+.
constexpr std::array<std::array<int, 4>, 6> localFaces = {
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};
constexpr std::array<const char*, 6> faceNames = {"x-", "x+", "y-", "y+", "z-", "z+"};

struct GridIndex {
  std::array<int, 3> cells;
  int node(int i, int j, int k) const { return i + (cells[0] + 1) * (j + (cells[1] + 1) * k); }
};

void addElementsAndFaces(Mesh& mesh, const GridIndex& grid) {
  const auto [nx, ny, nz] = grid.cells;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const std::array<int, 8> element = {grid.node(i, j, k),
                                            grid.node(i + 1, j, k),
                                            grid.node(i + 1, j + 1, k),
                                            grid.node(i, j + 1, k),
                                            grid.node(i, j, k + 1),
                                            grid.node(i + 1, j, k + 1),
                                            grid.node(i + 1, j + 1, k + 1),
                                            grid.node(i, j + 1, k + 1)};
        mesh.elements.push_back(element);
        const std::array<bool, 6> outside = {i == 0, i == nx - 1, j == 0, j == ny - 1, k == 0, k == nz - 1};
        for (std::size_t side = 0; side < 6; ++side) {
          if (!outside[side]) continue;
          std::array<int, 4> face{};
          for (std::size_t a = 0; a < 4; ++a) face[a] = element[static_cast<std::size_t>(localFaces[side][a])];
          mesh.faceSets[faceNames[side]].push_back(face);
          mesh.faceSets["skin"].push_back(face);
        }
      }
}

std::string setNames(const auto& sets) {
  std::string names;
  for (const auto& entry : sets) names += (names.empty() ? "\"" : ", \"") + entry.first + "\"";
  return names.empty() ? "the mesh has none" : "use one of " + names;
}

void requireNodes(std::span<const int> nodes, std::size_t count, const std::string& where) {
  for (const int node : nodes)
    if (node < 0 || static_cast<std::size_t>(node) >= count)
      throw InputError("node " + std::to_string(node) + " does not exist", where,
                       "use 0 to " + std::to_string(count - 1));
}

void requireVolume(const Mesh& mesh, std::size_t element) {
  const BrickCorners corners = cornersOf(mesh.elements[element], mesh.X);
  double worst = determinant(jacobian(corners, {0.0, 0.0, 0.0}));
  for (int p = 0; p < 8; ++p)
    for (const double distance : {1.0, gaussDistance}) {
      const Vec3 xi = {p & 1 ? distance : -distance, p & 2 ? distance : -distance, p & 4 ? distance : -distance};
      worst = std::min(worst, determinant(jacobian(corners, xi)));
    }
  if (!(worst > 0.0))
    throw InputError("the element is flat, inverted or too distorted (det dX/dxi = " + formatNumber(worst) + " m3)",
                     "element " + std::to_string(element), "order its nodes as in mesh.hpp and move them apart");
}

}  // namespace

Mesh boxMesh(std::array<int, 3> elements, Vec3 lower, Vec3 upper) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::string where = std::string("boxMesh, axis ") + "xyz"[axis];
    if (elements[static_cast<std::size_t>(axis)] < 1)
      throw InputError("there are no elements along it", where, "give 1 or more");
    if (!isFinite(lower) || !isFinite(upper) || !(upper[axis] > lower[axis]))
      throw InputError("the box has no length", where, "give upper > lower");
  }
  Mesh mesh;
  const GridIndex grid{elements};
  const auto [nx, ny, nz] = elements;
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) {
        const int node = static_cast<int>(mesh.X.size());
        const std::array<bool, 6> on = {i == 0, i == nx, j == 0, j == ny, k == 0, k == nz};
        for (std::size_t side = 0; side < 6; ++side)
          if (on[side]) mesh.nodeSets[faceNames[side]].push_back(node);
        if (std::find(on.begin(), on.end(), true) != on.end()) mesh.nodeSets["skin"].push_back(node);
        const auto at = [](double a, double b, int step, int steps) {
          return step == steps ? b : a + (b - a) * step / steps;
        };
        mesh.X.push_back({at(lower.x, upper.x, i, nx), at(lower.y, upper.y, j, ny), at(lower.z, upper.z, k, nz)});
      }
  addElementsAndFaces(mesh, grid);
  return mesh;
}

void validate(const Mesh& mesh) {
  if (mesh.X.empty() || mesh.elements.empty())
    throw InputError("the mesh has no nodes or no elements", "mesh", "give at least one brick");
  for (std::size_t node = 0; node < mesh.X.size(); ++node)
    if (!isFinite(mesh.X[node]))
      throw InputError("a position is not finite", "node " + std::to_string(node), "give three numbers");
  for (std::size_t element = 0; element < mesh.elements.size(); ++element) {
    requireNodes(mesh.elements[element], mesh.X.size(), "element " + std::to_string(element));
    requireVolume(mesh, element);
  }
  for (const auto& [name, nodes] : mesh.nodeSets) requireNodes(nodes, mesh.X.size(), "node set \"" + name + "\"");
  for (const auto& [name, faces] : mesh.faceSets)
    for (const auto& face : faces) requireNodes(face, mesh.X.size(), "face set \"" + name + "\"");
}

const std::vector<int>& nodeSet(const Mesh& mesh, const std::string& name) {
  const auto found = mesh.nodeSets.find(name);
  if (found == mesh.nodeSets.end())
    throw InputError("there is no such node set", "\"" + name + "\"", setNames(mesh.nodeSets));
  return found->second;
}

const std::vector<std::array<int, 4>>& faceSet(const Mesh& mesh, const std::string& name) {
  const auto found = mesh.faceSets.find(name);
  if (found == mesh.faceSets.end())
    throw InputError("there is no such face set", "\"" + name + "\"", setNames(mesh.faceSets));
  return found->second;
}

}  // namespace dovetail::fem
