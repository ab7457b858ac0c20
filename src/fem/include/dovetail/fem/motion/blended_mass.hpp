// A mass matrix between lumped and consistent, for explicit steps.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/elements/elements.hpp"
#include "dovetail/fem/model/nodes.hpp"

namespace dovetail::fem {

/// β that gives trilinear bricks of edge h the dispersion of a chain of particles of spacing d ≤ h, to second order in
/// the wave number: chain ω² ≈ c²k²(1 − k²d²/12), bricks with M = β consistent + (1 − β) lumped
/// ω² ≈ c²k²(1 − (1 − 2β)k²h²/12), hence β = (1 − (d/h)²)/2.
/// @throws InputError unless 0 ≤ d ≤ h and h > 0
double matchedShare(double spacing, double elementSize);

/// M = share · consistent + (1 − share) · lumped, factorised once: M⁻¹ f costs two sweeps over the factor. The row sums
/// are the lumped masses whatever the share, so momentum is Σ m v with nodes.mass.
class BlendedMass {
public:
  /// Reads which components are held; they take no part in the inverse.
  /// @param nodes  mass = lumped masses of the block (addLumpedMass)
  /// @throws InputError if share is not within 0 … 1 or a node lacks mass; NumericalError if M is not positive definite
  BlendedMass(const ElementBlock& block, const Nodes& nodes, double share);
  ~BlendedMass();
  BlendedMass(BlendedMass&&) noexcept;
  BlendedMass& operator=(BlendedMass&&) noexcept;

  double share() const { return share_; }
  std::size_t nodeCount() const { return lumped_.size(); }
  /// f ← a with M a = f for the free components and a = 0 for held ones; N → m/s².
  void solve(std::span<Vec3> f) const;
  /// M v, kg m/s.
  std::vector<Vec3> multiply(std::span<const Vec3> v) const;
  /// ½ vᵀMv, J.
  double kineticEnergy(std::span<const Vec3> v) const;
  /// Σ over held components of (M a)_held − f_held: the force of the supports, N.
  /// @param acceleration  of solve(f)   @param force  f before it
  Vec3 supportForce(std::span<const Vec3> acceleration, std::span<const Vec3> force) const;

private:
  struct Factor;
  double share_;
  std::vector<double> lumped_;                    // kg
  std::vector<std::uint8_t> held_;                // as Nodes::fixed
  std::vector<int> heldNodes_;                    // with any held component
  std::vector<int> offsets_, neighbour_;          // scalar matrix by rows
  std::vector<double> value_;                     // kg
  std::vector<std::unique_ptr<Factor>> factors_;  // of the distinct sets of held nodes
  std::array<int, 3> factorOf_{};                 // per component
};

}  // namespace dovetail::fem
