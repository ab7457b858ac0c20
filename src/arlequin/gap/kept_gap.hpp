// The part of a gap that is kept through list updates: it turns with the solid about its row.
#pragma once

#include <span>
#include <vector>

#include "dovetail/arlequin/gap_operator.hpp"
#include "dovetail/coupling/nodal_load.hpp"

namespace dovetail::arlequin {

/// Spin of the nodes of a row, least squares: ω = I⁻¹ Σ r × v, r from their mean. Its adjoint makes a couple τ into
/// nodal forces (I⁻¹τ) × r, which sum to zero and have the moment τ. All nodes count alike: with the weights of B, I
/// would be as good as singular wherever a row hangs on one particle near a node or an edge.
class RowSpin {
public:
  /// @param position  of the nodes, m
  RowSpin(const GapOperator& gap, std::size_t row, std::span<const Vec3> position);
  /// @param motion  of the nodes: displacements, m, or velocities   @return rad, or rad/s
  Vec3 of(std::span<const Vec3> motion) const;
  /// @param couple  N m
  void addForces(const Vec3& couple, coupling::NodalLoad& load) const;

private:
  Vec3 solve(const Vec3& moment) const;
  std::span<const int> node_;
  std::vector<Vec3> arm_;        // m
  std::array<Vec3, 3> inverse_;  // I⁻¹, by rows, 1/m²
};

/// v turned by the rotation vector θ.
Vec3 turned(const Vec3& v, const Vec3& theta);

}  // namespace dovetail::arlequin
