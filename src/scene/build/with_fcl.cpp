#include "dovetail/geometry_fcl/overlap_audit.hpp"
#include "overlap_audit.hpp"

namespace dovetail::scene {

std::vector<std::array<int, 2>> overlapping(const std::vector<geometry::TriangleMesh>& meshes) {
  return geometry::auditOverlaps({{}, {}, meshes});
}

}  // namespace dovetail::scene
