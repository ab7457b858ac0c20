// What a field of points that pointField has made of a law remembers.
#pragma once

#include <span>

#include "dovetail/fem/laws/point_field.hpp"

namespace dovetail::fem {

/// Committed history of the points, as many numbers each as their law has; empty for other fields.
std::span<const double> historyOf(const PointField& field);

}  // namespace dovetail::fem
