// Least squares with bounds, against what is known in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/calibration/fit.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/setup/random_stream.hpp"

namespace dovetail::calibration {
namespace {

const std::vector<FitParameter> line{{"a", 0.0, -10.0, 10.0}, {"b", 1.0, -5.0, 5.0}};

TEST(Fit, OfAStraightLineIsTheClosedForm) {
  dem::RandomStream random(5);
  for (int trial = 0; trial < 10; ++trial) {
    const double sigma = random.uniform(0.1, 2.0);
    std::vector<double> t, y;
    double n = 0.0, st = 0.0, stt = 0.0, sy = 0.0, sty = 0.0;
    for (int k = 0; k < 12; ++k) {
      t.push_back(random.uniform(0.0, 5.0));
      y.push_back(1.5 - 0.7 * t[k] + sigma * random.normal());
      n += 1.0, st += t[k], stt += t[k] * t[k], sy += y[k], sty += t[k] * y[k];
    }
    const double det = n * stt - st * st, b = (n * sty - st * sy) / det, a = (sy - b * st) / n;
    const FitResult found = fit(line, 12,
                                [&](std::span<const double> p, std::span<double> r) {
                                  for (std::size_t k = 0; k < t.size(); ++k) r[k] = (p[0] + p[1] * t[k] - y[k]) / sigma;
                                  return true;
                                },
                                {.tolerance = 1e-14});
    EXPECT_TRUE(found.converged) << found.message;
    EXPECT_NEAR(found.value[0], a, 1e-6);
    EXPECT_NEAR(found.value[1], b, 1e-6);
    const double worse = std::max(1.0, std::sqrt(found.reducedChiSquared()));
    EXPECT_NEAR(found.uncertainty[0], worse * sigma * std::sqrt(stt / det), 1e-6);
    EXPECT_NEAR(found.uncertainty[1], worse * sigma * std::sqrt(n / det), 1e-6);
    EXPECT_NEAR(found.correlation[0][1], -st / std::sqrt(n * stt), 1e-6);
    EXPECT_EQ(found.freedom, 10);
    EXPECT_FALSE(found.atBound[0]);
  }
}

TEST(Fit, EndsAtABoundAndSaysSo) {
  const std::vector<FitParameter> one{{"p", 0.5, 0.0, 1.0}};
  const FitResult found = fit(one, 1, [](std::span<const double> p, std::span<double> r) {
    r[0] = p[0] - 3.0;
    return true;
  });
  EXPECT_DOUBLE_EQ(found.value[0], 1.0);
  EXPECT_TRUE(found.atBound[0]);
}

TEST(Fit, GoesRoundPlacesThatCannotBeEvaluated) {
  const std::vector<FitParameter> one{{"p", 0.1, 0.0, 1.0}};
  const FitResult found = fit(one, 1,
                              [](std::span<const double> p, std::span<double> r) {
                                r[0] = std::log(p[0] / 0.6);  // the first step leads beyond 1
                                return p[0] < 0.95;
                              },
                              {.tolerance = 1e-8});
  EXPECT_NEAR(found.value[0], 0.6, 1e-4);
}

TEST(Fit, TellsParametersThatTargetsDoNotKnow) {
  const FitResult found = fit(line, 2, [](std::span<const double> p, std::span<double> r) {
    r[0] = p[0] - 1.0;
    r[1] = 2.0 * (p[0] - 1.0);
    return true;
  });
  EXPECT_TRUE(std::isinf(found.uncertainty[1]));
}

TEST(Fit, NeedsFewEvaluationsAndHandsOnWhatIsThrown) {
  int asked = 0;
  const std::vector<FitParameter> one{{"p", 0.1, 0.0, 1.0}};
  const auto evaluate = [&](std::span<const double> p, std::span<double> r) {
    ++asked;
    r[0] = 1e3 * (p[0] - 0.9);
    return true;
  };
  fit(one, 1, evaluate);
  EXPECT_LE(asked, 12);
  EXPECT_THROW(fit(one, 1, [](auto, auto) -> bool { throw InputError("no", "", ""); }), InputError);
  EXPECT_THROW(fit(line, 1, evaluate), InputError);
  EXPECT_THROW(fit(std::vector<FitParameter>{{"p", 2.0, 0.0, 1.0}}, 1, evaluate), InputError);
  EXPECT_TRUE(fit(one, 1, evaluate, {.stop = [] { return true; }}).stopped);
}

}  // namespace
}  // namespace dovetail::calibration
