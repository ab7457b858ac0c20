// Parameters of a scene and the expressions that use them.
#pragma once

#include <map>
#include <string>

namespace dovetail::scene {

using Parameters = std::map<std::string, double>;

/// The value of an expression of SI numbers and parameters.
/// @throws InputError if it cannot be read or is not finite, or if the build has no expressions
double valueOf(const std::string& expression, const Parameters& parameters);

}  // namespace dovetail::scene
