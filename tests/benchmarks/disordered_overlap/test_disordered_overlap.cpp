// What the benchmark of random packings makes of a packing.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/relax.hpp"
#include "moduli.hpp"
#include "stress.hpp"

namespace dovetail::disordered_overlap {
namespace {

/// First Piola–Kirchhoff stress (P_xz, P_zz) of the solid with u = (γ z, 0, (F − 1) z), Pa.
std::array<double, 2> stressOf(const Elastic& e, double gamma, double F) {
  const double shear = e.young / (2.0 * (1.0 + e.poisson));
  const double axial = 2.0 * shear * (1.0 - e.poisson) / (1.0 - 2.0 * e.poisson);
  const double Ezz = 0.5 * (F * F + gamma * gamma - 1.0), Szz = axial * Ezz, Sxz = shear * gamma;  // E_xz = γ/2
  return {Sxz + gamma * Szz, F * Szz};
}

TEST(BedModuli, TheSolidUnderItsPressureHasThePackingsTangentsAndDensity) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int k = 0; k < 20; ++k) {
    Moduli m{};
    m.axial = 1e6 * (1.0 + 9.0 * unit(random));
    m.shear = m.axial * (0.2 + 0.2 * unit(random));
    m.pressure = m.axial * 0.02 * unit(random);
    m.density = 1500.0;
    const Elastic e = solidOf(m);
    const double F = e.density / m.density, h = 1e-6;
    EXPECT_NEAR(stressOf(e, 0.0, F)[1], -m.pressure, 1e-9 * m.axial);
    // Per height as it is now, which is F times that of the reference.
    EXPECT_NEAR(F * (stressOf(e, 0.0, F + h)[1] - stressOf(e, 0.0, F - h)[1]) / (2.0 * h), m.axial, 1e-7 * m.axial);
    EXPECT_NEAR(F * (stressOf(e, h, F)[0] - stressOf(e, -h, F)[0]) / (2.0 * h), m.shear, 1e-7 * m.shear);
  }
}

TEST(BedColumn, APressedColumnIsAtRestUnderItsPressureAndBearsTheSameOnBothEnds) {
  const dem::Model column = pressedColumn({.width = 4.0 * grain::diameter, .height = 8.0 * grain::diameter}, 1e4);
  EXPECT_LT(dem::restOf(column).residual, 2e-6);
  const double area = widthOf(column) * widthOf(column);
  const double lid = dem::primitiveWall(column, lidOfPressed).force.z / area;
  EXPECT_NEAR(lid, 1e4, 4e3);
  EXPECT_NEAR(dem::primitiveWall(column, floorOfPressed).force.z / area, -lid, 1e-4 * lid);
  const Moduli moduli = probe(column);
  EXPECT_GT(moduli.axial, moduli.shear);
  EXPECT_GT(moduli.shear, 0.1 * grain::stiffness / grain::diameter);
}

// Shaken down, it is as stiff under a push as under a pull; monotonic pressing alone leaves it softer for a push.
TEST(BedColumn, AColumnPressedWithFrictionAndShakenDownIsAsStiffBothWays) {
  const ColumnSize size{.width = 4.0 * grain::diameter, .height = 8.0 * grain::diameter};
  const dem::Model column = columnPressedWithFriction(size, 1e4);
  EXPECT_LT(dem::restOf(column).residual, 2e-6);
  const double lid = dem::primitiveWall(column, lidOfPressed).force.z / (widthOf(column) * widthOf(column));
  EXPECT_NEAR(lid, 1e4, 1e3);
  const Moduli pull = probe(column, 2e-5), push = probe(column, -2e-5);
  EXPECT_NEAR(push.axial, pull.axial, 0.03 * pull.axial);
  EXPECT_NEAR(push.shear, pull.shear, 0.03 * pull.shear);
}

TEST(BedStress, WeightAboveIsThatOfTheGrainsAbove) {
  dem::Particles p;
  for (const double z : {0.1, 0.35, 0.6}) dem::addParticle(p, {0, 0, z}, {}, 0.05, dem::Mass{2.0});
  EXPECT_NEAR(weightAbove(p, 2.0, 0.2, 0.5), standardGravity * (0.5 * 2.0 + 2.0) / 4.0, 1e-12);
}

}  // namespace
}  // namespace dovetail::disordered_overlap
