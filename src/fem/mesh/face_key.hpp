// Faces by their corners.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <span>

#include "dovetail/fem/mesh/cell_topology.hpp"

namespace dovetail::fem {

/// The sorted corners of a face, which name it whatever the order and side it is seen from.
using FaceKey = std::array<int, 4>;
using FaceKeys = std::set<FaceKey>;

inline FaceKey keyOf(const Face& face) {
  FaceKey key{};
  key.fill(std::numeric_limits<int>::max());
  std::copy_n(face.node.begin(), cornersOf(face.shape), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}
inline FaceKeys keysOf(std::span<const Face> faces) {
  FaceKeys keys;
  for (const Face& face : faces) keys.insert(keyOf(face));
  return keys;
}

}  // namespace dovetail::fem
