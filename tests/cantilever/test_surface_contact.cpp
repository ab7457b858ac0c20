#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/surface_contact.hpp"

namespace dovetail::cantilever {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr int modeCount = 12;
constexpr double stiffness = 4e7, radius = 0.1;

struct Variant {
  double lever;
  bool largeRotations, shear;
};

class BeamContact : public ::testing::TestWithParam<Variant> {
protected:
  BeamContact()
      : table(computeModes(makeSection(BeamCase{}), 12.0, {.shear = GetParam().shear, .basis = 30}, modeCount), 300,
              GetParam().largeRotations),
        contact(table, {.height = 0.4, .lever = GetParam().lever}, stiffness, radius) {}

  // Slopes of a few per cent, and a centre 0.1 … 1 mm inside the surface's reach (or outside, for a gap).
  void randomState(double depth) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> along(0.3, 11.7);
    q.resize(modeCount);
    for (int j = 0; j < modeCount; ++j) q[j] = 8.0 / ((j + 1.0) * (j + 1.0)) * normal(generator);
    centre = {along(generator), 0.0};
    state.position = centre[0];
    // lowers the sphere until it overlaps by the depth wanted
    double lower = surfaceHeight(), upper = lower + 0.3;
    for (int i = 0; i < 60; ++i) {
      centre[1] = 0.5 * (lower + upper);
      (evaluate(centre, q).overlap > depth ? lower : upper) = centre[1];
    }
  }
  double surfaceHeight() {
    BeamCell cell;
    table.loadCell(centre[0], q, cell);
    return 0.4 + table.fields(cell, centre[0]).vertical[0];
  }
  SphereContact evaluate(const Vector2d& x, const VectorXd& amplitudes) {
    SphereContact result;
    result.position = state.position;
    contact.update(x, amplitudes, result);
    return result;
  }

  std::mt19937 generator{7};
  ModeTable table;
  BeamSurfaceContact contact;
  Vector2d centre;
  VectorXd q;
  SphereContact state;
};

TEST_P(BeamContact, ForcesAreMinusTheGradientOfThePotential) {
  std::uniform_real_distribution<double> depth(1e-4, 1e-3);
  for (int trial = 0; trial < 20; ++trial) {
    randomState(depth(generator));
    const SphereContact here = evaluate(centre, q);
    ASSERT_GT(here.energy, 0.0);
    const double scale = here.force.norm(), h = 1e-6;
    for (int c = 0; c < 2; ++c) {
      const Vector2d step = h * Vector2d::Unit(c);
      const double slope = (evaluate(centre + step, q).energy - evaluate(centre - step, q).energy) / (2.0 * h);
      EXPECT_NEAR(here.force[c], -slope, 1e-6 * scale);
    }
    for (int j = 0; j < modeCount; ++j) {
      const VectorXd step = 50.0 * h * VectorXd::Unit(modeCount, j);  // modes are of the order of 0.02
      const double slope = (evaluate(centre, q + step).energy - evaluate(centre, q - step).energy) / (100.0 * h);
      EXPECT_NEAR(here.modalForce[j], -slope, 1e-6 * 0.02 * scale) << "mode " << j + 1;
    }
  }
}

TEST_P(BeamContact, AGapCarriesNoForce) {
  for (int trial = 0; trial < 5; ++trial) {
    randomState(-1e-5);
    const SphereContact here = evaluate(centre, q);
    EXPECT_NEAR(here.overlap, -1e-5, 1e-9);
    EXPECT_EQ(here.energy, 0.0);
    EXPECT_EQ(here.force.norm(), 0.0);
    EXPECT_EQ(here.modalForce.norm(), 0.0);
  }
}

TEST_P(BeamContact, BeyondTheFreeEndTheEndItselfIsClosest) {
  q.setZero(modeCount);
  state.position = 11.9;
  const SphereContact here = evaluate({12.05, 0.45}, q);
  EXPECT_EQ(here.position, 12.0);
  EXPECT_NEAR(here.overlap, radius - std::sqrt(0.05 * 0.05 * 2.0), 1e-14);
  EXPECT_NEAR(here.force[0], here.force[1], 1e-9 * here.force[1]);
}

INSTANTIATE_TEST_SUITE_P(Variants, BeamContact,
                         ::testing::Values(Variant{0.0, false, false}, Variant{0.4, false, true},
                                           Variant{0.0, true, true}, Variant{0.4, true, true}));

}  // namespace
}  // namespace dovetail::cantilever
