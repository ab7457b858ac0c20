// A rotating drum whose grains resist rolling: what its wall puts in is stored or lost, and booked.
#include <gtest/gtest.h>

#include "dovetail/dem/model/walls.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

using RollingLaw = ContactLaw<LinearSpringDashpot, TangentialSpring, RollingAndTwisting>;

RollingLaw rollingLaw(double dashpots) {
  constexpr double k = 1e5;
  return {{.stiffness = k, .restitution = 0.5},
          {.stiffness = 0.8 * k, .friction = 0.5, .dampingRatio = dashpots},
          {{0.1, 0.1, dashpots}, {0.01, 0.1, dashpots}},
          {}};
}

/// Residual over the losses after a third of a turn.
double residual(const RollingLaw& law, double fraction) {
  Model model;
  model.laws = makeContactLaws(law);
  model.gravity = {0, 0, -9.81};
  model.pairs.setPeriodicity({{{-1, 0, -1}, {1, 0.3, 1}}, {false, true, false}});
  Random random(4);
  for (int i = 0; i < 120; ++i)
    addParticle(model.particles, {0.095 * (i % 8) - 0.33, 0.1 * (i / 8 % 3), -0.25 + 0.09 * (i / 24)},
                random.vector(0.1), random(0.035, 0.045), Density{2500.0});
  addWall(model, makeCylinder({}, {0, 1, 0}, 0.5)).angularVelocity = {0, 3.0, 0};
  findForces(model);
  const double dt = fraction * criticalStep(model, 1e-5).dt, start = energies(model).balance();
  run(model, dt, static_cast<std::int64_t>(0.7 / dt));
  const Energies e = energies(model);
  EXPECT_GT(e.lost.rollingPower, 0.05 * e.lost.lostPower());
  EXPECT_GT(e.walls, 50.0);
  return std::abs(e.balance() - start) / e.lost.lostPower();
}

TEST(Drum, WithRollingResistanceKeepsItsLedger) {
  for (const double dashpots : {0.0, 0.3}) {
    EXPECT_LE(residual(rollingLaw(dashpots), 0.2), 1e-3) << dashpots;
    EXPECT_LE(residual(rollingLaw(dashpots), 0.1), 2.5e-4) << dashpots;
  }
}

}  // namespace
}  // namespace dovetail::dem
