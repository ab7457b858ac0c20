#include <gtest/gtest.h>

#include "footing_scene.hpp"

namespace dovetail::fem {
namespace {

/// Fraction of Prandtl's pressure that a footing carries.
double fraction(const Footing& footing) {
  const FootingResult result = settle(footing);
  EXPECT_EQ(result.cuts, 0);
  EXPECT_LT(result.iterations, 6 * static_cast<std::int64_t>(result.pressure.size()));
  for (std::size_t k = 1; k < result.pressure.size(); ++k)
    EXPECT_GT(result.pressure[k], result.pressure[k - 1] * (1.0 - 1e-6));
  return result.pressure.back() / footing.prandtlPressure();
}

TEST(Footing, CarriesPrandtlsPressureFromAbove) {
  // Displacements on a mesh are a mechanism of their own and bound the capacity from above; the singular edge makes it
  // first order in the cell size.
  for (const double angle : {0.0, 20.0}) {
    const double coarse =
        fraction({.friction = angle, .dilatancy = angle, .under = 2, .beside = 5, .deep = 5, .steps = 8});
    const double fine =
        fraction({.friction = angle, .dilatancy = angle, .under = 4, .beside = 10, .deep = 10, .steps = 8});
    EXPECT_GT(fine, 1.0);
    EXPECT_LT(fine, 1.07);
    EXPECT_LT(fine - 1.0, 0.6 * (coarse - 1.0));
  }
}

TEST(Footing, LessDilatancyCarriesLess) {
  const auto carried = [](double dilatancy) {
    return fraction({.dilatancy = dilatancy, .under = 2, .beside = 5, .deep = 5, .steps = 8});
  };
  EXPECT_LT(carried(10.0), carried(20.0));
}

}  // namespace
}  // namespace dovetail::fem
