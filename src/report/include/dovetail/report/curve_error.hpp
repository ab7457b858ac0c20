// How far a curve lies from a reference.
#pragma once

#include <string>

#include "dovetail/report/figure.hpp"

namespace dovetail::report {

enum class Norm { mean, largest, end };

struct CurveError {
  double value = 0.0;    ///< in the unit of y; of the end with its sign, curve minus reference
  double covered = 0.0;  ///< fraction of the reference's range of x that the compared points span, 0 … 1
};

/// The reference is linear between its points, and points of the curve beyond its range are left out. With d = y minus
/// the reference: mean sqrt(∫ d² |dx| / ∫ |dx|) by the trapezoidal rule along the curve, which may turn back; largest
/// max |d|; end d at the last point of the curve that is compared.
/// @throws InputError if the x of the reference do not increase, a value is not finite, or there are fewer than two
/// points; if no point of the curve, or for the mean no interval, lies within the reference's range
CurveError distanceFrom(const Curve& reference, const Curve& curve, Norm norm);

}  // namespace dovetail::report
