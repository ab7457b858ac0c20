// The way of a specimen to a pressure.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

namespace dovetail::dem {

/// Isotropic strains by the secant of the last two states, never longer than a bound that is halved whenever a strain
/// has gone too far.
class PressureSecant {
public:
  /// @param wanted   Pa
  /// @param longest  strain, > 0
  /// @param bulk     Pa, guess of the bulk modulus; 0: none, the longest strain comes first
  PressureSecant(double wanted, double longest, double bulk) : wanted_(wanted), longest_(longest), bulk_(bulk) {}

  /// Volumetric strain to go on by from a state at rest, > 0 shortens. @param pressure  there, Pa
  double next(double pressure) {
    const double before = std::exchange(pressure_, pressure), missing = wanted_ - pressure;
    if (missing * strain_ < 0.0) longest_ *= 0.5;
    if (before > 0.0 && pressure > 0.0 && (pressure - before) / strain_ > 0.05 * bulk_)
      bulk_ = (pressure - before) / strain_;
    const bool loose = pressure < 0.01 * wanted_ || bulk_ == 0.0;
    return strain_ = loose ? std::copysign(longest_, missing) : std::clamp(missing / bulk_, -longest_, longest_);
  }
  double bulk() const { return bulk_; }  ///< Pa, the secant

private:
  double wanted_, longest_, bulk_, pressure_ = 0.0, strain_ = 0.0;
};

}  // namespace dovetail::dem
