// Softening with the energy of gradients beside closed forms.
#include <gtest/gtest.h>

#include "band_layer.hpp"

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

}  // namespace
}  // namespace dovetail::benchmark
