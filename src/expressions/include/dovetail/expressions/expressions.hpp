// Functions of time and place written as text, "2*sin(t)", and numbers.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>

#include "dovetail/core/vec3.hpp"

namespace dovetail::expressions {

/// The expression as a function of t. Beside the operators and functions of muParser (sin, exp, min, …, a ? b : c)
/// there is the constant pi. Copies share one parser: they may not be evaluated by several threads at once.
/// @param constants  by name: letters, digits and '_', with a letter first
/// @throws InputError that says where in the expression the fault is; when evaluated, NumericalError if the value is
///         not finite
std::function<double(double)> timeFunction(const std::string& expression,
                                           const std::map<std::string, double>& constants = {});

/// The same of reference position x, y, z (m) and t (s).
std::function<double(const Vec3&, double)> fieldFunction(const std::string& expression,
                                                         const std::map<std::string, double>& constants = {});
/// Three of them, one per component.
std::function<Vec3(const Vec3&, double)> vectorField(const std::array<std::string, 3>& expressions);

/// The value of an expression of constants, such as "2*radius".
/// @param constants  by name: letters, digits and '_', with a letter first
/// @throws InputError that says where in the expression the fault is, or if the value is not finite
double value(const std::string& expression, const std::map<std::string, double>& constants);

}  // namespace dovetail::expressions
