// FIRE (Bitzek et al., Phys. Rev. Lett. 97, 2006): velocities are mixed with the direction of the forces, and set to
// zero when their power is negative; steps lengthen while it is positive.
#pragma once

#include <vector>

#include "dovetail/dem/particles/particles.hpp"

namespace dovetail::dem {

/// Σ f·v, Σ v², Σ f², torques and spins as forces and speeds at the surface.
struct FireSums {
  double power = 0.0, speed = 0.0, force = 0.0;
  FireSums& operator+=(const FireSums& b) {
    power += b.power;
    speed += b.speed;
    force += b.force;
    return *this;
  }
};
/// Of those that nobody else moves.
FireSums fireSums(const Particles& particles);

/// v ← keep v + lean f
struct FireMix {
  double keep = 0.0, lean = 0.0;
};
/// Of the same; and nobody will drift farther than half its radius in a step.
void steer(Particles& particles, const FireMix& mix, double dt);

/// The steps' length and how far velocities lean towards forces.
class Fire {
public:
  explicit Fire(double longest) : longest_(longest), dt_(0.2 * longest) {}
  double dt() const { return dt_; }
  void setLongest(double longest);
  /// What velocities become before the next step, which takes dt().
  FireMix next(const FireSums& sums);

private:
  static constexpr double mixAtStart = 0.1;
  double longest_, dt_, mix_ = mixAtStart;
  int good_ = 0;
};

}  // namespace dovetail::dem
