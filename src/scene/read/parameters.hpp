// Parameters of a scene and the expressions that use them.
#pragma once

#include <functional>
#include <string>

#include "dovetail/scene/basics.hpp"

namespace dovetail::scene {

/// The value of an expression of SI numbers and parameters.
/// @throws InputError if it cannot be read or is not finite, or if the build has no expressions
double valueOf(const std::string& expression, const Parameters& parameters);

/// The expression as a function of the time t, s. Copies may not be evaluated by several threads at once.
/// @throws InputError if it cannot be read, or if the build has no expressions; when evaluated, NumericalError if the
///         value is not finite
std::function<double(double)> functionOf(const std::string& expression, const Parameters& parameters);

/// The same of the place x, y, z, m, and the time. No parameter may have the name of a coordinate.
std::function<double(const Vec3&, double)> fieldOf(const std::string& expression, const Parameters& parameters);

}  // namespace dovetail::scene
