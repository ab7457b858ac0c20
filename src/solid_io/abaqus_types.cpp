#include "abaqus_types.hpp"

#include <algorithm>
#include <string_view>

#include "dovetail/fem/mesh/cell_topology.hpp"

namespace dovetail::solid_io {

namespace {

using fem::ElementShape;
constexpr std::array<const char*, 7> names = {"C3D8", "C3D20", "C3D27", "C3D4", "C3D10", "CPE4", "CPE8"};
// S1 … S6 are z−, z+, y−, x+, y+, x−; the faces of tetrahedra have our order.
constexpr std::array<int, 6> brickSides = {4, 5, 2, 1, 3, 0};
// S1 … S4 are 01, 12, 23, 30.
constexpr std::array<int, 4> planeSides = {2, 1, 3, 0};

/// Elements of surfaces, and what those are that are not of plane strain.
constexpr std::array<std::pair<std::string_view, const char*>, 6> families = {{{"SFM3D", "a surface element"},
                                                                               {"M3D", "a membrane"},
                                                                               {"R3D", "a rigid surface"},
                                                                               {"CPS", "of plane stress"},
                                                                               {"CPE", ""},
                                                                               {"S", "a shell"}}};

bool isOneOf(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::optional<AbaqusType> volumeType(const std::string& type) {
  const std::size_t end = type.find_first_not_of("0123456789", 3);
  const std::string base = type.substr(0, end), suffix = end == std::string::npos ? "" : type.substr(end);
  if (suffix.find_first_not_of("RIHMS") != std::string::npos) return {};
  for (std::size_t s = 0; s < names.size(); ++s) {
    const auto shape = static_cast<ElementShape>(s);
    if (base == names[s]) return AbaqusType{3, shape, fem::nodesOf(shape), {}};
  }
  return {};
}

}  // namespace

std::optional<AbaqusType> abaqusType(const std::string& type) {
  if (type.substr(0, 3) == "C3D") return volumeType(type);
  if (type == "STRI3") return AbaqusType{2, {}, 3, surfaceOf(3)};
  if (type == "STRI65") return AbaqusType{2, {}, 6, surfaceOf(6)};
  if (isOneOf(type, {"T3D2", "B31"})) return AbaqusType{1, {}, 2, {}};
  if (isOneOf(type, {"T3D3", "B32"})) return AbaqusType{1, {}, 3, {}};
  for (const auto& [family, meaning] : families) {
    if (type.substr(0, family.size()) != family || type.size() == family.size()) continue;
    const int nodes = type[family.size()] - '0';
    const bool known = nodes == 3 || nodes == 4 || nodes == 6 || nodes == 8 || nodes == 9;
    if (!known || !isOneOf(type.substr(family.size() + 1), {"", "R", "R5", "5", "RS", "S", "I", "H", "RH", "M"}))
      continue;
    SurfaceKind surface = surfaceOf(nodes);
    if (*meaning != '\0') surface.plane.reset(), surface.otherwise = meaning;
    return AbaqusType{2, {}, nodes, surface};
  }
  return {};
}

const char* abaqusName(ElementShape shape) { return names[static_cast<std::size_t>(shape)]; }

int abaqusPlace(ElementShape shape, int k) {
  if (shape != ElementShape::hex27 || k < 20) return k;
  if (k == 26) return 20;
  const auto face = std::find(brickSides.begin(), brickSides.end(), k - 20) - brickSides.begin();
  return 21 + static_cast<int>(face);
}

int sideOfFace(ElementShape shape, int face) {
  const bool plane = fem::dimensionOf(shape) == 2;
  const int count = fem::cornersOf(shape) == 8 ? 6 : 4;
  if (face < 1 || face > count) return -1;
  if (plane) return planeSides[static_cast<std::size_t>(face - 1)];
  return count == 6 ? brickSides[static_cast<std::size_t>(face - 1)] : face - 1;
}

}  // namespace dovetail::solid_io
