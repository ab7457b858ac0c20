#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/report/curve_error.hpp"

namespace dovetail::report {
namespace {

const Curve line{"line", {0.0, 1.0, 4.0}, {1.0, 3.0, 9.0}};  // 1 + 2 x

Curve onLine(const std::vector<double>& x, const std::vector<double>& apart) {
  Curve curve{"run", x, {}};
  for (std::size_t k = 0; k < x.size(); ++k) curve.y.push_back(1.0 + 2.0 * x[k] + apart[k]);
  return curve;
}

TEST(CurveError, IsNoneOnTheReferenceWhateverThePoints) {
  const Curve curve = onLine({0.0, 0.3, 1.0, 2.7, 4.0}, {0, 0, 0, 0, 0});
  for (const Norm norm : {Norm::mean, Norm::largest, Norm::end}) {
    const CurveError error = distanceFrom(line, curve, norm);
    EXPECT_NEAR(error.value, 0.0, 1e-14);
    EXPECT_EQ(error.covered, 1.0);
  }
}

TEST(CurveError, OfAShiftIsTheShiftInEveryNorm) {
  const Curve curve = onLine({1.0, 1.1, 3.0}, {-0.25, -0.25, -0.25});
  EXPECT_NEAR(distanceFrom(line, curve, Norm::mean).value, 0.25, 1e-14);
  EXPECT_NEAR(distanceFrom(line, curve, Norm::largest).value, 0.25, 1e-14);
  EXPECT_NEAR(distanceFrom(line, curve, Norm::end).value, -0.25, 1e-14);
  EXPECT_EQ(distanceFrom(line, curve, Norm::end).covered, 0.5);
}

TEST(CurveError, MeanIsTheIntegralHoweverPointsAreSpread) {
  // d = x/4 over 0 … 4 in steps of 0.001 on one half and 0.002 on the other: mean square 1/3.
  std::vector<double> x, apart;
  for (int k = 0; k <= 2000; ++k) x.push_back(0.001 * k);
  for (int k = 1; k <= 1000; ++k) x.push_back(2.0 + 0.002 * k);
  for (const double at : x) apart.push_back(0.25 * at);
  EXPECT_NEAR(distanceFrom(line, onLine(x, apart), Norm::mean).value, std::sqrt(1.0 / 3.0), 1e-6);
}

TEST(CurveError, FollowsCurvesThatTurnBackAndLeavesOutWhatIsBeyond) {
  // Out to 2 and back to 1, d = 1 on the way back; then beyond the range, where nothing is known.
  const Curve curve = onLine({0.0, 2.0, 2.0, 1.0, 5.0, -1.0}, {0, 0, 1, 1, 50, 50});
  EXPECT_NEAR(distanceFrom(line, curve, Norm::mean).value, std::sqrt(1.0 / 3.0), 1e-14);
  EXPECT_NEAR(distanceFrom(line, curve, Norm::largest).value, 1.0, 1e-14);
  EXPECT_NEAR(distanceFrom(line, curve, Norm::end).value, 1.0, 1e-14);
  EXPECT_EQ(distanceFrom(line, curve, Norm::mean).covered, 0.5);
}

TEST(CurveError, RelativeIsTheMeanOverThatOfTheReference) {
  const Curve reference{"reference", {0, 1, 3, 4}, {1, 2, -1, 0}};
  Curve scaled = reference, none = reference;
  for (double& y : scaled.y) y *= 1.25;
  for (double& y : none.y) y = 0.0;
  EXPECT_NEAR(distanceFrom(reference, scaled, Norm::relative).value, 0.25, 1e-15);
  EXPECT_NEAR(distanceFrom(reference, none, Norm::relative).value, 1.0, 1e-15);
  EXPECT_NEAR(distanceFrom(reference, scaled, Norm::mean).value, 0.25 * distanceFrom(reference, none, Norm::mean).value,
              1e-15);
  EXPECT_THROW((void)distanceFrom(none, reference, Norm::relative), InputError);
}

TEST(CurveError, MeanOfCurvesLiesBetweenThemWhereAllAre) {
  const Curve first{"a", {0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}}, second{"b", {0.5, 4.5}, {1.5, 5.5}};
  const Curve mean = meanOf({first, second});
  EXPECT_EQ(mean.x, (std::vector<double>{1, 2, 3, 4}));
  for (std::size_t k = 0; k < mean.x.size(); ++k) EXPECT_NEAR(mean.y[k], mean.x[k] + 0.5, 1e-15);
  EXPECT_THROW((void)meanOf({first, Curve{"c", {10, 11}, {0, 0}}}), InputError);
  EXPECT_THROW((void)meanOf({}), InputError);
}

TEST(CurveError, RefusesWhatIsNoReference) {
  const Curve run = onLine({0.0, 1.0}, {0, 0});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Curve& bad : {Curve{"short", {1.0}, {1.0}}, Curve{"back", {0.0, 1.0, 0.5}, {1.0, 1.0, 1.0}},
                           Curve{"again", {0.0, 0.0}, {1.0, 2.0}}, Curve{"hole", {0.0, 1.0}, {1.0, nan}}})
    EXPECT_THROW(distanceFrom(bad, run, Norm::mean), InputError) << bad.name;
  EXPECT_THROW(distanceFrom(line, onLine({5.0, 6.0}, {0, 0}), Norm::largest), InputError);
  EXPECT_THROW(distanceFrom(line, onLine({4.0, 6.0}, {0, 0}), Norm::mean), InputError);
  EXPECT_NO_THROW(distanceFrom(line, onLine({4.0, 6.0}, {0, 0}), Norm::end));
}

}  // namespace
}  // namespace dovetail::report
