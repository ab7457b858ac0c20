// What the structures of a scene are made of. All quantities are in SI units; `required` marks numbers that a file must
// give.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/box.hpp"

namespace dovetail::scene {

inline constexpr double required = std::numeric_limits<double>::quiet_NaN();
inline constexpr Vec3 requiredVector{required, required, required};
inline constexpr geometry::Box requiredBox{requiredVector, requiredVector};

/// Values of the parameters in "let" by their names.
using Parameters = std::map<std::string, double>;

/// A number, or one of the words that a key knows.
struct NumberOrWord {
  double number = 0.0;
  std::string word;  ///< empty: the number counts

  friend bool operator==(const NumberOrWord&, const NumberOrWord&) = default;
};

/// A number, or a function of time: an expression of t (s), where a key says so of the place x, y, z (m) too, and
/// parameters.
struct TimeValue {
  double number = 0.0;
  std::string expression;  ///< empty: the number counts
};
using TimeVector = std::array<TimeValue, 3>;

/// About an axis, counter-clockwise seen from its tip.
struct Turn {
  Vec3 axis = requiredVector;
  TimeValue angle{required, ""};  ///< rad
  std::optional<Vec3> point;      ///< on the axis, m; not given: that of what turns
};

}  // namespace dovetail::scene
