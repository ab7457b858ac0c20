#include "dovetail/fem/cell_topology.hpp"

#include <vector>

namespace dovetail::fem {

namespace {

constexpr std::array<std::array<int, 2>, 12> brickEdges = {
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
constexpr std::array<std::array<int, 2>, 6> tetEdges = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
constexpr std::array<std::array<int, 4>, 6> brickFaces = {
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};
constexpr std::array<std::array<int, 3>, 4> tetFaces = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
constexpr int firstMidFace = 20;

bool isBrick(CellShape shape) { return shape != CellShape::tet4 && shape != CellShape::tet10; }
bool isSecondOrder(CellShape shape) { return shape != CellShape::hex8 && shape != CellShape::tet4; }

/// The node between two corners.
int midNode(CellShape shape, int a, int b) {
  const auto edges = edgesOf(shape);
  for (std::size_t e = 0; e < edges.size(); ++e)
    if ((edges[e][0] == a && edges[e][1] == b) || (edges[e][0] == b && edges[e][1] == a))
      return cornersOf(shape) + static_cast<int>(e);
  return -1;
}

FaceShape faceShape(CellShape shape) {
  constexpr std::array<FaceShape, 5> shapes = {FaceShape::quad4, FaceShape::quad8, FaceShape::quad9, FaceShape::tri3,
                                               FaceShape::tri6};
  return shapes[static_cast<std::size_t>(shape)];
}

Face makeFace(CellShape shape, std::span<const int> corners, std::size_t side) {
  Face face{faceShape(shape), {}};
  face.node.fill(-1);
  const std::size_t n = corners.size();
  for (std::size_t k = 0; k < n; ++k) {
    face.node[k] = corners[k];
    if (isSecondOrder(shape)) face.node[n + k] = midNode(shape, corners[k], corners[(k + 1) % n]);
  }
  if (face.shape == FaceShape::quad9) face.node[8] = firstMidFace + static_cast<int>(side);
  return face;
}

std::vector<Face> makeFaces(CellShape shape) {
  std::vector<Face> faces;
  for (std::size_t side = 0; side < (isBrick(shape) ? 6u : 4u); ++side)
    faces.push_back(isBrick(shape) ? makeFace(shape, brickFaces[side], side) : makeFace(shape, tetFaces[side], side));
  return faces;
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
