// Softening with the energy of gradients beside closed forms.
#include <gtest/gtest.h>

#include "band_biaxial.hpp"
#include "band_layer.hpp"
#include "soft_sand.hpp"

namespace dovetail::benchmark {
namespace {

constexpr SoftLayer layer{};

TEST(Bands, OfASoftLayerHaveTheExactSlopeAndWidth) {
  const Band exact = exactBand(layer);
  for (const fem::ElementShape shape : {fem::ElementShape::quad4, fem::ElementShape::quad8}) {
    const Band ten = bandOfElements(layer, shape, 10), twenty = bandOfElements(layer, shape, 20);
    EXPECT_NEAR(ten.opening, exact.opening, 0.02 * exact.opening) << fem::name(shape);
    EXPECT_NEAR(ten.width, exact.width, 0.05 * exact.width) << fem::name(shape);
    EXPECT_NEAR(twenty.opening, exact.opening, 0.006 * exact.opening) << fem::name(shape);
  }
}

TEST(Bands, AreAsWideAsTheRootOfTheModulus) {
  SoftLayer stiffer = layer;
  stiffer.modulus *= 10.0;
  EXPECT_NEAR(exactBand(stiffer).width, std::sqrt(10.0) * exactBand(layer).width, 1e-12);
  const Band one = bandOfElements(layer, fem::ElementShape::quad8, 10),
             ten = bandOfElements(stiffer, fem::ElementShape::quad8, 10);
  EXPECT_NEAR(ten.width, std::sqrt(10.0) * one.width, 1e-6 * ten.width);
}

// ---- sand that softens, pressed together, 6 × 12 and 9 × 18 quad8, before its residual strength

constexpr double wide = 360.0;  // N: bands of 0.48 m

BiaxialCourse pressed(int across, double modulus) {
  return pressTogether({.across = across, .modulus = modulus, .end = 0.03}, {{softSand({})}});
}

TEST(Bands, OfPressedSandAreThoseOfEveryMeshWithTheGradientAlone) {
  const BiaxialCourse local[] = {pressed(6, 0.0), pressed(9, 0.0)};
  const BiaxialCourse with[] = {pressed(6, wide), pressed(9, wide)};
  for (const BiaxialCourse& course : {local[0], local[1], with[0], with[1]}) {
    ASSERT_EQ(course.looks.size(), 3U);
    EXPECT_EQ(course.broken, 0.0);
    EXPECT_LT(course.residual, 1e-6);
  }
  const auto apart = [](const BiaxialCourse(&of)[2], std::size_t k, double BandLook::*value) {
    return std::abs(of[0].looks[k].*value - of[1].looks[k].*value);
  };
  for (const std::size_t percent : {2, 3}) {
    const double kept = apart(with, percent - 1, &BandLook::axial);
    EXPECT_LT(kept, 0.6e3) << percent << " %";
    EXPECT_GT(apart(local, percent - 1, &BandLook::axial), 8.0 * kept) << percent << " %";
  }
  EXPECT_LT(apart(with, 2, &BandLook::fraction), 0.1 * with[0].looks[2].fraction);
  EXPECT_LT(local[1].looks[2].fraction, 0.7 * local[0].looks[2].fraction);
}

}  // namespace
}  // namespace dovetail::benchmark
