// Functions of time and place written as text: "2*sin(t)".
#pragma once

#include <array>
#include <functional>
#include <string>

#include "dovetail/core/vec3.hpp"

namespace dovetail::expressions {

/// The expression as a function of t. Beside the operators and functions of muParser (sin, exp, min, …, a ? b : c)
/// there is the constant pi. Copies share one parser: they may not be evaluated by several threads at once.
/// @throws InputError that says where in the expression the fault is; when evaluated, NumericalError if the value is
///         not finite
std::function<double(double)> timeFunction(const std::string& expression);

/// The same of reference position x, y, z (m) and t (s).
std::function<double(const Vec3&, double)> fieldFunction(const std::string& expression);
/// Three of them, one per component.
std::function<Vec3(const Vec3&, double)> vectorField(const std::array<std::string, 3>& expressions);

}  // namespace dovetail::expressions
