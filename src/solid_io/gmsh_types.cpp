#include "gmsh_types.hpp"

#include <algorithm>

namespace dovetail::solid_io {

namespace {

using fem::ElementShape;
constexpr auto none = ElementShape::hex8;
constexpr std::array<GmshType, 13> types = {{{1, 2, 1, none},
                                             {2, 3, 2, none},
                                             {3, 4, 2, none},
                                             {4, 4, 3, ElementShape::tet4},
                                             {5, 8, 3, ElementShape::hex8},
                                             {8, 3, 1, none},
                                             {9, 6, 2, none},
                                             {10, 9, 2, none},
                                             {11, 10, 3, ElementShape::tet10},
                                             {12, 27, 3, ElementShape::hex27},
                                             {15, 1, 0, none},
                                             {16, 8, 2, none},
                                             {17, 20, 3, ElementShape::hex20}}};
// Gmsh counts edges by their lower corner, faces of the brick z−, y−, x−, x+, y+, z+.
// Those of quadrilaterals are in our order, as the first eight nodes of bricks.
constexpr std::array<int, 27> brickOrder = {0,  1,  2,  3,  4,  5,  6,  7,  8,  11, 13, 9,  16, 18,
                                            19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26};
constexpr std::array<int, 10> tetOrder = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};

}  // namespace

const GmshType* gmshType(std::int64_t code) {
  const auto found = std::find_if(types.begin(), types.end(), [&](const GmshType& t) { return t.code == code; });
  return found == types.end() ? nullptr : &*found;
}

std::string gmshTypeName(std::int64_t code) {
  const std::string number = "type " + std::to_string(code);
  if (code == 6 || code == 13 || code == 18) return number + " (a prism)";
  if (code == 7 || code == 14 || code == 19) return number + " (a pyramid)";
  if (code >= 20 && code <= 31) return number + " (of third order or higher)";
  return number;
}

int gmshCode(fem::ElementShape shape) {
  constexpr std::array<int, 7> codes = {5, 17, 12, 4, 11, 3, 16};
  return codes[static_cast<std::size_t>(shape)];
}

int gmshCode(fem::FaceShape shape) {
  constexpr std::array<int, 7> codes = {3, 16, 10, 2, 9, 1, 8};
  return codes[static_cast<std::size_t>(shape)];
}

std::span<const int> gmshOrder(fem::ElementShape shape) {
  const auto count = static_cast<std::size_t>(fem::nodesOf(shape));
  return shape == ElementShape::tet4 || shape == ElementShape::tet10 ? std::span<const int>(tetOrder).first(count)
                                                                     : std::span<const int>(brickOrder).first(count);
}

}  // namespace dovetail::solid_io
