#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "dovetail/core/clock.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/progress.hpp"

namespace dovetail {
namespace {

TEST(Finite, NamesTheFirstItemThatIsNotFinite) {
  std::vector<Vec3> velocity(10);
  EXPECT_NO_THROW(requireFinite(velocity, "particle", "velocity", "t = 0 s"));
  velocity[7].y = std::numeric_limits<double>::quiet_NaN();
  try {
    requireFinite(velocity, "particle", "velocity", "t = 0.5 s");
    FAIL() << "no error for a NaN";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("particle 7"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("t = 0.5 s"), std::string::npos);
  }
  velocity[7].y = -std::numeric_limits<double>::infinity();
  EXPECT_THROW(requireFinite(velocity, "particle", "velocity", ""), NumericalError);
}

TEST(Finite, NumbersAreCheckedByName) {
  EXPECT_EQ(requirePositive(2.0, "mass"), 2.0);
  EXPECT_THROW(requirePositive(0.0, "mass"), InputError);
  EXPECT_THROW(requirePositive(std::numeric_limits<double>::infinity(), "mass"), InputError);
  EXPECT_THROW(requireNonNegative(-1e-300, "width"), InputError);
  EXPECT_EQ(requireNonNegative(0.0, "width"), 0.0);
}

TEST(Finite, NumbersPrintShortAndExact) {
  EXPECT_EQ(formatNumber(0.1), "0.1");
  EXPECT_EQ(std::stod(formatNumber(1.0 / 3.0)), 1.0 / 3.0);
}

TEST(Clock, TimeIsStepsTimesDt) {
  Clock clock{.dt = 0.1, .substepsPerMacroStep = 3};
  for (int i = 0; i < 10; ++i) clock.advanceMacroStep();
  EXPECT_EQ(clock.time(), 30 * 0.1);
  EXPECT_DOUBLE_EQ(clock.coarseStep(), 0.3);
}

TEST(Progress, DurationsReadWell) {
  EXPECT_EQ(formatDuration(12.2), "12 s");
  EXPECT_EQ(formatDuration(185.0), "3 min 05 s");
  EXPECT_EQ(formatDuration(7800.0), "2 h 10 min");
}

}  // namespace
}  // namespace dovetail
