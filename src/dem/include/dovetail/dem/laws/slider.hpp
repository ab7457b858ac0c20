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
  Vector stretch, force;      ///< of the spring, and of both, along the stretch
  double energy = 0.0;        ///< J stored
  double slipPower = 0.0;     ///< W lost to sliding, average of this step
  double dashpotPower = 0.0;  ///< W, now

  /// The spring alone keeps below the limit; the dashpot adds what the limit leaves. (The other way round, a dashpot
  /// above the limit would stretch the spring backwards, with energy from nowhere.)
  /// @param kept        stretch before this step
  /// @param forceBefore of the spring, in the last step; sliding is booked with the mean of both, as the work is done
  /// @param moved       relative displacement in this step
  /// @param rate        relative velocity now
  [[gnu::always_inline]] Slider(const Vector& kept, const Vector& forceBefore, const Vector& moved, const Vector& rate,
                                double stiffness, double damping, double limit, double inverseDt) {
    const Vector stretched = kept + moved;
    const double size = stiffness * detail::sizeOf(stretched);
    const bool slides = size > limit;
    stretch = (slides ? limit / (slides ? size : 1.0) : 1.0) * stretched;
    const Vector spring = stiffness * stretch;
    force = detail::copyOf(spring);
    energy = 0.5 * detail::scalarProduct(spring, stretch);
    slipPower = 0.5 * detail::scalarProduct(spring + forceBefore, stretched - stretch) * inverseDt;
    if constexpr (dashpot) {
      const Vector both = spring + damping * rate;
      const double whole = detail::sizeOf(both);
      const bool cut = damping > 0.0 ? whole > limit : false;
      force = (cut ? limit / (cut ? whole : 1.0) : 1.0) * both;
      dashpotPower = detail::scalarProduct(force - spring, rate);
    }
  }
};

/// A slider whose spring changes its stiffness with the normal load. No energy appears: while the stiffness grows, the
/// force stays and the stretch shrinks; while it falls, the stretch stays and the force shrinks. What the spring loses
/// by that counts as lost.
/// While it grows, what moves in a step meets the mean stiffness of the step, of k ∝ √δ with a steady dδ/dt: the force
/// is of second order, and no energy appears either, as the mean is not below the stiffness before.
/// @param old        stretch before this step, in today's contact plane
/// @param before     stiffness in the last step; 0 if they have just touched
/// @param firstMean  see NormalResponse
template <bool dashpot = true, class Vector>
[[gnu::always_inline]] inline Slider<dashpot, Vector> slideGrowing(const Vector& old, double before,
                                                                   const Vector& moved, const Vector& rate,
                                                                   double stiffness, double firstMean, double damping,
                                                                   double limit, double inverseDt) {
  const bool grows = stiffness > before;
  const double perStiffness = 1.0 / (grows ? stiffness : 1.0), ratio = grows ? before * perStiffness : 1.0;
  const double mean = before > 0.0 ? 2.0 / 3.0 * (1.0 + ratio * ratio / (1.0 + ratio)) : firstMean;
  const Vector kept = ratio * old, forceBefore = before * old, met = (grows ? mean : 1.0) * moved;
  Slider<dashpot, Vector> now(kept, forceBefore, met, rate, stiffness, damping, limit, inverseDt);
  const double change = 0.5 * (detail::scalarProduct(forceBefore, old - kept) +
                               detail::scalarProduct(forceBefore - stiffness * kept, now.stretch) +
                               detail::scalarProduct(forceBefore + stiffness * now.stretch, moved - met));
  now.slipPower += change * inverseDt;
  return now;
}

}  // namespace dovetail::dem
