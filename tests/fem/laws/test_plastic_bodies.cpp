#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "plasticity_scenes.hpp"

namespace dovetail::fem {
namespace {

TEST(PlasticTube, CarriesHillsLimitPressure) {
  for (const Tube& tube :
       {Tube{}, Tube{.formulation = Formulation::meanDilatation, .poissonRatio = 0.49},
        Tube{.formulation = Formulation::enhanced, .radial = 12, .around = 8},
        Tube{.shape = ElementShape::hex20, .formulation = Formulation::standard, .radial = 5, .around = 3},
        Tube{.shape = ElementShape::quad4},
        Tube{.shape = ElementShape::quad8, .formulation = Formulation::reduced, .radial = 5, .around = 3}}) {
    const TubeResult result = pressurise(tube);
    EXPECT_NEAR(result.pressure.back() / Tube::limitPressure(), 1.0, 0.01) << name(tube.formulation);
    for (std::size_t k = 1; k < result.pressure.size(); ++k)
      EXPECT_GE(result.pressure[k], result.pressure[k - 1] * (1.0 - 1e-4));
    EXPECT_LT(result.iterations, 6 * static_cast<std::int64_t>(result.pressure.size()));
  }
}

TEST(PlasticTube, ApproachesTheLimitWithTheSquareOfTheCellSize) {
  const auto error = [](int refinement) {
    const TubeResult result = pressurise(Tube{.radial = 4 * refinement, .around = 3 * refinement});
    return std::abs(result.pressure.back() / Tube::limitPressure() - 1.0);
  };
  EXPECT_NEAR(std::log2(error(1) / error(2)), 2.0, 0.3);
}

TEST(NeckingBar, CarriesConsideresForceAndThenNecks) {
  const NeckingResult result = stretch(NeckingBar{});
  double greatest = 0.0;
  for (const NeckingStep& step : result.steps) {
    greatest = std::max(greatest, step.force);
    const double area = std::numbers::pi * step.neckRadius * step.neckRadius;
    const double ratio = step.neckRadius / NeckingBar::radius;
    // Bridgman's stresses in a neck that is not deep, in which the flow stress is nearly even.
    if (ratio < 0.9 && ratio > 0.75) {
      EXPECT_NEAR(step.force / (area * step.flowStress), bridgmanFactor(step.neckRadius, step.neckCurve), 0.05);
    }
  }
  // The section of the neck bounds it from below, that of the ends from above.
  const double thin = 1.0 - NeckingBar::thinning;
  EXPECT_GT(greatest, thin * thin * NeckingBar::considereForce());
  EXPECT_LT(greatest, NeckingBar::considereForce());
  EXPECT_LT(result.steps.back().neckRadius, 0.45 * NeckingBar::radius);
  EXPECT_GT(result.steps.back().deepestStrain, 1.0);
  EXPECT_EQ(result.cuts, 0);
  EXPECT_LT(result.iterations, 5 * static_cast<std::int64_t>(result.steps.size()));
}

TEST(NeckingStrip, CarriesConsideresForceAndThenNecks) {
  for (const auto& [shape, formulation] :
       {std::pair{ElementShape::quad4, Formulation::meanDilatation}, {ElementShape::quad8, Formulation::reduced}}) {
    const StripResult result = stretch(NeckingStrip{.shape = shape, .formulation = formulation});
    double greatest = 0.0;
    for (const StripStep& step : result.steps) greatest = std::max(greatest, step.force);
    EXPECT_GT(greatest, (1.0 - NeckingBar::thinning) * NeckingStrip::considereForce()) << name(shape);
    EXPECT_LT(greatest, NeckingStrip::considereForce()) << name(shape);
    EXPECT_LT(result.steps.back().neckHalfWidth, 0.7 * NeckingStrip::halfWidth) << name(shape);
    EXPECT_EQ(result.cuts, 0) << name(shape);
  }
}

TEST(NeckingBar, WorkIsStoredOrDissipatedToFirstOrderOrBetter) {
  const auto residual = [](double step) {
    return std::abs(stretch(NeckingBar{.elongation = 4e-3, .largestStep = step}).energyResidual);
  };
  const double coarse = residual(0.4e-3), fine = residual(0.2e-3);
  EXPECT_LT(coarse, 3e-3);
  EXPECT_LT(fine, 0.6 * coarse);
}

}  // namespace
}  // namespace dovetail::fem
