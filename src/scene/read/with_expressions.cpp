#include "dovetail/expressions/expressions.hpp"
#include "parameters.hpp"

namespace dovetail::scene {

double valueOf(const std::string& expression, const Parameters& parameters) {
  return expressions::value(expression, parameters);
}

std::function<double(double)> functionOf(const std::string& expression, const Parameters& parameters) {
  return expressions::timeFunction(expression, parameters);
}

}  // namespace dovetail::scene
