// A closed box as a wall.
#pragma once

#include <vector>

#include "dovetail/dem/walls/wall.hpp"

namespace dovetail::dem {

inline TriangulatedWall boxWall(const Vec3& lower, const Vec3& size) {
  std::vector<Vec3> x;
  for (int c = 0; c < 8; ++c)
    x.push_back(lower + Vec3{c & 1 ? size.x : 0.0, c & 2 ? size.y : 0.0, c & 4 ? size.z : 0.0});
  return makeWall(x,
                  {{0, 2, 3},
                   {0, 3, 1},
                   {4, 5, 7},
                   {4, 7, 6},
                   {0, 1, 5},
                   {0, 5, 4},
                   {2, 6, 7},
                   {2, 7, 3},
                   {0, 4, 6},
                   {0, 6, 2},
                   {1, 3, 7},
                   {1, 7, 5}},
                  true);
}

}  // namespace dovetail::dem
