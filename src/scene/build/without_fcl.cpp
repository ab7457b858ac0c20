#include "overlap_audit.hpp"

namespace dovetail::scene {

std::vector<std::array<int, 2>> overlapping(const std::vector<geometry::TriangleMesh>&) { return {}; }

}  // namespace dovetail::scene
