#include "dovetail/fem/mesh/cell_topology.hpp"

#include <vector>

#include "shapes.hpp"

namespace dovetail::fem {

namespace {

constexpr std::array<std::array<int, 2>, 12> brickEdges = {
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
constexpr std::array<std::array<int, 2>, 6> tetEdges = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
bool isBrick(CellShape shape) { return shape != CellShape::tet4 && shape != CellShape::tet10; }

std::vector<Face> makeFaces(CellShape shape) {
  const detail::CellFaces& faces = detail::facesOf(shape);
  std::vector<Face> result;
  for (const auto& nodes : faces.node) result.push_back({faces.shape, nodes});
  return result;
}

}  // namespace

int cornersOf(CellShape shape) { return isBrick(shape) ? 8 : 4; }
int cornersOf(FaceShape shape) { return shape == FaceShape::tri3 || shape == FaceShape::tri6 ? 3 : 4; }

std::span<const std::array<int, 2>> edgesOf(CellShape shape) {
  return isBrick(shape) ? std::span<const std::array<int, 2>>(brickEdges)
                        : std::span<const std::array<int, 2>>(tetEdges);
}

std::span<const Face> localFacesOf(CellShape shape) {
  static const std::array<std::vector<Face>, 5> faces = {makeFaces(CellShape::hex8), makeFaces(CellShape::hex20),
                                                         makeFaces(CellShape::hex27), makeFaces(CellShape::tet4),
                                                         makeFaces(CellShape::tet10)};
  return faces[static_cast<std::size_t>(shape)];
}

Face faceOf(const CellGroup& group, std::size_t element, std::size_t side) {
  Face face = localFacesOf(group.shape)[side];
  const std::size_t first = element * static_cast<std::size_t>(nodesOf(group.shape));
  for (int& node : face.node)
    if (node >= 0) node = group.node[first + static_cast<std::size_t>(node)];
  return face;
}

const char* name(FaceShape shape) {
  constexpr std::array<const char*, 5> names = {"quad4", "quad8", "quad9", "tri3", "tri6"};
  return names[static_cast<std::size_t>(shape)];
}

}  // namespace dovetail::fem
