#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dovetail/core/error.hpp"
#include "dovetail/geometry/lattice.hpp"

namespace dovetail::geometry {
namespace {

Lattice randomLattice(std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  Lattice l;
  do
    for (Vec3& p : l.period) p = {u(random), u(random), u(random)};
  while (l.volume() < 0.05);
  return l;
}

TEST(Lattice, ReducedCoordinatesGoBackToPlaces) {
  std::mt19937 random(1);
  for (int k = 0; k < 20; ++k) {
    const Lattice l = randomLattice(random);
    const auto rows = inverse(l);
    const Vec3 x{0.3, -2.0, 5.0}, s{dot(rows[0], x), dot(rows[1], x), dot(rows[2], x)};
    EXPECT_LT(norm(l.position(s) - x), 1e-12);
    const Image n = periodOf(l, rows, x);
    for (int a = 0; a < 3; ++a) EXPECT_EQ(n[static_cast<std::size_t>(a)], static_cast<int>(std::floor(s[a])));
  }
}

TEST(Lattice, WidthsTimesFacesAreTheVolume) {
  std::mt19937 random(2);
  const Lattice l = randomLattice(random);
  const auto widths = l.widths();
  EXPECT_NEAR(widths[2] * norm(cross(l.period[0], l.period[1])), l.volume(), 1e-14);
}

TEST(Lattice, ReductionKeepsAllImagesAndLeavesNoSharpAngle) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> integer(-3, 3);
  for (int k = 0; k < 50; ++k) {
    Lattice l = randomLattice(random);
    l.period[1] += 7.0 * l.period[0];
    l.period[2] -= 4.0 * l.period[1];
    const Lattice before = l;
    const IntegerMatrix map = reduce(l);
    for (int m = 0; m < 5; ++m) {
      const Image n{integer(random), integer(random), integer(random)};
      EXPECT_LT(norm(l.shift(product(map, n)) - before.shift(n)), 1e-11);
    }
    EXPECT_NEAR(l.volume(), before.volume(), 1e-10);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) {
        if (a == b) continue;
        EXPECT_LE(std::abs(dot(l.period[a], l.period[b])), 0.5 * squaredNorm(l.period[a]) * (1.0 + 1e-8));
      }
  }
}

TEST(Lattice, ReductionLeavesAxesThatDoNotRepeat) {
  Lattice l{{Vec3{1, 0, 0}, Vec3{5, 1, 0}, Vec3{0, 0, 1}}, {true, false, false}};
  const Lattice before = l;
  EXPECT_EQ(reduce(l), sameImages);
  EXPECT_EQ(l, before);
}

TEST(Lattice, PeriodsInOnePlaneAreRefused) {
  const Lattice flat{{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{1, 1, 0}}};
  EXPECT_THROW(inverse(flat), InputError);
  EXPECT_THROW(inverse(Lattice{{Vec3{1, 0, 0}, Vec3{0, std::nan(""), 0}, Vec3{0, 0, 1}}}), InputError);
}

}  // namespace
}  // namespace dovetail::geometry
