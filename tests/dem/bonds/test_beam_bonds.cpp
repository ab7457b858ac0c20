// Beams between particles: forces, balances, breakage.
#include <gtest/gtest.h>

#include <tuple>

#include "beam_scenes.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::dem {
namespace {

/// A bonded clump whose particles have then been moved and turned at random.
Bonded deformedClump(unsigned seed, double size) {
  Random random(seed);
  Bonded scene;
  for (int i = 0; i < 12; ++i)
    addParticle(scene.particles, random.vector(0.12), {}, random(0.05, 0.08), Density{1000.0});
  switchOnRotation(scene.particles);
  PairList list;
  list.setSkin(0.0);
  findPairs(scene.particles, list);
  EXPECT_GT(bondTouching(scene.bonds, scene.particles, list, 0.0, unbreakable()), 10);
  for (std::size_t i = 0; i < 12; ++i) {
    scene.particles.x[i] += random.vector(0.03 * size);
    scene.particles.omega[i] = random.vector(size);
  }
  exchangeBonds(scene.particles, scene.bonds, {}, 1.0);  // turns the ends by about |ω|
  for (Vec3& omega : scene.particles.omega) omega = {};
  return scene;
}

double evaluate(Bonded& scene, double dt = 0.0) {
  clearForces(scene.particles);
  return exchangeBonds(scene.particles, scene.bonds, scene.space, dt).storedEnergy();
}

TEST(BeamBonds, ForcesAndTorquesAreSlopesOfTheEnergyAtAnyDeformation) {
  for (const double size : {0.01, 0.8}) {
    Bonded scene = deformedClump(1, size);
    const double stored = evaluate(scene);
    EXPECT_GT(stored, 0.0);
    const std::vector<Vec3> force = scene.particles.f, torque = scene.particles.torque;
    Random random(2);
    const double h = 1e-6;
    double work = 0.0, up = 0.0, down = 0.0, scale = 0.0;
    std::vector<Vec3> move, turn;
    for (std::size_t i = 0; i < force.size(); ++i) {
      move.push_back(random.vector(0.1));
      turn.push_back(random.vector(1.0));
      work += dot(force[i], move[i]) + dot(torque[i], turn[i]);
      scale += norm(force[i]) * 0.1 + norm(torque[i]);
    }
    for (const double sign : {1.0, -1.0}) {
      Bonded moved = scene;
      for (std::size_t i = 0; i < force.size(); ++i) {
        moved.particles.x[i] += sign * h * move[i];
        moved.particles.omega[i] = sign * turn[i];
      }
      (sign > 0.0 ? up : down) = evaluate(moved, h);
    }
    EXPECT_NEAR((up - down) / (2.0 * h), -work, 1e-6 * scale);
  }
}

TEST(BeamBonds, ForcesAndMomentsBalanceToRoundOff) {
  Bonded scene = deformedClump(3, 0.8);
  for (Bond& bond : scene.bonds.bonds) bond.dampingTime = 1e-3;
  Random random(4);
  for (std::size_t i = 0; i < 12; ++i) {
    scene.particles.v[i] = random.vector(1.0);
    scene.particles.omega[i] = random.vector(10.0);
  }
  clearForces(scene.particles);
  const ContactWork work = exchangeBonds(scene.particles, scene.bonds, {}, 0.0);
  EXPECT_GT(work.dissipatedPower, 0.0);
  Vec3 total, moment;
  double size = 0.0, power = 0.0;
  for (std::size_t i = 0; i < 12; ++i) {
    const auto& p = scene.particles;
    total += p.f[i];
    moment += cross(p.x[i], p.f[i]) + p.torque[i];
    size += norm(p.f[i]);
    power += dot(p.f[i], p.v[i]) + dot(p.torque[i], p.omega[i]);
  }
  EXPECT_LE(norm(total), 1e-14 * size);
  EXPECT_LE(norm(moment), 1e-14 * size);
  // What the dashpots take is what damped forces give less than elastic ones.
  for (Bond& bond : scene.bonds.bonds) bond.dampingTime = 0.0;
  evaluate(scene);
  for (std::size_t i = 0; i < 12; ++i)
    power -= dot(scene.particles.f[i], scene.particles.v[i]) + dot(scene.particles.torque[i], scene.particles.omega[i]);
  EXPECT_NEAR(power, -work.dissipatedPower, 1e-11 * work.dissipatedPower);
}

/// v turned by an angle about an axis.
Vec3 rotated(const Vec3& v, const Vec3& axis, double angle) {
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + (1.0 - std::cos(angle)) * dot(axis, v) * axis;
}

TEST(BeamBonds, ForcesTurnWithTheBody) {
  const Vec3 axis = normalized({1, 2, -2}), shift{3, 1, 2};
  for (const bool relaxed : {false, true}) {
    Bonded scene = deformedClump(5, relaxed ? 0.0 : 0.5);
    const double before = evaluate(scene);
    Bonded turned = scene;
    for (Vec3& x : turned.particles.x) x = rotated(x, axis, 2.1) + shift;
    for (Bond& b : turned.bonds.bonds)
      for (Vec3* v : {&b.directionI, &b.directionJ, &b.acrossI, &b.acrossJ}) *v = rotated(*v, axis, 2.1);
    const double stiffness = scene.bonds.bonds[0].normal;
    EXPECT_NEAR(evaluate(turned), before, 1e-12 * before + 1e-25 * stiffness);
    for (std::size_t i = 0; i < 12; ++i) {
      EXPECT_LE(norm(turned.particles.f[i] - rotated(scene.particles.f[i], axis, 2.1)), 1e-13 * stiffness);
      EXPECT_LE(norm(turned.particles.torque[i] - rotated(scene.particles.torque[i], axis, 2.1)), 1e-14 * stiffness);
    }
  }
}

TEST(BeamBonds, ASpinningPairKeepsEnergyAndAngularMomentum) {
  const auto drift = [](double dt) {
    Bonded scene;
    const Vec3 omega = 20.0 * normalized({1, 2, 3});
    addParticle(scene.particles, {}, {}, 0.1, Mass{1.0});
    addParticle(scene.particles, {0.2, 0, 0}, cross(omega, {0.2, 0, 0}), 0.08, Mass{2.0});
    switchOnRotation(scene.particles);
    scene.particles.omega = {omega, omega};
    addBond(scene.bonds, scene.particles, {}, 0, 1, unbreakable(1e6));
    evaluate(scene);
    const double start = kineticEnergy(scene.particles);
    const Vec3 momentumAtStart = angularMomentum(scene.particles);
    double worst = 0.0;
    for (double t = 0.0; t < 2.0; t += dt) {  // more than six turns
      kick(scene.particles, 0.5 * dt);
      dem::drift(scene.particles, dt);
      const double stored = evaluate(scene, dt);
      kick(scene.particles, 0.5 * dt);
      worst = std::max(worst, std::abs(kineticEnergy(scene.particles) + stored - start) / start);
    }
    EXPECT_LE(norm(angularMomentum(scene.particles) - momentumAtStart), 1e-11 * norm(momentumAtStart));
    return worst;
  };
  const double coarse = drift(2e-4), fine = drift(1e-4);
  EXPECT_LE(coarse, 1e-3);
  EXPECT_NEAR(coarse / fine, 4.0, 0.8);
}

TEST(BeamBonds, BreakAtTheirStrengthAndBookWhatTheyHeld) {
  // Tension alone, bending alone, torsion alone: just below and just above the strength.
  const auto strained = [](int mode, double factor) {
    Bonded scene;
    addParticle(scene.particles, {}, {}, 0.1, Mass{1.0});
    addParticle(scene.particles, {0.2, 0, 0}, {}, 0.1, Mass{1.0});
    switchOnRotation(scene.particles);
    BondMaterial material = unbreakable(1e7);
    material.tensileStrength = 2e4;
    material.shearStrength = 1e4;
    addBond(scene.bonds, scene.particles, {}, 0, 1, material);
    const double r = 0.08, G = 1e7 / 2.5;
    Vec3 turn;
    if (mode == 0) scene.particles.x[1].x += factor * 2e4 / 1e7 * 0.2;  // σ = E ε
    if (mode == 1) turn = {0, 0, 0.5 * factor * 2e4 / 1e7 * 0.2 / r};   // σ = E r κ, both ends
    if (mode == 2) turn = {0.5 * factor * 1e4 / G * 0.2 / r, 0, 0};     // τ = G r φ/L
    scene.particles.omega = {-turn, turn};
    clearForces(scene.particles);
    return std::pair{exchangeBonds(scene.particles, scene.bonds, {}, 1.0), scene};
  };
  for (const int mode : {0, 1, 2}) {
    const auto [held, whole] = strained(mode, 0.999);
    EXPECT_EQ(whole.bonds.size(), 1u);
    EXPECT_EQ(held.fracturePower, 0.0);
    EXPECT_NEAR(whole.bonds.utilised[0], 0.999, 1e-4);
    const auto [lost, broken] = strained(mode, 1.001);
    EXPECT_EQ(broken.bonds.size(), 0u);
    EXPECT_EQ(lost.storedEnergy(), 0.0);
    EXPECT_NEAR(lost.fracturePower, held.storedEnergy(), 1e-2 * held.storedEnergy());
    EXPECT_EQ(norm(broken.particles.f[0]), 0.0);
  }
}

TEST(BeamBonds, SurviveNewNumbersAndBookThoseWhoseParticlesAreGone) {
  Bonded scene = deformedClump(7, 0.3), same = scene;
  const double before = evaluate(scene);
  PairList list;
  list.setSkin(0.0);
  findPairs(same.particles, list);
  const std::vector<int> newNumber = sortParticles(same.particles, list);
  renumber(same.bonds, newNumber);
  EXPECT_NEAR(evaluate(same), before, 1e-13 * before);
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_LE(norm(same.particles.f[static_cast<std::size_t>(newNumber[i])] - scene.particles.f[i]),
              1e-12 * norm(scene.particles.f[i]));
  std::vector<int> gone(12);
  for (int i = 0; i < 12; ++i) gone[static_cast<std::size_t>(i)] = i == scene.bonds.bonds[0].i ? -1 : i;
  const double left = renumber(scene.bonds, gone);
  clearForces(scene.particles);
  const ContactWork after = exchangeBonds(scene.particles, scene.bonds, {}, 0.5);
  EXPECT_GT(left, 0.0);
  EXPECT_NEAR(after.storedEnergy() + left, before, 1e-13 * before);
  EXPECT_EQ(after.fracturePower, 0.0);
}

TEST(BeamBonds, ReachThroughPeriodicFaces) {
  Bonded scene;
  scene.space = {{{0, 0, 0}, {1, 1, 1}}, {true, false, false}};
  addParticle(scene.particles, {0.05, 0.5, 0.5}, {}, 0.06, Mass{1.0});
  addParticle(scene.particles, {0.95, 0.5, 0.5}, {}, 0.06, Mass{1.0});
  switchOnRotation(scene.particles);
  addBond(scene.bonds, scene.particles, scene.space, 0, 1, unbreakable());
  EXPECT_NEAR(scene.bonds.bonds[0].length, 0.1, 1e-15);
  scene.particles.x[0].x += 0.01;
  EXPECT_NEAR(evaluate(scene), 0.5 * scene.bonds.bonds[0].normal * 1e-4, 1e-10 * scene.bonds.bonds[0].normal);
  EXPECT_LT(scene.particles.f[0].x, 0.0);
}

TEST(BeamBonds, MuteTheLawBetweenTheirParticles) {
  Bonded scene = deformedClump(8, 0.0);
  PairList list;
  list.setSkin(0.0);
  findPairs(scene.particles, list);
  muteBonded(scene.bonds, list);
  EXPECT_EQ(std::count(list.factors().begin(), list.factors().end(), 0.0), static_cast<long>(scene.bonds.size()));
}

TEST(BeamBonds, TheirCriticalStepIsSafeAndNotFarFromTheLimit) {
  for (const double damping : {0.0, 1e-4}) {
    const auto grows = [&](double factor) {
      Bonded scene = deformedClump(9, 0.0);
      for (Bond& bond : scene.bonds.bonds) bond.dampingTime = damping;
      Random random(10);
      for (Vec3& v : scene.particles.v) v = random.vector(1e-9);
      const double dt = factor * bondStep(scene.particles, scene.bonds), start = kineticEnergy(scene.particles);
      double largest = 0.0;
      for (int s = 0; s < 3000; ++s) {
        kick(scene.particles, 0.5 * dt);
        drift(scene.particles, dt);
        evaluate(scene, dt);
        kick(scene.particles, 0.5 * dt);
        largest = std::max(largest, kineticEnergy(scene.particles));
        if (largest > 1e6 * start) return true;
      }
      return false;
    };
    EXPECT_FALSE(grows(0.99));
    EXPECT_TRUE(grows(2.5));
  }
}

TEST(BeamBonds, BadInputIsRefused) {
  Bonded scene;
  addParticle(scene.particles, {}, {}, 0.1, Mass{1.0});
  addParticle(scene.particles, {0.2, 0, 0}, {}, 0.1, Mass{1.0});
  addParticle(scene.particles, {}, {}, 0.1, Mass{1.0});
  const auto refused = [&](auto&& change) {
    BondMaterial material = unbreakable();
    change(material);
    EXPECT_THROW(addBond(scene.bonds, scene.particles, {}, 0, 1, material), InputError);
  };
  refused([](BondMaterial& m) { m.youngsModulus = 0.0; });
  refused([](BondMaterial& m) { m.poissonRatio = 0.6; });
  refused([](BondMaterial& m) { m.radiusRatio = NAN; });
  refused([](BondMaterial& m) { m.tensileStrength = 0.0; });
  refused([](BondMaterial& m) { m.shearStrength = -1.0; });
  refused([](BondMaterial& m) { m.momentContribution = 1.5; });
  refused([](BondMaterial& m) { m.dampingTime = -1.0; });
  EXPECT_THROW(addBond(scene.bonds, scene.particles, {}, 0, 0, unbreakable()), InputError);
  EXPECT_THROW(addBond(scene.bonds, scene.particles, {}, 0, 3, unbreakable()), InputError);
  EXPECT_THROW(addBond(scene.bonds, scene.particles, {}, 0, 2, unbreakable()), InputError);
  addBond(scene.bonds, scene.particles, {}, 0, 1, unbreakable());
  EXPECT_THROW(exchangeBonds(scene.particles, scene.bonds, {}, 0.0), InputError);
  switchOnRotation(scene.particles);
  EXPECT_THROW(exchangeBonds(scene.particles, scene.bonds, {}, -1.0), InputError);
  EXPECT_NO_THROW(exchangeBonds(scene.particles, scene.bonds, {}, 0.0));
  scene.bonds.bonds[0].j = 2;
  Particles fewer;
  addParticle(fewer, {}, {}, 0.1, Mass{1.0});
  switchOnRotation(fewer);
  EXPECT_THROW(exchangeBonds(fewer, scene.bonds, {}, 0.0), InputError);
}

TEST(BeamBonds, CountAsMuchAsTheirParticlesDo) {
  const auto answered = [](double weight) {
    Bonded scene;
    addParticle(scene.particles, {0, 0, 0}, {}, 0.5, Mass{2.0});
    addParticle(scene.particles, {1, 0, 0}, {}, 0.5, Mass{3.0});
    switchOnRotation(scene.particles);
    BondMaterial material = unbreakable();
    material.tensileStrength = material.shearStrength = 1e9;
    material.dampingTime = 1e-4;
    addBond(scene.bonds, scene.particles, {}, 0, 1, material);
    if (weight < 1.0) scene.particles.weight = {0.5 * weight, 1.5 * weight};
    scene.particles.x[1] = {1.01, 0.02, -0.01};
    scene.particles.v[1] = {0.3, -0.1, 0.2};
    scene.particles.omega[0] = {0.1, 0.5, -0.3};
    const ContactWork work = exchangeBonds(scene.particles, scene.bonds, {}, 1e-3);
    return std::tuple{work, scene.particles.f[1], scene.particles.torque[0], scene.bonds.utilised[0],
                      dashpotPower(scene.particles, scene.bonds, {}, scene.particles.v, scene.particles.omega)};
  };
  const auto [whole, force, torque, utilised, power] = answered(1.0);
  const auto [part, partForce, partTorque, partUtilised, partPower] = answered(0.25);
  EXPECT_NEAR(part.elasticEnergy, 0.25 * whole.elasticEnergy, 1e-12 * whole.elasticEnergy);
  EXPECT_NEAR(part.dissipatedPower, 0.25 * whole.dissipatedPower, 1e-12 * whole.dissipatedPower);
  EXPECT_NEAR(partPower, 0.25 * power, 1e-12 * power);
  EXPECT_LT(norm(partForce - 0.25 * force), 1e-12 * norm(force));
  EXPECT_LT(norm(partTorque - 0.25 * torque), 1e-12 * norm(torque));
  EXPECT_EQ(partUtilised, utilised);
}

}  // namespace
}  // namespace dovetail::dem
