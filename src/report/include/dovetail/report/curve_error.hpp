// How far a curve lies from a reference.
#pragma once

#include <string>
#include <vector>

#include "dovetail/report/figure.hpp"

namespace dovetail::report {

enum class Norm { mean, largest, end, relative };

struct CurveError {
  double value = 0.0;    ///< in the unit of y, relative without one; of the end with its sign, curve minus reference
  double covered = 0.0;  ///< fraction of the reference's range of x that the compared points span, 0 … 1
};

/// The reference is linear between its points, and points of the curve beyond its range are left out. With d = y minus
/// the reference: mean sqrt(∫ d² |dx| / ∫ |dx|) by the trapezoidal rule along the curve, which may turn back; largest
/// max |d|; end d at the last point of the curve that is compared; relative the mean over that of the reference itself,
/// at the same points.
/// @throws InputError if the x of the reference do not increase, a value is not finite, or there are fewer than two
/// points; if no point of the curve, or for means no interval, lies within the reference's range; if the reference is
/// zero where it is divided by
CurveError distanceFrom(const Curve& reference, const Curve& curve, Norm norm);

/// The mean at those points of the first that lie within the ranges of all. @throws InputError if there are none, or a
/// curve is no reference, as above
Curve meanOf(const std::vector<Curve>& curves);

}  // namespace dovetail::report
