#include <algorithm>
#include <map>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "face_key.hpp"

namespace dovetail::fem {

namespace {

/// Finds the first kept node within a distance. Nodes are sorted along a direction in which structured meshes have few
/// nodes at the same place.
class Welder {
public:
  explicit Welder(double tolerance) : tolerance_(tolerance) {}

  int numberOf(const Vec3& X, std::vector<Vec3>& kept) {
    const double key = dot(X, direction);
    int found = -1;
    for (auto at = byKey_.lower_bound(key - tolerance_); at != byKey_.end() && at->first <= key + tolerance_; ++at)
      if (norm(kept[static_cast<std::size_t>(at->second)] - X) <= tolerance_ && (found < 0 || at->second < found))
        found = at->second;
    if (found >= 0) return found;
    byKey_.emplace(key, static_cast<int>(kept.size()));
    kept.push_back(X);
    return static_cast<int>(kept.size()) - 1;
  }

private:
  static constexpr Vec3 direction{0.7421, 0.5319, 0.4078};  // of length just below 1
  double tolerance_;
  std::multimap<double, int> byKey_;
};

void requireDistinct(std::vector<int> nodes, std::size_t part, std::size_t element) {
  std::sort(nodes.begin(), nodes.end());
  if (std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end())
    throw InputError("two of its nodes became one",
                     "joinMeshes, part " + std::to_string(part) + ", element " + std::to_string(element),
                     "give a tolerance well below the smallest distance of nodes");
}

void addGroups(SolidMesh& mesh, const SolidMesh& part, std::size_t partNumber, std::span<const int> number) {
  for (const ElementGroup& group : part.groups) {
    if (mesh.groups.empty() || mesh.groups.back().shape != group.shape) mesh.groups.push_back({group.shape, {}});
    const auto n = static_cast<std::size_t>(nodesOf(group.shape));
    for (std::size_t e = 0; e < group.size(); ++e) {
      std::vector<int> nodes;
      for (std::size_t a = 0; a < n; ++a) nodes.push_back(number[static_cast<std::size_t>(group.node[n * e + a])]);
      mesh.groups.back().node.insert(mesh.groups.back().node.end(), nodes.begin(), nodes.end());
      requireDistinct(nodes, partNumber, e);
    }
  }
}

void addSets(SolidMesh& mesh, const SolidMesh& part, std::span<const int> number, int firstElement) {
  for (const auto& [name, nodes] : part.nodeSets)
    for (const int n : nodes) mesh.nodeSets[name].push_back(number[static_cast<std::size_t>(n)]);
  for (const auto& [name, faces] : part.faceSets)
    for (Face face : faces) {
      for (int& n : face.node)
        if (n >= 0) n = number[static_cast<std::size_t>(n)];
      mesh.faceSets[name].push_back(face);
    }
  for (const auto& [name, elements] : part.elementSets)
    for (const int e : elements) mesh.elementSets[name].push_back(firstElement + e);
}

}  // namespace

SolidMesh joinMeshes(std::span<const SolidMesh> parts, double tolerance) {
  requirePositive(tolerance, "tolerance of joinMeshes");
  SolidMesh mesh;
  if (!parts.empty()) mesh.thickness = parts[0].thickness;
  Welder welder(tolerance);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (parts[p].thickness != mesh.thickness)
      throw InputError("its thickness is " + formatNumber(parts[p].thickness) + " m, that of part 0 " +
                           formatNumber(mesh.thickness) + " m",
                       "joinMeshes, part " + std::to_string(p), "give parts of one thickness");
    std::vector<int> number;
    for (const Vec3& X : parts[p].X) number.push_back(welder.numberOf(X, mesh.X));
    const int firstElement = static_cast<int>(mesh.elementCount());
    addGroups(mesh, parts[p], p, number);
    addSets(mesh, parts[p], number, firstElement);
  }
  for (auto& [name, nodes] : mesh.nodeSets) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  const FaceKeys outside = keysOf(boundaryFaces(mesh));
  for (auto& [name, faces] : mesh.faceSets)
    std::erase_if(faces, [&](const Face& face) { return !outside.contains(keyOf(face)); });
  return mesh;
}

}  // namespace dovetail::fem
