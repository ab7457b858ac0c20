#include "face_cut.hpp"

#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"

namespace dovetail::surface {

namespace {

using Triangle = std::array<int, 3>;

constexpr std::array<Triangle, 1> one = {{{0, 1, 2}}};
constexpr std::array<Triangle, 2> two = {{{0, 1, 2}, {0, 2, 3}}};
constexpr std::array<Triangle, 4> four = {{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
constexpr std::array<Triangle, 4> halved = {{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
constexpr std::array<Triangle, 8> eight = {
    {{0, 4, 8}, {4, 1, 8}, {1, 5, 8}, {5, 2, 8}, {2, 6, 8}, {6, 3, 8}, {3, 7, 8}, {7, 0, 8}}};

}  // namespace

std::span<const Triangle> trianglesOf(fem::FaceShape shape, QuadSplit split) {
  const bool triangle = fem::cornersOf(shape) == 3;
  if (fem::nodesOf(shape) == fem::cornersOf(shape)) {
    if (triangle) return one;
    return split == QuadSplit::two ? std::span<const Triangle>(two) : four;
  }
  return triangle ? std::span<const Triangle>(halved) : eight;
}

std::vector<std::array<int, 4>> quadsOf(std::span<const fem::Face> faces, const char* who) {
  std::vector<std::array<int, 4>> quads;
  for (const fem::Face& face : faces) {
    if (face.shape != fem::FaceShape::quad4)
      throw InputError(std::string("it is a ") + fem::name(face.shape), "face " + std::to_string(quads.size()),
                       std::string(who) + " takes faces of four nodes, those of hex8 elements");
    quads.push_back({face.node[0], face.node[1], face.node[2], face.node[3]});
  }
  return quads;
}

}  // namespace dovetail::surface
