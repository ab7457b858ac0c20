#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/expressions/expressions.hpp"

namespace dovetail::expressions {
namespace {

std::string messageOf(const std::string& expression) {
  try {
    timeFunction(expression);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Expressions, AreFunctionsOfTime) {
  const auto f = timeFunction("2*sin(t) + (t > 1 ? pi : 0)");
  EXPECT_DOUBLE_EQ(f(0.5), 2.0 * std::sin(0.5));
  EXPECT_DOUBLE_EQ(f(2.0), 2.0 * std::sin(2.0) + std::acos(-1.0));
  const auto copy = f;
  EXPECT_DOUBLE_EQ(copy(0.5), f(0.5));
}

TEST(Expressions, AreFunctionsOfPlace) {
  EXPECT_DOUBLE_EQ(fieldFunction("x*y - z*t")({2.0, 3.0, 4.0}, 0.5), 4.0);
  EXPECT_EQ(vectorField({"x", "y + t", "0"})({2.0, 3.0, 4.0}, 0.5), (Vec3{2.0, 3.5, 0.0}));
}

TEST(Expressions, FaultsAreShownWhereTheyAre) {
  EXPECT_NE(messageOf("2*sin(t) + foo*t").find("\"2*sin(t) +  >>> foo*t\""), std::string::npos)
      << messageOf("2*sin(t) + foo*t");
  EXPECT_NE(messageOf("2*(t + 1").find("character"), std::string::npos) << messageOf("2*(t + 1");
  EXPECT_NE(messageOf(""), "");
  EXPECT_NE(messageOf("x + t"), "");
  EXPECT_NE(messageOf("t, 2*t"), "");
}

TEST(Expressions, ValuesThatAreNotFiniteAreCaught) {
  const auto f = timeFunction("log(t - 1)");
  EXPECT_DOUBLE_EQ(f(3.0), std::log(2.0));
  EXPECT_THROW(f(0.5), NumericalError);
}

TEST(Expressions, ConstantsHaveAValue) {
  EXPECT_EQ(value("2*radius^2 + min(a, b)", {{"radius", 3.0}, {"a", 1.0}, {"b", -1.0}}), 17.0);
  EXPECT_DOUBLE_EQ(value("sin(pi/2)", {}), 1.0);
  for (const char* wrong : {"", "t", "x", "2*r", "1/0", "sqrt(-1)", "1, 2", "1 = 2"})
    EXPECT_THROW(value(wrong, {{"a", 1.0}}), InputError) << wrong;
}

}  // namespace
}  // namespace dovetail::expressions
