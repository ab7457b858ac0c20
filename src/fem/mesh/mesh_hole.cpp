#include <algorithm>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "face_key.hpp"
#include "faces.hpp"

namespace dovetail::fem {

namespace {

constexpr const char* setOfHole = "hole";

/// Numbers of what is left, −1 for what is gone.
struct Numbers {
  std::vector<int> element, node;
};

Vec3 centreOf(const SolidMesh& mesh, std::span<const int> nodes, int corners) {
  Vec3 sum;
  for (const int n : nodes.first(static_cast<std::size_t>(corners))) sum += mesh.X[static_cast<std::size_t>(n)];
  return (1.0 / corners) * sum;
}

/// Numbers that count up where an entry is not −1.
void count(std::vector<int>& numbers) {
  int next = 0;
  for (int& number : numbers)
    if (number >= 0) number = next++;
}

/// Fills the groups of what is left, with the old numbers of the nodes.
Numbers leaveOut(const SolidMesh& mesh, const std::function<bool(const Vec3&)>& place, SolidMesh& left) {
  Numbers numbers{{}, std::vector<int>(mesh.X.size(), -1)};
  for (const ElementGroup& group : mesh.groups) {
    const auto n = static_cast<std::size_t>(nodesOf(group.shape));
    ElementGroup kept{group.shape, {}};
    for (std::size_t e = 0; e < group.size(); ++e) {
      const std::span<const int> nodes = std::span(group.node).subspan(n * e, n);
      const bool stays = !place(centreOf(mesh, nodes, cornersOf(group.shape)));
      numbers.element.push_back(stays ? 0 : -1);
      if (!stays) continue;
      kept.node.insert(kept.node.end(), nodes.begin(), nodes.end());
      for (const int node : nodes) numbers.node[static_cast<std::size_t>(node)] = 0;
    }
    if (!kept.node.empty()) left.groups.push_back(std::move(kept));
  }
  count(numbers.element);
  count(numbers.node);
  return numbers;
}

std::vector<int> renumbered(const std::vector<int>& set, const std::vector<int>& number) {
  std::vector<int> left;
  for (const int one : set)
    if (const int now = number[static_cast<std::size_t>(one)]; now >= 0) left.push_back(now);
  return left;
}

/// Those whose nodes are all left.
std::vector<Face> renumbered(const std::vector<Face>& set, const std::vector<int>& number) {
  std::vector<Face> left;
  for (Face face : set) {
    const auto count = static_cast<std::size_t>(nodesOf(face.shape));
    for (std::size_t a = 0; a < count; ++a) face.node[a] = number[static_cast<std::size_t>(face.node[a])];
    if (std::ranges::all_of(nodesOf(face), [](int node) { return node >= 0; })) left.push_back(face);
  }
  return left;
}

std::vector<int> nodesOfAll(std::span<const Face> faces) {
  std::vector<int> nodes;
  for (const Face& face : faces) nodes.insert(nodes.end(), nodesOf(face).begin(), nodesOf(face).end());
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// Faces that lie on the boundary, among them those of the hole.
void addFaces(const SolidMesh& mesh, const std::vector<int>& number, SolidMesh& left) {
  const std::vector<Face> boundary = boundaryFaces(left);
  const FaceKeys outside = keysOf(boundary), before = keysOf(renumbered(boundaryFaces(mesh), number));
  for (const auto& [name, faces] : mesh.faceSets) {
    std::vector<Face>& set = left.faceSets[name] = renumbered(faces, number);
    std::erase_if(set, [&](const Face& face) { return !outside.contains(keyOf(face)); });
  }
  std::vector<Face>& bare = left.faceSets[setOfHole];
  std::ranges::copy_if(boundary, std::back_inserter(bare),
                       [&](const Face& face) { return !before.contains(keyOf(face)); });
  left.nodeSets[setOfHole] = nodesOfAll(bare);
  if (!left.faceSets.contains("skin")) return;
  left.faceSets["skin"] = boundary;
  left.nodeSets["skin"] = nodesOfAll(boundary);
}

void dropEmpty(auto& sets) {
  std::erase_if(sets, [](const auto& set) { return set.second.empty(); });
}

}  // namespace

SolidMesh withHole(const SolidMesh& mesh, const std::function<bool(const Vec3& X)>& place) {
  if (mesh.nodeSets.contains(setOfHole) || mesh.faceSets.contains(setOfHole))
    throw InputError("the mesh has a set \"hole\"", "withHole", "rename it");
  SolidMesh left;
  left.thickness = mesh.thickness;
  const Numbers numbers = leaveOut(mesh, place, left);
  const std::size_t gone = mesh.elementCount() - left.elementCount();
  if (gone == 0 || left.groups.empty())
    throw InputError(gone == 0 ? "no element has its centre there" : "all elements have their centre there", "hole",
                     gone == 0 ? "widen it, move it, or leave it out" : "make it smaller");
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    if (numbers.node[n] >= 0) left.X.push_back(mesh.X[n]);
  for (ElementGroup& group : left.groups) group.node = renumbered(group.node, numbers.node);
  for (const auto& [name, nodes] : mesh.nodeSets) left.nodeSets[name] = renumbered(nodes, numbers.node);
  for (const auto& [name, elements] : mesh.elementSets) left.elementSets[name] = renumbered(elements, numbers.element);
  addFaces(mesh, numbers.node, left);
  dropEmpty(left.nodeSets), dropEmpty(left.faceSets), dropEmpty(left.elementSets);
  return left;
}

}  // namespace dovetail::fem
