#include "kept_gap.hpp"

#include <array>
#include <cmath>

namespace dovetail::arlequin {

namespace {

constexpr double leastDeterminant = 1e-9;  // of the inertia over its mean moment cubed

}  // namespace

RowSpin::RowSpin(const GapOperator& gap, std::size_t row, std::span<const Vec3> position)
    : node_(gap.nodes.rowColumns(static_cast<int>(row))) {
  const double weight = 1.0 / static_cast<double>(node_.size());
  Vec3 centre;
  for (const int n : node_) centre += weight * position[static_cast<std::size_t>(n)];
  std::array<Vec3, 3> inertia{};
  for (const int n : node_) {
    const Vec3 r = position[static_cast<std::size_t>(n)] - centre;
    arm_.push_back(r);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        inertia[static_cast<std::size_t>(a)][b] += (a == b ? squaredNorm(r) : 0.0) - r[a] * r[b];
  }
  const std::array<Vec3, 3> adjugate = {cross(inertia[1], inertia[2]), cross(inertia[2], inertia[0]),
                                        cross(inertia[0], inertia[1])};
  const double det = dot(inertia[0], adjugate[0]);
  const double scale = (inertia[0].x + inertia[1].y + inertia[2].z) / 3.0;
  const bool onALine = !(det > leastDeterminant * scale * scale * scale);
  for (std::size_t a = 0; a < 3; ++a) inverse_[a] = onALine ? Vec3{} : adjugate[a] / det;
}

Vec3 RowSpin::solve(const Vec3& moment) const {
  return {dot(inverse_[0], moment), dot(inverse_[1], moment), dot(inverse_[2], moment)};
}

Vec3 RowSpin::of(std::span<const Vec3> motion) const {
  Vec3 moment;
  for (std::size_t k = 0; k < node_.size(); ++k) moment += cross(arm_[k], motion[static_cast<std::size_t>(node_[k])]);
  return solve(moment);
}

void RowSpin::addForces(const Vec3& couple, coupling::NodalLoad& load) const {
  const Vec3 spin = solve(couple);
  for (std::size_t k = 0; k < node_.size(); ++k) load.add(node_[k], cross(spin, arm_[k]));
}

Vec3 turned(const Vec3& v, const Vec3& theta) {
  const double angle = norm(theta);
  if (angle == 0.0) return v;
  const Vec3 axis = theta / angle;
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + ((1.0 - std::cos(angle)) * dot(axis, v)) * axis;
}

}  // namespace dovetail::arlequin
