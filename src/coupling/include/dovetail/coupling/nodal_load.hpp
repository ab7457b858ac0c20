// Contact loads on a few of many nodes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::coupling {

/// Forces on nodes, N, of which only `touched` differ from zero: the cost of clearing and kicks grows with the nodes in
/// contact, not with the mesh.
struct NodalLoad {
  std::vector<Vec3> force;   ///< one per node
  std::vector<int> touched;  ///< nodes with a force, in the order of their first contact
  std::vector<std::uint8_t> isTouched;

  explicit NodalLoad(std::size_t nodes = 0) : force(nodes), isTouched(nodes, 0) {}

  void touch(int node) {
    if (isTouched[node]) return;
    isTouched[node] = 1;
    touched.push_back(node);
  }
  void add(int node, const Vec3& f) {
    touch(node);
    force[node] += f;
  }
  void clear() {
    for (int node : touched) {
      force[node] = {};
      isTouched[node] = 0;
    }
    touched.clear();
  }
};

}  // namespace dovetail::coupling
