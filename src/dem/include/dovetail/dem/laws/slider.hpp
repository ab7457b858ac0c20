// A spring with a slider before it and a dashpot beside it: what resists sliding, rolling and twisting in all laws.
#pragma once

#include <cmath>

#include "dovetail/dem/laws/contact.hpp"

namespace dovetail::dem {

namespace detail {
[[gnu::always_inline]] inline double sizeOf(const Vec3& a) { return norm(a); }
[[gnu::always_inline]] inline double sizeOf(double a) { return std::abs(a); }
[[gnu::always_inline]] inline double scalarProduct(const Vec3& a, const Vec3& b) { return dot(a, b); }
[[gnu::always_inline]] inline double scalarProduct(double a, double b) { return a * b; }
/// Copied whole, a vector would stay in memory and the loop would not vectorise.
[[gnu::always_inline]] inline Vec3 copyOf(const Vec3& a) { return {a.x, a.y, a.z}; }
[[gnu::always_inline]] inline double copyOf(double a) { return a; }
}  // namespace detail

/// A spring, a dashpot beside it, and a slider before both.
/// @tparam dashpot  there may be one; without it a root and a quotient are spared
/// @tparam Vector   Vec3, or double for motion along or about one line
template <bool dashpot = true, class Vector = Vec3>
struct Slider {
  Vector stretch, force;   ///< of the spring, and of both, along the stretch
  double energy = 0.0;     ///< J stored
  double lostPower = 0.0;  ///< W lost to sliding and to the dashpot, average of this step

  /// The spring alone keeps below the limit; the dashpot adds what the limit leaves. (The other way round, a dashpot
  /// above the limit would stretch the spring backwards, with energy from nowhere.)
  /// What the dashpot takes is booked as that of the normal one (bookedDashpot); where the limit cuts it off it depends
  /// on the velocity less, so that the step of the first touch counts nearly as any other.
  /// @param kept        stretch before this step
  /// @param forceBefore of the spring, in the last step; sliding is booked with the mean of both, as the work is done
  /// @param rate        relative velocity
  [[gnu::always_inline]] Slider(const Vector& kept, const Vector& forceBefore, const Vector& rate, double stiffness,
                                double damping, double dampingFraction, double limit, const Contact& contact) {
    const Vector stretched = kept + contact.dt * rate;
    const double size = stiffness * detail::sizeOf(stretched);
    const bool slides = size > limit;
    stretch = (slides ? limit / (slides ? size : 1.0) : 1.0) * stretched;
    const Vector spring = stiffness * stretch;
    force = detail::copyOf(spring);
    energy = 0.5 * detail::scalarProduct(spring, stretch);
    lostPower = 0.5 * detail::scalarProduct(spring + forceBefore, stretched - stretch) * contact.inverseDt;
    if constexpr (dashpot) {
      const Vector both = spring + damping * rate;
      const double whole = detail::sizeOf(both);
      const bool cut = damping > 0.0 ? whole > limit : false;
      force = (cut ? limit / (cut ? whole : 1.0) : 1.0) * both;
      lostPower += (cut ? 0.5 + 0.5 * dampingFraction : dampingFraction) * detail::scalarProduct(force - spring, rate);
    }
  }
};

/// A slider whose spring changes its stiffness with the normal load. No energy appears: while the stiffness grows, the
/// force stays and the stretch shrinks; while it falls, the stretch stays and the force shrinks. What the spring loses
/// by that counts as lost.
/// @param old     stretch before this step, in today's contact plane
/// @param before  stiffness in the last step
template <bool dashpot = true, class Vector>
[[gnu::always_inline]] inline Slider<dashpot, Vector> slideGrowing(const Vector& old, double before, const Vector& rate,
                                                                   double stiffness, double damping,
                                                                   double dampingFraction, double limit,
                                                                   const Contact& contact) {
  const bool grows = stiffness > before;
  const Vector kept = (grows ? before / (grows ? stiffness : 1.0) : 1.0) * old, forceBefore = before * old;
  Slider<dashpot, Vector> now(kept, forceBefore, rate, stiffness, damping, dampingFraction, limit, contact);
  const double change = 0.5 * (detail::scalarProduct(forceBefore, old - kept) +
                               detail::scalarProduct(forceBefore - stiffness * kept, now.stretch));
  now.lostPower += change * contact.inverseDt;
  return now;
}

}  // namespace dovetail::dem
