#include <algorithm>
#include <limits>
#include <numeric>

#include "cell_jacobian.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"

namespace dovetail::fem {

namespace {

struct Side {
  std::array<int, 4> key;  // sorted corners
  int element;
  Face face;
};

std::vector<Side> sortedSides(const SolidMesh& mesh) {
  std::vector<Side> sides;
  int number = 0;
  for (const ElementGroup& group : mesh.groups)
    for (std::size_t e = 0; e < group.size(); ++e, ++number)
      for (std::size_t k = 0; k < localFacesOf(group.shape).size(); ++k) {
        Side& side = sides.emplace_back(Side{{}, number, faceOf(group, e, k)});
        side.key.fill(std::numeric_limits<int>::max());
        std::copy_n(side.face.node.begin(), cornersOf(side.face.shape), side.key.begin());
        std::sort(side.key.begin(), side.key.end());
      }
  std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.key < b.key; });
  return sides;
}

/// Disjoint sets; the root of a set is its least member.
class Pieces {
public:
  explicit Pieces(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int e) {
    while (parent_[static_cast<std::size_t>(e)] != e) {
      int& up = parent_[static_cast<std::size_t>(e)];
      up = parent_[static_cast<std::size_t>(up)];
      e = up;
    }
    return e;
  }
  void join(int a, int b) {
    const int p = root(a), q = root(b);
    parent_[static_cast<std::size_t>(std::max(p, q))] = std::min(p, q);
  }

private:
  std::vector<int> parent_;
};

std::vector<std::pair<int, int>> duplicateElements(const SolidMesh& mesh) {
  std::vector<std::pair<std::vector<int>, int>> elements;
  int number = 0;
  for (const ElementGroup& group : mesh.groups) {
    const auto n = static_cast<std::ptrdiff_t>(nodesOf(group.shape));
    for (std::size_t e = 0; e < group.size(); ++e, ++number) {
      const auto begin = group.node.begin() + static_cast<std::ptrdiff_t>(e) * n;
      auto& entry = elements.emplace_back(std::vector<int>(begin, begin + n), number);
      std::sort(entry.first.begin(), entry.first.end());
    }
  }
  std::sort(elements.begin(), elements.end());
  std::vector<std::pair<int, int>> found;
  for (std::size_t i = 0, j = 0; i < elements.size(); i = j)
    for (j = i + 1; j < elements.size() && elements[j].first == elements[i].first; ++j)
      found.emplace_back(elements[i].second, elements[j].second);
  std::sort(found.begin(), found.end());
  return found;
}

bool sameNodes(const Face& a, const Face& b) {
  std::array<int, 9> p = a.node, q = b.node;
  std::sort(p.begin(), p.end());
  std::sort(q.begin(), q.end());
  return a.shape == b.shape && p == q;
}

std::string cornersText(const Face& face) {
  std::string text;
  for (int k = 0; k < cornersOf(face.shape); ++k)
    text += (k == 0 ? "" : ", ") + std::to_string(face.node[static_cast<std::size_t>(k)]);
  return "face of nodes " + text;
}

std::string countText(std::size_t count, const char* rest) {
  return std::to_string(count) + (count == 1 ? " face " : " faces ") + rest;
}

}  // namespace

MeshTopology analyseTopology(const SolidMesh& mesh) {
  MeshTopology topology;
  const std::vector<Side> sides = sortedSides(mesh);
  Pieces pieces(mesh.elementCount());
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    for (j = i + 1; j < sides.size() && sides[j].key == sides[i].key; ++j)
      pieces.join(sides[i].element, sides[j].element);
    if (j > i + 2) topology.crowdedFaces.push_back(sides[i].face);
    if (j == i + 2 && !sameNodes(sides[i].face, sides[i + 1].face)) topology.mismatchedFaces.push_back(sides[i].face);
  }
  for (int e = 0; e < static_cast<int>(mesh.elementCount()); ++e) {
    const int root = pieces.root(e);
    if (root == e) topology.firstElement.push_back(e);
    const auto at = std::lower_bound(topology.firstElement.begin(), topology.firstElement.end(), root);
    topology.piece.push_back(static_cast<int>(at - topology.firstElement.begin()));
  }
  topology.duplicates = duplicateElements(mesh);
  std::vector<char> used(mesh.X.size(), 0);
  for (const ElementGroup& group : mesh.groups)
    for (const int node : group.node) used[static_cast<std::size_t>(node)] = 1;
  for (std::size_t n = 0; n < used.size(); ++n)
    if (!used[n]) topology.unusedNodes.push_back(static_cast<int>(n));
  return topology;
}

void requireConnected(const SolidMesh& mesh) {
  const MeshTopology topology = analyseTopology(mesh);
  if (topology.firstElement.size() > 1)
    throw InputError(
        "the mesh falls into " + std::to_string(topology.firstElement.size()) + " pieces that share no face",
        detail::listed("element", topology.firstElement),
        "join nodes that lie on each other, or give the pieces supports of their own");
}

void requireConforming(const SolidMesh& mesh) {
  const MeshTopology topology = analyseTopology(mesh);
  std::vector<int> later;
  for (const auto& pair : topology.duplicates) later.push_back(pair.second);
  std::sort(later.begin(), later.end());
  later.erase(std::unique(later.begin(), later.end()), later.end());
  if (!later.empty())
    throw InputError("elements have the nodes of earlier ones", detail::listed("element", later), "give each once");
  if (!topology.crowdedFaces.empty())
    throw InputError(countText(topology.crowdedFaces.size(), "with three or more elements"),
                     cornersText(topology.crowdedFaces[0]), "let two elements meet at a face");
  if (!topology.mismatchedFaces.empty())
    throw InputError(countText(topology.mismatchedFaces.size(), "whose two elements have other mid nodes"),
                     cornersText(topology.mismatchedFaces[0]), "let neighbours be of one order and share mid nodes");
  if (!topology.unusedNodes.empty())
    throw InputError("no element uses them", detail::listed("node", topology.unusedNodes), "leave them out");
}

}  // namespace dovetail::fem
