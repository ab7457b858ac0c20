#include "dovetail/expressions/expressions.hpp"
#include "parameters.hpp"

namespace dovetail::scene {

double valueOf(const std::string& expression, const Parameters& parameters) {
  return expressions::value(expression, parameters);
}

std::function<double(double)> functionOf(const std::string& expression, const Parameters& parameters) {
  return expressions::timeFunction(expression, parameters);
}

std::function<double(const Vec3&, double)> fieldOf(const std::string& expression, const Parameters& parameters) {
  return expressions::fieldFunction(expression, parameters);
}

}  // namespace dovetail::scene
