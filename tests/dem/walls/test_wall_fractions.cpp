// Contacts that act with a fraction of what they remember: in valleys of a wall, and of particles that are modelled in
// part. What a spring loses as its fraction falls is in the ledger.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"

namespace dovetail::dem {
namespace {

ContactLaw<LinearSpringDashpot, TangentialSpring> sticky() {
  ContactLaw<LinearSpringDashpot, TangentialSpring> law;
  law.normal = {.stiffness = 1e4};
  law.tangential = {.stiffness = 100.0, .friction = 5.0};
  return law;
}

/// Largest |residual| of the ledger at any of the looks, over the energy at the start.
double worstResidual(Model& m, double dt, double duration) {
  findForces(m);
  const double start = energies(m).balance(), size = energies(m).kinetic;
  double worst = 0.0;
  for (int look = 0; look < 400; ++look) {
    run(m, dt, static_cast<std::int64_t>(duration / dt / 400.0 + 0.5));
    worst = std::max(worst, std::abs(energies(m).balance() - start) / size);
  }
  return worst;
}

/// A ball that lies in a valley and is kicked up its slopes: contacts fade out and in while their springs are
/// stretched.
double inAValley(double dt) {
  Model m;
  m.laws = makeContactLaws(sticky());
  addWall(m, MeshWall{}).wall =
      makeWall({{-2, -1, 0.8}, {0, -1, 0}, {0, 1, 0}, {-2, 1, 0.8}, {2, -1, 0.8}, {2, 1, 0.8}},
               {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}});
  m.gravity = {0, 0, -9.81};
  addParticle(m.particles, {0.0, 0.01, 0.1 * std::sqrt(1.16) - 2e-4}, {0.3, 0.02, 0.0}, 0.1, Mass{0.2});
  switchOnRotation(m.particles);
  return worstResidual(m, dt, 0.4);
}

TEST(WallShares, SpringsThatFadeOutInAValleyAreInTheBooksAtEveryLook) {
  const double coarse = inAValley(2e-5), fine = inAValley(1e-5);
  EXPECT_LT(fine, 2e-5);
  EXPECT_LT(fine, 0.7 * coarse);
}

TEST(WallShares, SpringsOfParticlesInPartLeaveWithTheirShare) {
  for (const bool mesh : {false, true}) {
    Model m;
    m.laws = makeContactLaws(sticky());
    if (mesh)
      addWall(m, MeshWall{}).wall = makeWall({{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}, {{0, 1, 2}});
    else
      addWall(m, makePlane({}, {0, 0, 1}));
    m.gravity = {0, 0, -9.81};
    addParticle(m.particles, {0, 0, 0.1 - 0.2 * 9.81 / 1e4}, {0.3, 0.0, 0.0}, 0.1, Mass{0.2});
    addParticle(m.particles, {5, 0, 5}, {}, 0.1, Mass{0.2});
    switchOnRotation(m.particles);
    m.particles.weight = {0.25, 1.0};
    findForces(m);
    run(m, 1e-5, 1500);
    const Energies before = energies(m);
    const double stretched = m.work.tangentialEnergy;
    EXPECT_GT(stretched, 1e-4) << mesh;
    removeParticles(m, std::vector<int>{0});
    run(m, 1e-5, 10);
    EXPECT_NEAR(energies(m).balance(), before.balance(), 1e-6 * stretched) << mesh;
    EXPECT_EQ(m.booked.lost.frictionPower, before.lost.frictionPower) << mesh;
  }
}

}  // namespace
}  // namespace dovetail::dem
