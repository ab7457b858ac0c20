#include "dovetail/fem/mesh/solid_mesh.hpp"

#include "dovetail/core/error.hpp"

namespace dovetail::fem {

namespace {

const auto& findSet(const auto& sets, const std::string& wanted, const char* kind) {
  const auto found = sets.find(wanted);
  if (found != sets.end()) return found->second;
  std::string names;
  for (const auto& entry : sets) names += (names.empty() ? "use one of \"" : ", \"") + entry.first + "\"";
  throw InputError(std::string("there is no such ") + kind + " set", "\"" + wanted + "\"",
                   names.empty() ? "the mesh has none" : names);
}

}  // namespace

const char* name(ElementShape shape) {
  constexpr std::array<const char*, 7> names = {"hex8", "hex20", "hex27", "tet4", "tet10", "quad4", "quad8"};
  return names[static_cast<std::size_t>(shape)];
}

std::size_t SolidMesh::elementCount() const {
  std::size_t count = 0;
  for (const ElementGroup& group : groups) count += group.size();
  return count;
}

int dimensionOf(const SolidMesh& mesh) {
  if (!mesh.groups.empty()) return dimensionOf(mesh.groups[0].shape);
  for (const auto& [name, faces] : mesh.faceSets)
    if (!faces.empty()) return dimensionOf(faces[0].shape);
  return 3;
}

const std::vector<int>& nodeSet(const SolidMesh& mesh, const std::string& wanted) {
  return findSet(mesh.nodeSets, wanted, "node");
}
const std::vector<Face>& faceSet(const SolidMesh& mesh, const std::string& wanted) {
  if (mesh.nodeSets.contains(wanted) && !mesh.faceSets.contains(wanted))
    throw InputError("this set has nodes, but no face of the boundary has all of its nodes in it", "\"" + wanted + "\"",
                     "take a set on the boundary that is as large as a face");
  return findSet(mesh.faceSets, wanted, "face");
}
const std::vector<int>& elementSet(const SolidMesh& mesh, const std::string& wanted) {
  return findSet(mesh.elementSets, wanted, "element");
}

}  // namespace dovetail::fem
