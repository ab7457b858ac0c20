// How large the particles of a packing are.
#pragma once

#include <variant>
#include <vector>

#include "dovetail/dem/setup/random_stream.hpp"

namespace dovetail::dem {

/// Radii uniform between two bounds, by number; equal bounds: all the same. m
struct UniformSizes {
  double smallest, largest;
};
/// Radii normal by number, cut off at both bounds (drawn again outside). m
struct NormalSizes {
  double mean, deviation, smallest, largest;
};
/// ln(radius) normal by number: median m, deviation of the logarithm; cut off at both bounds. m
struct LogNormalSizes {
  double median, logDeviation, smallest, largest;
};
/// A few radii, m, with the relative numbers of particles that have them.
struct SizeClasses {
  std::vector<double> radius, number;
};
/// A sieve curve: fraction of the mass that passes a sieve, over the sieve's opening (the particle's diameter, m), from
/// 0 to 1, both ascending; between two sieves the passing mass is linear in the logarithm of the diameter.
struct GradingCurve {
  std::vector<double> diameter, passing;
};

using Sizes = std::variant<UniformSizes, NormalSizes, LogNormalSizes, SizeClasses, GradingCurve>;

/// @throws InputError: bounds not finite, not > 0 or not in order; a deviation not finite and ≥ 0; a mean or median
///   that is more than 4 deviations outside the bounds; no classes, or a radius or number of one not finite and > 0; a
///   curve with fewer than 2 points, not ascending, or not from 0 to 1
void validate(const Sizes& sizes);

/// A radius, m, of valid sizes.
double drawRadius(const Sizes& sizes, RandomStream& random);

/// Bounds of the radii of valid sizes, m.
UniformSizes boundsOf(const Sizes& sizes);
/// Mean volume of the particles, m³: their number times it is the volume. Normal ones by Simpson's rule.
double meanVolume(const Sizes& sizes);

}  // namespace dovetail::dem
