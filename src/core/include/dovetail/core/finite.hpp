// NaN and Inf are caught at once, naming the particle, node or element.
#pragma once

#include <span>
#include <string>

#include "dovetail/core/vec3.hpp"

namespace dovetail {

/// @param values  one vector per item
/// @param item    what an item is: "particle", "node"
/// @param field   what the values are: "velocity"
/// @throws NumericalError naming the first item with a NaN or Inf, and `when` (for instance "t = 0.5 s, step 100")
void requireFinite(std::span<const Vec3> values, const std::string& item, const std::string& field,
                   const std::string& when);

/// @throws InputError if value is not finite, or not > 0
double requirePositive(double value, const std::string& field);
/// @throws InputError if value is not finite, or < 0
double requireNonNegative(double value, const std::string& field);
/// @throws InputError unless 0 < value < 1, or = 0 where that is allowed
void requireFraction(double value, const std::string& field, const std::string& where, bool orZero = false);

/// Shortest text that reads back as the same double.
std::string formatNumber(double value);

}  // namespace dovetail
