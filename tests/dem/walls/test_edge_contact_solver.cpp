#include <gtest/gtest.h>

#include <vector>

#include "dovetail/dem/walls/edge_contact_solver.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

/// Largest breach of λ ≥ 0, δ − Gλ ≤ 0 and λ (δ − Gλ) = 0.
double optimalityError(const std::vector<Fraction>& fractions) {
  double worst = 0.0;
  for (const Fraction& a : fractions) {
    double left = a.overlap - a.carried;
    for (const Fraction& b : fractions)
      if (&a != &b) left -= coupling(dot(a.normal, b.normal)) * b.carried;
    worst = std::max({worst, -a.carried, left, a.carried > 0.0 ? std::abs(left) : 0.0});
  }
  return worst;
}

TEST(EdgeContactSolver, SatisfiesTheOptimalityConditions) {
  Random random(1);
  for (int trial = 0; trial < 3000; ++trial) {
    std::vector<Fraction> fractions(static_cast<std::size_t>(1 + trial % 9));
    const double spread = random(0.05, 1.0);
    for (Fraction& s : fractions) {
      s.normal = normalized(Vec3{0, 0, 1} + random.vector(spread));
      s.overlap = random(-0.2, 1.0);
    }
    if (fractions.size() > 2) fractions[1] = fractions[0];  // the same edge seen by two facets
    EdgeContactSolver().solve(fractions, 1e-13);
    ASSERT_LE(optimalityError(fractions), 1e-9) << "trial " << trial;
  }
}

TEST(EdgeContactSolver, TwoWallsInClosedForm) {
  std::vector<Fraction> fractions(2);
  for (const double g : {0.3, 0.6, 0.9}) {
    fractions[0] = {{1, 0, 0}, 1.0, 0.0};
    fractions[1] = {{g, std::sqrt(1 - g * g), 0}, 0.95, 0.0};
    EdgeContactSolver().solve(fractions, 1e-13);
    EXPECT_NEAR(fractions[0].carried, (1.0 - 0.95 * g) / (1 - g * g), 1e-12);
    EXPECT_NEAR(fractions[1].carried, (0.95 - g) / (1 - g * g), 1e-12);
  }
}

TEST(EdgeContactSolver, NearlyParallelWallsStayBounded) {
  for (const double angle : {1e-3, 1e-5, 1e-7, 1e-9, 0.0}) {
    std::vector<Fraction> fractions{{{0, 0, 1}, 1.0, 0.0}, {{std::sin(angle), 0, std::cos(angle)}, 1.0, 0.0}};
    EdgeContactSolver().solve(fractions, 1e-13);
    EXPECT_NEAR(fractions[0].carried + fractions[1].carried, 1.0, 1e-6);
  }
}

TEST(EdgeContactSolver, TheCouplingHasAContinuousSlope) {
  for (double g = -0.3; g < 0.5; g += 0.0103) {
    const double h = 1e-6;
    EXPECT_NEAR((coupling(g + h) - coupling(g - h)) / (2 * h), couplingSlope(g), 1e-4);
    EXPECT_GE(coupling(g), 0.0);
  }
  EXPECT_EQ(coupling(couplingBlend), couplingBlend);
  EXPECT_EQ(couplingSlope(couplingBlend), 1.0);
}

}  // namespace
}  // namespace dovetail::dem
