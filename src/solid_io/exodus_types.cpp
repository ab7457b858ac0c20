#include "exodus_types.hpp"

#include <algorithm>
#include <array>

#include "dovetail/fem/mesh/cell_topology.hpp"

namespace dovetail::solid_io {

namespace {

using fem::ElementShape;

/// Exodus has the edges between the two faces before those of the upper one.
const std::vector<int> hex20{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15};
/// Then the centre, and the faces in the order z, x, y; ours are x, y, z and the centre.
const std::vector<int> hex27{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 16, 17,
                             18, 19, 12, 13, 14, 15, 23, 24, 25, 26, 21, 22, 20};

struct Kind {
  std::string_view begins;
  std::size_t nodes;
  int dimension;
  std::optional<ElementShape> shape;
  const std::vector<int>* order = nullptr;
};
const std::array<Kind, 19> kinds{{{"hex", 8, 3, ElementShape::hex8},
                                  {"hex", 20, 3, ElementShape::hex20, &hex20},
                                  {"hex", 27, 3, ElementShape::hex27, &hex27},
                                  {"tet", 4, 3, ElementShape::tet4},
                                  {"tet", 10, 3, ElementShape::tet10},
                                  {"shell", 3, 2, {}},
                                  {"shell", 4, 2, {}},
                                  {"shell", 8, 2, {}},
                                  {"shell", 9, 2, {}},
                                  {"quad", 4, 2, {}},
                                  {"quad", 8, 2, {}},
                                  {"quad", 9, 2, {}},
                                  {"tri", 3, 2, {}},
                                  {"tri", 6, 2, {}},
                                  {"bar", 2, 1, {}},
                                  {"beam", 2, 1, {}},
                                  {"truss", 2, 1, {}},
                                  {"edge", 2, 1, {}},
                                  {"sphere", 1, 0, {}}}};

constexpr std::array<std::array<int, 4>, 6> hexSides{
    {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {0, 3, 2, 1}, {4, 5, 6, 7}}};
constexpr std::array<std::array<int, 3>, 4> tetSides{{{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 2, 1}}};
constexpr std::array<std::array<int, 2>, 4> quadSides{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};

/// The face of the shape with these corners.
template <std::size_t sides, std::size_t corners>
int faceWith(const std::array<std::array<int, corners>, sides>& all, ElementShape shape, std::int64_t side) {
  if (side < 1 || side > static_cast<std::int64_t>(sides)) return -1;
  const std::array<int, corners>& wanted = all[static_cast<std::size_t>(side - 1)];
  const std::span<const fem::Face> faces = fem::localFacesOf(shape);
  for (std::size_t k = 0; k < faces.size(); ++k)
    if (std::is_permutation(wanted.begin(), wanted.end(), faces[k].node.begin())) return static_cast<int>(k);
  return -1;
}

}  // namespace

std::optional<ExodusType> exodusType(const std::string& name, std::size_t nodes) {
  const std::string word = lower(name);
  for (const Kind& kind : kinds)
    if (word.starts_with(kind.begins) && kind.nodes == nodes)
      return ExodusType{kind.dimension, kind.shape, kind.order ? *kind.order : std::vector<int>{}};
  return {};
}

int sideOfExodus(ElementShape shape, std::int64_t side) {
  if (shape == ElementShape::tet4 || shape == ElementShape::tet10) return faceWith(tetSides, shape, side);
  if (shape == ElementShape::quad4 || shape == ElementShape::quad8) return faceWith(quadSides, shape, side);
  return faceWith(hexSides, shape, side);
}

}  // namespace dovetail::solid_io
