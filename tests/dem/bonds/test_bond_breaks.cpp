// Bonds that lose energy: their dashpots over whole kicks, and the contacts that wake up when they break.
#include <gtest/gtest.h>

#include "beam_scenes.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/loads.hpp"

namespace dovetail::dem {
namespace {

/// A bonded zigzag that oscillations under gravity; one end is held, or rods take the places of two spheres.
Model chain(bool held, bool rods) {
  Model model;
  model.laws = makeContactLaws(ElasticLaw{{1e2}});
  model.gravity = {0, 0, -9.81};
  model.pairs.setSkin(0.02);
  model.sortEvery = 0;
  for (int i = 0; i < 6; ++i) addParticle(model.particles, {0.11 * i, 0.02 * (i % 2), 0}, {}, 0.05, Mass{1.0});
  switchOnRotation(model.particles);
  BondMaterial material = unbreakable(1e6);
  material.dampingTime = 2e-4;
  for (int i = 0; i + 1 < 6; ++i) addBond(bonds(model), model.particles, {}, i, i + 1, material);
  model.particles.v[5] = {0.3, 0.5, -0.4};
  model.particles.omega[2] = {3, -2, 5};
  if (held)
    model.terms.add(DriveTerm(
        {0},
        [](double t) {
          return Vec3{0, 0, 0.02 * std::sin(30.0 * t)};
        },
        [](double t) {
          return Vec3{0, 0, 0.6 * std::cos(30.0 * t)};
        }));
  if (rods) {
    const ClumpShape rod =
        makeClumpShape(std::vector<Vec3>{{0, 0, 0}, {0.1, 0, 0}}, std::vector<double>{0.05, 0.05}, Density{1000.0});
    addClump(model, rod, {0.71, 0.02, 0}, {}, {}, {0, 4, 1});
    addBond(bonds(model), model.particles, {}, 5, 6, material);
  }
  return model;
}

/// Largest residual of the ledger over what was lost.
double residual(bool held, bool rods, double dt) {
  Model model = chain(held, rods);
  if (held) model.particles.v[0] = {0, 0, 0.6};
  const double start = energies(model).balance();
  double largest = 0.0;
  const auto steps = static_cast<int>(0.1 / dt + 0.5), sample = steps / 20;
  for (int s = 0; s < 20; ++s) {
    run(model, dt, sample);
    largest = std::max(largest, std::abs(energies(model).balance() - start));
  }
  const double lost = energies(model).lost.dissipatedPower;
  EXPECT_GT(lost, 0.02);
  return largest / lost;
}

TEST(BondDashpots, AreBookedAtSecondOrder) {
  for (const auto& [held, rods] : {std::pair{false, false}, {true, false}, {false, true}}) {
    const double coarse = residual(held, rods, 5e-5), middle = residual(held, rods, 2.5e-5),
                 fine = residual(held, rods, 1.25e-5);
    EXPECT_LE(fine, 1e-3) << held << rods;
    EXPECT_NEAR(coarse / middle, 4.0, 0.7) << held << rods;
    EXPECT_NEAR(middle / fine, 4.0, 0.7) << held << rods;
  }
}

/// Two overlapping spheres, bonded and muted, that run into one another and are sheared.
Model pressed(std::shared_ptr<const ContactLaws> laws = makeContactLaws(ElasticLaw{{1e4}})) {
  Model model;
  model.laws = std::move(laws);
  model.pairs.setSkin(0.02);
  for (int i = 0; i < 2; ++i)
    addParticle(model.particles, {0.098 * i, 0, 0}, {i == 0 ? 0.3 : -0.3, 0, 0}, 0.05, Mass{1.0});
  switchOnRotation(model.particles);
  BondMaterial material = unbreakable(1e5);
  addBond(bonds(model), model.particles, {}, 0, 1, material);
  model.particles.v[1].y = 0.2;
  model.terms.all<BondTerm>()[0]->mutesContacts = true;
  return model;
}

TEST(BrokenBonds, LeaveTheirCompressionToTheContactInThatVeryStep) {
  for (const double dt : {2e-5, 1e-5}) {
    Model model = pressed();
    const double start = energies(model).balance();
    const auto overlapNow = [&] { return 0.1 - norm(model.particles.x[1] - model.particles.x[0]); };
    while (overlapNow() < 0.004) {
      advance(model, dt);
      ASSERT_LT(model.steps, 10000);
      EXPECT_EQ(model.work.elasticEnergy, bonds(model).energy[0]);
    }
    bonds(model).bonds[0].shearStrength = 1e-3;
    advance(model, dt);
    ASSERT_EQ(bonds(model).size(), 0u);
    const double overlap = overlapNow();
    EXPECT_NEAR(norm(model.particles.f[0]), 1e4 * overlap, 1e-9);
    EXPECT_NEAR(model.work.elasticEnergy, 0.5 * 1e4 * overlap * overlap, 1e-12);
    close(model);
    const double drift = std::abs(energies(model).balance() - start);
    EXPECT_LE(drift, 1e-4 * energies(model).kinetic) << dt;
    run(model, dt, static_cast<std::int64_t>(0.1 / dt));
    const Energies e = energies(model);
    EXPECT_EQ(e.contacts, 0.0);  // they have parted
    EXPECT_NEAR(e.balance(), start, 1e-4 * e.kinetic);
    EXPECT_GT(dot(model.particles.v[1] - model.particles.v[0], model.particles.x[1] - model.particles.x[0]), 0.0);
  }
}

TEST(BrokenBonds, PayForTheDentsOfTheirContacts) {
  for (const double cohesion : {0.0, 1e3}) {
    Model model = pressed(makeContactLaws(ContactLaw<ElasticPlastic>{{1e4, 4e4, cohesion}}));
    const double start = energies(model).balance();
    run(model, 1e-5, 800);
    bonds(model).bonds[0].shearStrength = 1e-3;
    advance(model, 1e-5);
    ASSERT_EQ(bonds(model).size(), 0u);
    close(model);
    const Energies e = energies(model);
    const double overlap = 0.1 - norm(model.particles.x[1] - model.particles.x[0]);
    EXPECT_NEAR(e.lost.plasticPower, 0.5 * 7.5e3 * overlap * overlap, 1e-2 * e.lost.plasticPower) << cohesion;
    EXPECT_NEAR(e.balance(), start, 2e-3 * e.lost.plasticPower) << cohesion;
  }
}

TEST(BrokenBonds, OfAPairThatAnotherBondStillJoinsWakeNobody) {
  Model model = pressed();
  addBond(bonds(model), model.particles, {}, 0, 1, unbreakable(1e5));
  run(model, 2e-5, 20);
  bonds(model).bonds[0].shearStrength = 1e-3;
  advance(model, 2e-5);
  ASSERT_EQ(bonds(model).size(), 1u);
  EXPECT_TRUE(bonds(model).broken.empty());
  advance(model, 2e-5);
  ASSERT_EQ(model.pairs.size(), 1u);
  EXPECT_EQ(model.pairs.factors()[0], 0.0);
}

}  // namespace
}  // namespace dovetail::dem
