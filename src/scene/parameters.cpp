#include "parameters.hpp"

#include "dovetail/expressions/expressions.hpp"

namespace dovetail::scene {

double valueOf(const std::string& expression, const Parameters& parameters) {
  return expressions::value(expression, parameters);
}

}  // namespace dovetail::scene
