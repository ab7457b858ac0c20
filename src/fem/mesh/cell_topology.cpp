#include "dovetail/fem/mesh/cell_topology.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "shapes.hpp"

namespace dovetail::fem {

namespace {

constexpr std::array<std::array<int, 2>, 12> brickEdges = {
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
constexpr std::array<std::array<int, 2>, 6> tetEdges = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
constexpr std::array<std::array<int, 2>, 4> quadEdges = {{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};

std::vector<Face> makeFaces(ElementShape shape) {
  const detail::CellFaces& faces = detail::facesOf(shape);
  std::vector<Face> result;
  for (const auto& nodes : faces.node) result.push_back({faces.shape, nodes});
  return result;
}

}  // namespace

int cornersOf(ElementShape shape) { return dimensionOf(shape) == 2 || detail::isTet(shape) ? 4 : 8; }
int cornersOf(FaceShape shape) {
  if (dimensionOf(shape) == 2) return 2;
  return shape == FaceShape::tri3 || shape == FaceShape::tri6 ? 3 : 4;
}

std::span<const std::array<int, 2>> edgesOf(ElementShape shape) {
  if (dimensionOf(shape) == 2) return quadEdges;
  if (detail::isTet(shape)) return tetEdges;
  return brickEdges;
}

std::span<const Face> localFacesOf(ElementShape shape) {
  static const auto faces = detail::perShape(makeFaces);
  return faces[static_cast<std::size_t>(shape)];
}

Face faceOf(const ElementGroup& group, std::size_t element, std::size_t side) {
  Face face = localFacesOf(group.shape)[side];
  const std::size_t first = element * static_cast<std::size_t>(nodesOf(group.shape));
  for (int& node : face.node)
    if (node >= 0) node = group.node[first + static_cast<std::size_t>(node)];
  return face;
}

int nodeOffPlane(std::span<const Vec3> X) {
  if (X.empty()) return -1;
  double longest = 0.0;
  for (int c = 0; c < 2; ++c) {
    const auto [lower, upper] = std::ranges::minmax(X, {}, [c](const Vec3& node) { return node[c]; });
    longest = std::max(longest, upper[c] - lower[c]);
  }
  const auto off =
      std::ranges::find_if(X, [&](const Vec3& node) { return !(std::abs(node.z - X[0].z) <= 1e-9 * longest); });
  return off == X.end() ? -1 : static_cast<int>(off - X.begin());
}

const char* name(FaceShape shape) {
  constexpr std::array<const char*, 7> names = {"quad4", "quad8", "quad9", "tri3", "tri6", "line2", "line3"};
  return names[static_cast<std::size_t>(shape)];
}

}  // namespace dovetail::fem
