#include "dovetail/expressions/expressions.hpp"

#include <muParser.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::expressions {

namespace {

/// Parser and the variables that it refers to.
class Expression {
public:
  enum class Variables { none, time, timeAndPlace };
  Expression(const std::string& text, Variables variables, const std::map<std::string, double>& constants = {})
      : text_(text) {
    try {
      parser_.DefineConst("pi", std::numbers::pi);
      for (const auto& [name, number] : constants) parser_.DefineConst(name, number);
      if (variables != Variables::none) parser_.DefineVar("t", &t_);
      if (variables == Variables::timeAndPlace) {
        parser_.DefineVar("x", &X_.x);
        parser_.DefineVar("y", &X_.y);
        parser_.DefineVar("z", &X_.z);
      }
      parser_.SetExpr(text);
      parser_.Eval();
    } catch (const mu::Parser::exception_type& error) {
      refuse(error);
    }
    if (parser_.GetNumResults() != 1)
      throw InputError("the expression has " + std::to_string(parser_.GetNumResults()) + " values", quoted(),
                       "write one expression, without commas outside of functions");
  }
  Expression(const Expression&) = delete;
  Expression& operator=(const Expression&) = delete;

  /// Of constants.
  double once() {
    const double value = parser_.Eval();
    if (!std::isfinite(value))
      throw InputError("the expression gives " + formatNumber(value), quoted(), "write one that is finite");
    return value;
  }
  double at(const Vec3& X, double t) {
    X_ = X;
    t_ = t;
    const double value = parser_.Eval();
    if (!std::isfinite(value))
      throw NumericalError("the expression gives " + formatNumber(value),
                           quoted() + " at t = " + formatNumber(t) + " s",
                           "write one that is finite at all times and places it is used");
    return value;
  }

private:
  static std::string shortened(const std::string& text, bool atEnd) {
    constexpr std::size_t most = 60;
    if (text.size() <= most) return text;
    return atEnd ? text.substr(0, most) + "…" : "…" + text.substr(text.size() - most);
  }
  std::string quoted() const { return "\"" + shortened(text_, true) + "\""; }
  [[noreturn]] void refuse(const mu::Parser::exception_type& error) const {
    const auto place = static_cast<std::size_t>(error.GetPos());
    const std::size_t cut = place < text_.size() ? place : text_.size();
    const std::string& message = error.GetMsg();
    throw InputError(
        "the expression cannot be read" + (message.size() > 200 ? "" : ": " + message),
        "\"" + shortened(text_.substr(0, cut), false) + " >>> " + shortened(text_.substr(cut), true) + "\"",
        "correct it at the arrows, character " + std::to_string(cut + 1));
  }

  std::string text_;
  mu::Parser parser_;
  Vec3 X_;
  double t_ = 0.0;
};

}  // namespace

std::function<double(double)> timeFunction(const std::string& expression,
                                           const std::map<std::string, double>& constants) {
  return [parsed = std::make_shared<Expression>(expression, Expression::Variables::time, constants)](double t) {
    return parsed->at({}, t);
  };
}

std::function<double(const Vec3&, double)> fieldFunction(const std::string& expression,
                                                         const std::map<std::string, double>& constants) {
  return [parsed = std::make_shared<Expression>(expression, Expression::Variables::timeAndPlace, constants)](
             const Vec3& X, double t) { return parsed->at(X, t); };
}

std::function<Vec3(const Vec3&, double)> vectorField(const std::array<std::string, 3>& expressions) {
  return [x = fieldFunction(expressions[0]), y = fieldFunction(expressions[1]), z = fieldFunction(expressions[2])](
             const Vec3& X, double t) {
    return Vec3{x(X, t), y(X, t), z(X, t)};
  };
}

double value(const std::string& expression, const std::map<std::string, double>& constants) {
  return Expression(expression, Expression::Variables::none, constants).once();
}

}  // namespace dovetail::expressions
