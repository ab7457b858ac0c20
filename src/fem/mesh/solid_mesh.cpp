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

std::array<int, 4> brickFace(const Face& face, const std::string& set) {
  if (face.shape != FaceShape::quad4)
    throw InputError("it has faces that are not those of hex8 elements", "face set \"" + set + "\"",
                     "give faces of four nodes");
  return {face.node[0], face.node[1], face.node[2], face.node[3]};
}

}  // namespace

const char* name(CellShape shape) {
  constexpr std::array<const char*, 5> names = {"hex8", "hex20", "hex27", "tet4", "tet10"};
  return names[static_cast<std::size_t>(shape)];
}

std::size_t SolidMesh::elementCount() const {
  std::size_t count = 0;
  for (const CellGroup& group : groups) count += group.size();
  return count;
}

SolidMesh solidMesh(const Mesh& bricks) {
  SolidMesh mesh;
  mesh.X = bricks.X;
  mesh.nodeSets = bricks.nodeSets;
  CellGroup& group = mesh.groups.emplace_back(CellGroup{CellShape::hex8, {}});
  for (const auto& element : bricks.elements) group.node.insert(group.node.end(), element.begin(), element.end());
  for (const auto& [set, faces] : bricks.faceSets) {
    std::vector<Face>& target = mesh.faceSets[set];
    for (const auto& f : faces) target.push_back({FaceShape::quad4, {f[0], f[1], f[2], f[3], -1, -1, -1, -1, -1}});
  }
  return mesh;
}

Mesh brickMesh(const SolidMesh& mesh) {
  Mesh bricks;
  bricks.X = mesh.X;
  bricks.nodeSets = mesh.nodeSets;
  for (const CellGroup& group : mesh.groups) {
    if (group.shape != CellShape::hex8)
      throw InputError(std::string("the mesh has ") + name(group.shape) + " elements", "brickMesh",
                       "give a mesh of hex8 elements alone");
    for (std::size_t e = 0; e < group.size(); ++e) {
      std::array<int, 8>& element = bricks.elements.emplace_back();
      for (std::size_t a = 0; a < 8; ++a) element[a] = group.node[8 * e + a];
    }
  }
  for (const auto& [set, faces] : mesh.faceSets) {
    auto& target = bricks.faceSets[set];
    for (const Face& face : faces) target.push_back(brickFace(face, set));
  }
  return bricks;
}

const std::vector<int>& nodeSet(const SolidMesh& mesh, const std::string& wanted) {
  return findSet(mesh.nodeSets, wanted, "node");
}
const std::vector<Face>& faceSet(const SolidMesh& mesh, const std::string& wanted) {
  return findSet(mesh.faceSets, wanted, "face");
}
const std::vector<int>& elementSet(const SolidMesh& mesh, const std::string& wanted) {
  return findSet(mesh.elementSets, wanted, "element");
}

}  // namespace dovetail::fem
