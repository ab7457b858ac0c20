// What arrays of items must fulfil before they are used.
#pragma once

#include <cmath>
#include <span>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/vec3.hpp"

namespace dovetail::cg {

inline void requireSameLength(std::size_t a, std::size_t b, const std::string& what) {
  if (a != b)
    throw InputError("the lengths " + std::to_string(a) + " and " + std::to_string(b) + " differ", what,
                     "give one value per item");
}

/// @param item what an item is, for the error: "particle"   @param field "position"
inline void requireFiniteItems(std::span<const Vec3> values, const char* item, const char* field) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!isFinite(values[i]))
      throw InputError("the " + std::string(field) + " is not finite", item + (" " + std::to_string(i)),
                       "remove it or correct its state");
}

inline void requireNotNegative(std::span<const double> values, const char* item, const char* field) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!(values[i] >= 0.0 && std::isfinite(values[i])))
      throw InputError("the " + std::string(field) + " is not a number of at least 0", item + (" " + std::to_string(i)),
                       "remove it or correct its state");
}

}  // namespace dovetail::cg
