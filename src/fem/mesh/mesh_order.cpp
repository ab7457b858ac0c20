#include <algorithm>
#include <map>
#include <set>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"

namespace dovetail::fem {

namespace {

/// Sorted corners of an edge (two), a face (four) or a brick (eight): what a new node lies in the middle of.
using Corners = std::vector<int>;

ElementShape raised(ElementShape shape, bool fullBricks) {
  if (shape == ElementShape::tet4) return ElementShape::tet10;
  if (shape == ElementShape::quad4) return ElementShape::quad8;
  if (shape == ElementShape::hex8) return fullBricks ? ElementShape::hex27 : ElementShape::hex20;
  throw InputError(std::string("the mesh has ") + name(shape) + " elements already", "secondOrder",
                   "give hex8, tet4 or quad4 elements");
}

/// Makes each new node once and keeps what it lies between.
class MidNodes {
public:
  explicit MidNodes(SolidMesh& mesh) : mesh_(mesh) {}

  int between(Corners corners) {
    std::sort(corners.begin(), corners.end());
    const auto [entry, isNew] = number_.emplace(corners, static_cast<int>(mesh_.X.size()));
    if (isNew) {
      Vec3 sum;
      for (const int node : corners) sum += mesh_.X[static_cast<std::size_t>(node)];
      mesh_.X.push_back(sum / static_cast<double>(corners.size()));
    }
    return entry->second;
  }
  const std::map<Corners, int>& all() const { return number_; }

private:
  SolidMesh& mesh_;
  std::map<Corners, int> number_;
};

Corners cornersOfFace(const Face& face) { return {face.node.begin(), face.node.begin() + cornersOf(face.shape)}; }

ElementGroup raise(const ElementGroup& group, bool fullBricks, MidNodes& mid) {
  ElementGroup result{raised(group.shape, fullBricks), {}};
  const auto n = static_cast<std::size_t>(nodesOf(group.shape));
  for (std::size_t e = 0; e < group.size(); ++e) {
    const Corners nodes(group.node.begin() + static_cast<std::ptrdiff_t>(n * e),
                        group.node.begin() + static_cast<std::ptrdiff_t>(n * (e + 1)));
    result.node.insert(result.node.end(), nodes.begin(), nodes.end());
    for (const auto& [a, b] : edgesOf(group.shape))
      result.node.push_back(mid.between({nodes[static_cast<std::size_t>(a)], nodes[static_cast<std::size_t>(b)]}));
    if (result.shape != ElementShape::hex27) continue;
    for (std::size_t side = 0; side < 6; ++side)
      result.node.push_back(mid.between(cornersOfFace(faceOf(group, e, side))));
    result.node.push_back(mid.between(nodes));
  }
  return result;
}

Face raise(const Face& face, bool fullBricks, MidNodes& mid) {
  const Corners corners = cornersOfFace(face);
  const std::size_t n = corners.size();
  if (n == 2) {
    Face line{FaceShape::line3, face.node};
    line.node[2] = mid.between(corners);
    return line;
  }
  Face result{n == 3 ? FaceShape::tri6 : fullBricks ? FaceShape::quad9 : FaceShape::quad8, face.node};
  for (std::size_t k = 0; k < n; ++k) result.node[n + k] = mid.between({corners[k], corners[(k + 1) % n]});
  if (result.shape == FaceShape::quad9) result.node[8] = mid.between(corners);
  return result;
}

/// What lies on the skin: sorted corners of its edges and faces, and its nodes.
struct SkinParts {
  std::set<Corners> parts;
  std::set<int> nodes;
  explicit SkinParts(const SolidMesh& mesh) {
    for (const Face& face : boundaryFaces(mesh)) {
      Corners corners = cornersOfFace(face);
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const int a = corners[k], b = corners[(k + 1) % corners.size()];
        parts.insert({std::min(a, b), std::max(a, b)});
      }
      nodes.insert(corners.begin(), corners.end());
      std::sort(corners.begin(), corners.end());
      parts.insert(corners);
    }
  }
};

}  // namespace

SolidMesh secondOrder(const SolidMesh& mesh, bool fullBricks) {
  validate(mesh);
  SolidMesh result{mesh.X, {}, mesh.nodeSets, {}, mesh.elementSets, mesh.thickness};
  MidNodes mid(result);
  for (const ElementGroup& group : mesh.groups) result.groups.push_back(raise(group, fullBricks, mid));
  for (const auto& [name, faces] : mesh.faceSets)
    for (const Face& face : faces) result.faceSets[name].push_back(raise(face, fullBricks, mid));
  const SkinParts skin(mesh);
  for (auto& [name, nodes] : result.nodeSets) {
    const std::set<int> members(nodes.begin(), nodes.end());
    for (const auto& entry : mid.all()) {
      const auto& corners = entry.first;
      const auto in = [&](const std::set<int>& set) {
        return std::all_of(corners.begin(), corners.end(), [&](int node) { return set.contains(node); });
      };
      if (in(members) && (skin.parts.contains(corners) || !in(skin.nodes))) nodes.push_back(entry.second);
    }
    std::sort(nodes.begin(), nodes.end());
  }
  validate(result);
  return result;
}

}  // namespace dovetail::fem
