#include "dovetail/core/finite.hpp"

#include <charconv>

#include "dovetail/core/error.hpp"

namespace dovetail {

std::string formatNumber(double value) {
  char text[32];
  const auto result = std::to_chars(text, text + sizeof text, value);
  return std::string(text, result.ptr);
}

void requireFinite(std::span<const Vec3> values, const std::string& item, const std::string& field,
                   const std::string& when) {
  // One branch per array in the good case: a NaN or Inf anywhere makes the sum of value × 0 differ from zero.
  double poison = 0.0;
  for (const Vec3& value : values) poison += 0.0 * value.x + 0.0 * value.y + 0.0 * value.z;
  if (poison == 0.0) return;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!isFinite(values[i]))
      throw NumericalError("the " + field + " of " + item + " " + std::to_string(i) + " is not finite", when,
                           "take a smaller time step, or check the stiffness and mass of this " + item);
}

double requirePositive(double value, const std::string& field) {
  if (!std::isfinite(value) || value <= 0.0)
    throw InputError(field + " is " + formatNumber(value), field, "give a finite number greater than zero");
  return value;
}

double requireNonNegative(double value, const std::string& field) {
  if (!std::isfinite(value) || value < 0.0)
    throw InputError(field + " is " + formatNumber(value), field, "give a finite number of at least zero");
  return value;
}

void requireFraction(double value, const std::string& field, const std::string& where, bool orZero) {
  if (value < 1.0 && (orZero ? value >= 0.0 : value > 0.0)) return;
  throw InputError(field + " is " + formatNumber(value), where,
                   orZero ? "give a fraction of 0 or more, below 1" : "give one above 0 and below 1");
}

}  // namespace dovetail
