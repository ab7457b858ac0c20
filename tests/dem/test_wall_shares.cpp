// Contacts that act with a share of what they remember: in valleys of a wall, and of particles that are modelled in
// part. What a spring loses as its share falls is in the books.
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
  law.tangential = {.stiffness = 8e3, .friction = 0.6};
  return law;
}

/// Largest |residual| of the books at any of the looks, over the energy at the start.
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

/// A ball with spin that bounces along a valley of two slopes, and touches both in its middle.
double throughAValley(double dt) {
  Model m;
  m.laws = makeContactLaws(sticky());
  addWall(m, MeshWall{}).wall =
      makeWall({{-2, -1, 0.8}, {0, -1, 0}, {0, 1, 0}, {-2, 1, 0.8}, {2, -1, 0.8}, {2, 1, 0.8}},
               {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}});
  m.gravity = {0, 0, -9.81};
  addParticle(m.particles, {-0.12, 0.01, 0.16}, {1.0, 0.2, 0.0}, 0.1, Mass{0.2});
  switchOnRotation(m.particles);
  m.particles.omega[0] = {1.0, 9.0, -3.0};
  return worstResidual(m, dt, 0.4);
}

TEST(WallShares, SpringsThatFadeOutInAValleyAreInTheBooksAtEveryLook) {
  const double coarse = throughAValley(2e-5), fine = throughAValley(1e-5);
  EXPECT_LT(fine, 2e-4);
  EXPECT_LT(fine, 0.6 * coarse);
}

TEST(WallShares, SpringsOfParticlesInPartEndWithTheirShare) {
  for (const bool mesh : {false, true}) {
    Model m;
    m.laws = makeContactLaws(sticky());
    if (mesh)
      addWall(m, MeshWall{}).wall = makeWall({{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}, {{0, 1, 2}});
    else
      addWall(m, makePlane({}, {0, 0, 1}));
    addParticle(m.particles, {0, 0, 0.101}, {0.3, 0.0, -1.0}, 0.1, Mass{0.2});
    switchOnRotation(m.particles);
    m.particles.weight = {0.25};
    EXPECT_LT(worstResidual(m, 1e-5, 0.04), 1e-5) << mesh;
    EXPECT_GT(m.booked.lost.frictionPower, 1e-3 * energies(m).kinetic) << mesh;
  }
}

}  // namespace
}  // namespace dovetail::dem
