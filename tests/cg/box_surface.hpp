// The surface of a brick of hexahedra, cut into triangles, with one patch per side.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "dovetail/cg/projection.hpp"
#include "dovetail/core/vec3.hpp"

namespace dovetail::cg::testing {

struct TestSurface {
  std::vector<Vec3> nodes;                ///< mesh nodes on the surface, m
  std::vector<std::array<int, 4>> quads;  ///< nodes around each face
  std::vector<int> patchOfQuad;
  std::vector<Vec3> vertices;              ///< nodes first, then one centre per face
  std::vector<std::array<int, 3>> facets;  ///< four per face
  std::vector<int> patchOfFacet;
  Projection localMap;  ///< vertices × nodes
};

inline void triangulate(TestSurface& s) {
  std::vector<ProjectionRow> rows;
  s.vertices = s.nodes;
  for (int i = 0; i < static_cast<int>(s.nodes.size()); ++i) rows.push_back({{i, 1.0}});
  for (std::size_t f = 0; f < s.quads.size(); ++f) {
    const auto [a, b, c, d] = s.quads[f];
    const int centre = static_cast<int>(s.vertices.size());
    s.vertices.push_back(0.25 * (s.nodes[a] + s.nodes[b] + s.nodes[c] + s.nodes[d]));
    rows.push_back({{a, 0.25}, {b, 0.25}, {c, 0.25}, {d, 0.25}});
    for (const auto& [i, j] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, d}, std::pair{d, a}}) {
      s.facets.push_back({i, j, centre});
      s.patchOfFacet.push_back(s.patchOfQuad[f]);
    }
  }
  s.localMap = fromRows(static_cast<int>(s.nodes.size()), rows);
}

/// Sides 0…5: x−, x+, y−, y+, z−, z+. Nodes on edges are shared by two sides.
inline TestSurface boxSurface(std::array<int, 3> n, Vec3 size) {
  TestSurface s;
  std::map<std::array<int, 3>, int> number;
  const auto node = [&](std::array<int, 3> i) {
    const auto [at, isNew] = number.try_emplace(i, static_cast<int>(s.nodes.size()));
    if (isNew) s.nodes.push_back({size.x * i[0] / n[0], size.y * i[1] / n[1], size.z * i[2] / n[2]});
    return at->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int end = 0; end < 2; ++end) {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      for (int i = 0; i < n[a]; ++i)
        for (int j = 0; j < n[b]; ++j) {
          std::array<int, 3> corner{};
          corner[axis] = end * n[axis];
          std::array<int, 4> quad{};
          const std::array<std::array<int, 2>, 4> step{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
          for (int k = 0; k < 4; ++k) {
            corner[a] = i + step[k][0];
            corner[b] = j + step[k][1];
            quad[end == 1 ? k : 3 - k] = node(corner);
          }
          s.quads.push_back(quad);
          s.patchOfQuad.push_back(2 * axis + end);
        }
    }
  triangulate(s);
  return s;
}

/// A dense copy of one row.
inline std::vector<double> dense(const std::vector<int>& column, const std::vector<double>& weight, std::size_t size) {
  std::vector<double> row(size, 0.0);
  for (std::size_t k = 0; k < column.size(); ++k) row[column[k]] += weight[k];
  return row;
}

}  // namespace dovetail::cg::testing
