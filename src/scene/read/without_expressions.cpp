#include "dovetail/core/error.hpp"
#include "parameters.hpp"

namespace dovetail::scene {

namespace {
[[noreturn]] void refuse(const std::string& expression) {
  throw InputError("this build has no expressions", "\"" + expression + "\"",
                   "write a number or the name of a parameter, or build with muParser");
}
}  // namespace

double valueOf(const std::string& expression, const Parameters& parameters) {
  if (const auto found = parameters.find(expression); found != parameters.end()) return found->second;
  refuse(expression);
}

std::function<double(double)> functionOf(const std::string& expression, const Parameters&) { refuse(expression); }
std::function<double(const Vec3&, double)> fieldOf(const std::string& expression, const Parameters&) {
  refuse(expression);
}

}  // namespace dovetail::scene
