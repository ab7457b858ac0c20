// Bonds in scenes: their step, periods, threads, breakage in numbers, samples.
#include <gtest/gtest.h>

#include <filesystem>

#include "beam_scenes.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/model/loads.hpp"

namespace dovetail::dem {
namespace {

/// A straight column of equal spheres whose bonds are stiffest along it, under a law that is soft beside them.
Model column() {
  Model model;
  model.laws = makeContactLaws(ElasticLaw{{1e2}});
  model.pairs.setSkin(0.02);
  for (int i = 0; i < 60; ++i) addParticle(model.particles, {0.1 * i, 0, 0}, {}, 0.05, Density{2000.0});
  switchOnRotation(model.particles);
  BondMaterial material = unbreakable(1e9);
  material.radiusRatio = 0.4;
  for (int i = 0; i + 1 < 60; ++i) addBond(bonds(model), model.particles, {}, i, i + 1, material);
  return model;
}

TEST(BondStep, OfAColumnIsFoundBeforeTheFirstStepAndNamesABond) {
  Model model = column();
  const ContactStep step = criticalStep(model);
  const double k = bonds(model).bonds[0].normal, mass = model.particles.mass[0];
  EXPECT_NEAR(step.dt, 2.0 / std::sqrt(4.0 * k / mass), 1e-12 * step.dt);
  EXPECT_EQ(step.kind, StepOwner::bond);
  EXPECT_EQ(step.owner.find("the bond of particle "), 0u);
  EXPECT_NO_THROW(requireStableStep(model, 0.9 * step.dt));
  EXPECT_THROW(requireStableStep(model, 1.1 * step.dt), InputError);
}

TEST(BondStep, AColumnRunsBelowItAndBlowsUpBeyond) {
  const auto growth = [](double factor) {
    Model model = column();
    model.refusesUnstableSteps = false;
    Random random(3);
    for (Vec3& v : model.particles.v) v = random.vector(1e-9);
    const double start = kineticEnergy(model.particles), dt = factor * criticalStep(model).dt;
    double largest = 0.0;
    for (int s = 0; s < 2000 && largest < 1e6 * start; ++s) {
      run(model, dt, 1);
      largest = std::max(largest, kineticEnergy(model.particles));
    }
    return largest / start;
  };
  EXPECT_LT(growth(0.9), 50.0);
  EXPECT_GT(growth(1.1), 1e6);
  Model model = column();
  const double limit = criticalStep(model).dt;
  EXPECT_NO_THROW(run(model, 0.9 * limit, 2));
  EXPECT_THROW(run(model, 1.1 * limit, 1), InputError);  // in flight, too
}

TEST(BondStep, BondsAndContactsAddUp) {
  Model model = column();
  const double bondsAlone = criticalStep(model).dt;
  model.laws = makeContactLaws(ElasticLaw{{1e6}});
  for (int i = 0; i < 60; ++i) model.particles.x[static_cast<std::size_t>(i)].x = 0.0999 * i;
  model.pairs.setSkin(0.02);
  findPairs(model.particles, model.pairs);
  const double mass = model.particles.mass[0], both = criticalStep(model).dt;
  EXPECT_NEAR(4.0 / (both * both), 4.0 / (bondsAlone * bondsAlone) + 4.0 * 1e6 / mass, 1e-6 / (both * both));
}

/// A bonded block of 8 × 8 × 8 spheres that is torn apart.
Bonded block() {
  Bonded scene;
  for (int i = 0; i < 512; ++i)
    addParticle(scene.particles, {0.1 * (i % 8), 0.1 * (i / 8 % 8), 0.1 * (i / 64)}, {}, 0.05, Density{2000.0});
  switchOnRotation(scene.particles);
  PairList list;
  list.setSkin(0.001);
  findPairs(scene.particles, list);
  BondMaterial material = unbreakable(1e7);
  material.tensileStrength = material.shearStrength = 2e5;
  EXPECT_EQ(bondTouching(scene.bonds, scene.particles, list, 1e-6, material), 3 * 7 * 64);
  Random random(5);
  for (Vec3& v : scene.particles.v) v = random.vector(3.0);
  return scene;
}

double step(Bonded& scene, double dt) {
  kick(scene.particles, 0.5 * dt);
  drift(scene.particles, dt);
  clearForces(scene.particles);
  const double fractured = dt * exchangeBonds(scene.particles, scene.bonds, {}, dt).fracturePower;
  kick(scene.particles, 0.5 * dt);
  return fractured;
}

TEST(Bonds, BreakInNumbersWithTheSameDigitsForAnyThreadsAndAfterARestart) {
  std::vector<Vec3> once;
  for (const int count : {1, 2, 3}) {
    setThreads(count);
    Bonded scene = block();
    const std::size_t before = scene.bonds.size();
    for (int s = 0; s < 60; ++s) {
      step(scene, 5e-5);
      if (count == 3 && s == 30) scene.bonds.ends = {};  // as read from a file
    }
    EXPECT_LT(scene.bonds.size(), before - 100);
    EXPECT_GT(scene.bonds.size(), 100u);
    if (once.empty()) once = scene.particles.f;
    EXPECT_TRUE(scene.particles.f == once) << count;
  }
  setThreads(1);
}

TEST(Bonds, OfATornBlockBalanceAndKeepTheirEnergy) {
  Bonded scene = block();
  const double start = kineticEnergy(scene.particles);
  const Vec3 push = momentum(scene.particles), turn = angularMomentum(scene.particles);
  double fractured = 0.0;
  for (int s = 0; s < 400; ++s) fractured += step(scene, 5e-6);
  clearForces(scene.particles);
  const double stored = exchangeBonds(scene.particles, scene.bonds, {}, 0.0).storedEnergy();
  EXPECT_GT(fractured, 0.05 * start);
  EXPECT_NEAR(kineticEnergy(scene.particles) + stored + fractured, start, 2e-3 * start);
  EXPECT_LE(norm(momentum(scene.particles) - push), 1e-12 * start);
  EXPECT_LE(norm(angularMomentum(scene.particles) - turn), 1e-12 * start);
}

TEST(Bonds, AreSortedWithTheirParticlesAndEverySumStays) {
  Bonded scene = block();
  for (int s = 0; s < 3; ++s) step(scene, 2e-5);
  std::vector<int> number(512);
  for (int i = 0; i < 512; ++i) number[static_cast<std::size_t>(i)] = (i * 37) % 512;
  Bonded same = scene;
  for (std::size_t i = 0; i < 512; ++i) {
    const auto n = static_cast<std::size_t>(number[i]);
    same.particles.x[n] = scene.particles.x[i];
    same.particles.omega[n] = scene.particles.omega[i];
  }
  renumber(same.bonds, number);
  int last = -1;
  for (const Bond& bond : same.bonds.bonds) {
    EXPECT_GE(std::min(bond.i, bond.j), last);
    last = std::min(bond.i, bond.j);
  }
  for (Bonded* s : {&scene, &same}) clearForces(s->particles);
  const double stored = exchangeBonds(scene.particles, scene.bonds, {}, 0.0).storedEnergy();
  EXPECT_NEAR(exchangeBonds(same.particles, same.bonds, {}, 0.0).storedEnergy(), stored, 1e-13 * stored);
  for (std::size_t i = 0; i < 512; ++i)
    EXPECT_LE(norm(same.particles.f[static_cast<std::size_t>(number[i])] - scene.particles.f[i]),
              1e-12 * (1.0 + norm(scene.particles.f[i])));
}

TEST(Bonds, SeeTheModelsPeriods) {
  Model model;
  model.laws = makeContactLaws(ElasticLaw{{1e2}});
  model.pairs.setSkin(0.02);
  model.pairs.setPeriodicity({{{0, 0, 0}, {1, 1, 1}}, {true, false, false}});
  addParticle(model.particles, {0.951, 0.5, 0.5}, {}, 0.05, Mass{1.0});
  addParticle(model.particles, {0.049, 0.5, 0.5}, {}, 0.05, Mass{1.0});
  switchOnRotation(model.particles);
  findPairs(model.particles, model.pairs);
  ASSERT_EQ(bondTouching(bonds(model), model.particles, model.pairs, 1e-3, unbreakable()), 1);
  EXPECT_NEAR(bonds(model).bonds[0].length, 0.098, 1e-15);
  run(model, 1e-6, 3);
  EXPECT_LE(norm(model.particles.f[0]), 0.2001);  // of the law; the bond is at rest
}

TEST(Bonds, AreMutedInAnyListAnyNumberOfTimes) {
  Bonded scene = block();
  PairList list;
  for (int s = 0; s < 2; ++s) {
    list.setSkin(0.001 + 0.02 * s);
    findPairs(scene.particles, list);
    for (int again = 0; again < 2; ++again) {
      muteBonded(scene.bonds, list);
      EXPECT_EQ(std::count(list.factors().begin(), list.factors().end(), 0.0), static_cast<long>(scene.bonds.size()));
    }
  }
}

TEST(Bonds, ASampleHasTheForcesThatTheParticlesGot) {
  Bonded scene = block();
  EXPECT_THROW(sampleBonds(scene.particles, scene.bonds, {}), InputError);
  for (int s = 0; s < 10; ++s) step(scene, 2e-5);
  const BondSample sample = sampleBonds(scene.particles, scene.bonds, {});
  ASSERT_EQ(sample.size(), scene.bonds.size());
  std::vector<Vec3> force(512), torque(512);
  for (std::size_t b = 0; b < sample.size(); ++b) {
    const auto i = static_cast<std::size_t>(sample.first[b]), j = static_cast<std::size_t>(sample.second[b]);
    force[i] += sample.force[b];
    force[j] -= sample.force[b];
    torque[i] += sample.torqueFirst[b];
    torque[j] += sample.torqueSecond[b];
    const double stretch = norm(sample.to[b] - sample.from[b]) - scene.bonds.bonds[b].length;
    EXPECT_NEAR(sample.tension[b], scene.bonds.bonds[b].normal * stretch, 1e-9 * scene.bonds.bonds[b].normal);
  }
  for (std::size_t i = 0; i < 512; ++i) {
    EXPECT_LE(norm(force[i] - scene.particles.f[i]), 1e-10 * (1.0 + norm(force[i])));
    EXPECT_LE(norm(torque[i] - scene.particles.torque[i]), 1e-10 * (1.0 + norm(torque[i])));
  }
}

TEST(Bonds, ThatDoNotFitTheirParticlesAreRefusedByNumber) {
  const auto refused = [](auto&& change, const std::string& text) {
    Bonded scene = block();
    change(scene);
    try {
      check(scene.bonds, scene.particles);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
  };
  refused([](Bonded& s) { s.bonds.bonds[7].j = 512; }, "bond 7");
  refused([](Bonded& s) { s.bonds.bonds[8].j = s.bonds.bonds[8].i; }, "bond 8");
  refused([](Bonded& s) { s.bonds.bonds[9].normal = NAN; }, "bond 9");
  refused([](Bonded& s) { s.bonds.bonds[10].tensileStrength = 0.0; }, "bond 10");
  refused([](Bonded& s) { s.particles.omega.clear(), s.particles.torque.clear(); }, "spin");
  EXPECT_NO_THROW(check(block().bonds, block().particles));
}

}  // namespace
}  // namespace dovetail::dem
