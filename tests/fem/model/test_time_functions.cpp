#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/model/time_functions.hpp"

namespace dovetail::fem {
namespace {

TEST(TimeFunctions, HaveTheirValuesAndStayAtTheirEnds) {
  EXPECT_EQ(constant(3.0)(7.0), 3.0);
  EXPECT_EQ(ramp(2.0, 8.0)(-1.0), 0.0);
  EXPECT_DOUBLE_EQ(ramp(2.0, 8.0)(0.5), 2.0);
  EXPECT_EQ(ramp(2.0, 8.0)(5.0), 8.0);
  EXPECT_DOUBLE_EQ(smoothRamp(2.0, 8.0)(1.0), 4.0);
  EXPECT_DOUBLE_EQ(smoothRamp(2.0, 8.0)(3.0), 8.0);
  EXPECT_DOUBLE_EQ(halfSine(2.0, 8.0)(1.0), 8.0);
  EXPECT_EQ(halfSine(2.0, 8.0)(2.1), 0.0);
  EXPECT_DOUBLE_EQ(sine(0.25, 8.0, 0.5)(1.0), 8.0 * std::sin(0.5 * std::numbers::pi + 0.5));
}

TEST(TimeFunctions, TablesInterpolateLinearly) {
  const TimeFunction f = table({{1.0, 10.0}, {2.0, 20.0}, {4.0, 0.0}});
  EXPECT_EQ(f(0.0), 10.0);
  EXPECT_DOUBLE_EQ(f(1.5), 15.0);
  EXPECT_EQ(f(2.0), 20.0);
  EXPECT_DOUBLE_EQ(f(3.5), 5.0);
  EXPECT_EQ(f(4.0), 0.0);
  EXPECT_EQ(f(9.0), 0.0);
}

TEST(TimeFunctions, BadInputIsRefused) {
  EXPECT_THROW(ramp(0.0, 1.0), InputError);
  EXPECT_THROW(halfSine(-1.0, 1.0), InputError);
  EXPECT_THROW(table({}), InputError);
  EXPECT_THROW(table({{0.0, std::nan("")}}), InputError);
  EXPECT_THROW(Amplitude(TimeFunction{}), InputError);
  try {
    table({{0.0, 1.0}, {2.0, 1.0}, {2.0, 3.0}});
    ADD_FAILURE() << "a table that does not ascend was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("entry 2"), std::string::npos);
  }
}

TEST(TimeFunctions, AmplitudesAreNumbersOrFunctions) {
  const Amplitude number = 2.0, function = [](double t) { return 3.0 * t; }, named = ramp(1.0, 4.0);
  EXPECT_TRUE(number.isConstant());
  EXPECT_FALSE(function.isConstant());
  EXPECT_EQ(number(5.0), 2.0);
  EXPECT_EQ(function(5.0), 15.0);
  EXPECT_EQ(named(5.0), 4.0);
}

}  // namespace
}  // namespace dovetail::fem
