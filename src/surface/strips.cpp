// Faces of plane meshes as strips.
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/surface/skin.hpp"

namespace dovetail::surface {

namespace {

/// Ends of the straight parts of a line.
std::vector<std::array<int, 2>> partsOf(const fem::Face& line) {
  if (line.shape == fem::FaceShape::line2) return {{line.node[0], line.node[1]}};
  return {{line.node[0], line.node[2]}, {line.node[2], line.node[1]}};
}

/// Values of nodes to those of the nodes below and above them.
cg::Projection twice(int nodes) {
  std::vector<cg::ProjectionRow> rows;
  for (int copy = 0; copy < 2; ++copy)
    for (int n = 0; n < nodes; ++n) rows.push_back({{n, 1.0}});
  return cg::fromRows(nodes, rows);
}

void requireLines(std::span<const Vec3> X, std::span<const fem::Face> lines) {
  for (std::size_t f = 0; f < lines.size(); ++f) {
    const std::string where = "face " + std::to_string(f);
    if (fem::dimensionOf(lines[f].shape) != 2)
      throw InputError(std::string("it is a ") + fem::name(lines[f].shape), where, "give lines of a plane mesh");
    for (const auto& [a, b] : partsOf(lines[f]))
      for (const int node : {a, b})
        if (node < 0 || static_cast<std::size_t>(node) >= X.size())
          throw InputError("node " + std::to_string(node) + " does not exist", where,
                           "use node numbers from 0 to " + std::to_string(X.size() - 1));
  }
}

/// Whether the lines go all the way round: every end is one of two.
bool isLoop(std::span<const fem::Face> lines) {
  std::map<int, int> ends;
  for (const fem::Face& line : lines)
    for (const int node : {line.node[0], line.node[1]}) ++ends[node];
  return std::ranges::all_of(ends, [](const auto& end) { return end.second == 2; });
}

}  // namespace

Skin makeStrips(std::span<const Vec3> X, std::span<const fem::Face> lines, double thickness, double sharpAngle) {
  requirePositive(thickness, "thickness of strips");
  requireLines(X, lines);
  const auto nodes = static_cast<int>(X.size());
  const Vec3 half{0.0, 0.0, 0.5 * thickness};
  std::vector<Vec3> both;
  for (const Vec3& x : X) both.push_back(x - half);
  for (const Vec3& x : X) both.push_back(x + half);
  std::vector<fem::Face> quads;
  for (const fem::Face& line : lines)
    for (const auto& [a, b] : partsOf(line)) {
      fem::Face& quad = quads.emplace_back(fem::Face{fem::FaceShape::quad4, {a, b, b + nodes, a + nodes}});
      std::fill(quad.node.begin() + 4, quad.node.end(), -1);
    }
  Skin skin = makeSkin(both, quads, QuadSplit::four, sharpAngle);
  skin.localMap = cg::product(skin.localMap, twice(nodes));
  skin.carrier = skin.localMap;
  skin.wall.oneSided = isLoop(lines);
  return skin;
}

}  // namespace dovetail::surface
