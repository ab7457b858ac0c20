// An absorber of particle motions that the mesh cannot represent.
#pragma once

#include <span>
#include <vector>

#include "dovetail/arlequin/gap_operator.hpp"
#include "dovetail/arlequin/overlap.hpp"
#include "dovetail/cg/projection.hpp"
#include "dovetail/core/vec3.hpp"

namespace dovetail::arlequin {

/// Damps the fluctuation v' = R v, R = 1 − ΦΠ, of the particles in the overlap: F = −Rᵀ D R v with D = a (1 − w) w m.
/// It conserves momentum (R of a constant is zero) and never adds energy; the energy that it takes is to be booked. The
/// rate grows with 1 − w, so that it starts without a jump. Stable for a dt < 2.
class Absorber {
public:
  /// @param rate          a, 1/s   @param particleMass  weighted masses of all particles, kg
  /// @throws InputError unless the rate is finite and > 0
  Absorber(const Overlap& overlap, const GapOperator& gap, const cg::Projection& interpolation,
           std::span<const double> particleMass, double rate);

  /// Adds the force to f (of all particles) and keeps it. @param v  velocities of all particles, m/s
  void apply(std::span<const Vec3> v, std::span<Vec3> f);
  /// The particles have other numbers now. @param particle  one per row of the overlap
  void renumber(std::span<const int> particle) { overlap_.particle.assign(particle.begin(), particle.end()); }
  /// The last force, N, one per row of the overlap.
  std::span<const Vec3> force() const { return force_; }

private:
  Overlap overlap_;
  cg::Projection coarse_, coarseBack_, fine_, fineBack_;  // Π, Πᵀ, Φ on the gap's nodes, Φᵀ
  std::vector<double> damping_;                           // D, kg/s
  std::vector<Vec3> force_, here_, rows_, back_;
};

}  // namespace dovetail::arlequin
