// Quaternions as rotations, and points and weights of integrals.
#include <gtest/gtest.h>

#include "dovetail/core/quadrature.hpp"
#include "dovetail/core/quaternion.hpp"

namespace dovetail {
namespace {

Quaternion randomTurn(std::mt19937_64& random) {
  std::normal_distribution<double> n;
  return normalized(Quaternion{n(random), n(random), n(random), n(random)});
}

TEST(Quaternion, ProductsTurnOneAfterTheOtherAndKeepLengthsAndAngles) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> n;
  for (int round = 0; round < 100; ++round) {
    const Quaternion p = randomTurn(random), q = randomTurn(random);
    const Vec3 a{n(random), n(random), n(random)}, b{n(random), n(random), n(random)};
    EXPECT_LE(norm(rotate(p * q, a) - rotate(p, rotate(q, a))), 1e-14);
    EXPECT_LE(norm(rotateBack(p, rotate(p, a)) - a), 1e-14);
    EXPECT_NEAR(dot(rotate(p, a), rotate(p, b)), dot(a, b), 1e-13);
    EXPECT_LE(norm(cross(rotate(p, a), rotate(p, b)) - rotate(p, cross(a, b))), 1e-13);
  }
}

TEST(Quaternion, RotationVectorsTurnCounterClockwiseByTheirLength) {
  const double angle = 0.7;
  EXPECT_LE(norm(rotate(fromRotationVector({0, 0, angle}), {1, 0, 0}) - Vec3{std::cos(angle), std::sin(angle), 0}),
            1e-15);
  EXPECT_EQ(fromRotationVector({}), Quaternion{});
  const Vec3 tiny{1e-9, -2e-9, 3e-9}, a{1, 2, 3};
  EXPECT_LE(norm(rotate(fromRotationVector(tiny), a) - a - cross(tiny, a)), 1e-15);
  const Quaternion half = fromRotationVector({0.1, 0.2, -0.3});
  EXPECT_NEAR(norm(half), 1.0, 1e-15);
  EXPECT_LE(norm(rotate(half * half, a) - rotate(fromRotationVector({0.2, 0.4, -0.6}), a)), 1e-14);
}

TEST(Quadrature, GaussLegendreIsExactForPolynomials) {
  for (const int n : {1, 2, 5, 24, 48}) {
    const auto rule = gaussLegendre(n);
    for (int power = 0; power < 2 * n; ++power) {
      double sum = 0.0;
      for (const auto& [x, weight] : rule) sum += weight * std::pow(x, power);
      EXPECT_NEAR(sum, power % 2 == 0 ? 2.0 / (power + 1) : 0.0, 1e-13) << n << " " << power;
    }
  }
}

TEST(Quadrature, RootsAtTheEventsAreNoTrouble) {
  const auto rule = gaussLegendre(24);
  const std::vector<double> events{-1.0, 0.5, 0.5, 2.0};
  double sum = 0.0;  // of √(1 + z) below 0.5, and of √(z − 0.5) (2 − z)^(3/2) above
  integrateBetween(events, rule, [&](double z, double weight) {
    sum += weight * (z < 0.5 ? std::sqrt(1.0 + z) : std::sqrt(z - 0.5) * std::pow(2.0 - z, 1.5));
  });
  const double beta = std::tgamma(1.5) * std::tgamma(2.5) / std::tgamma(4.0);
  EXPECT_NEAR(sum, 2.0 / 3.0 * std::pow(1.5, 1.5) + std::pow(1.5, 3.0) * beta, 1e-13);
}

}  // namespace
}  // namespace dovetail
