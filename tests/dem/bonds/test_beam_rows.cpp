// Rows of bonded spheres against beams; damping.
#include <gtest/gtest.h>

#include "beam_scenes.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "model/impact_scenes.hpp"

namespace dovetail::dem {
namespace {

TEST(BeamRows, ACantileverWithATipLoadBendsAsTheBeamForAnyNumberOfSpheres) {
  for (const double correction : {0.0, 0.9}) {
    Row row;
    row.radius = 0.05;
    row.shearCorrection = correction;
    const double small = 1e-4, load = small * 3.0 * row.E * row.inertia();
    const double G = row.E / 2.5, shear = correction > 0.0 ? load / (correction * G * row.area()) : 0.0;
    for (const int elements : {1, 2, 5, 10}) {
      std::vector<Vec3> loads(static_cast<std::size_t>(elements) + 1);
      loads.back() = {0, 0.6 * load, 0.8 * load};
      const Vec3 tip = row.settle(elements, loads);
      EXPECT_NEAR(tip.z, 0.8 * (small + shear), 1e-5 * small) << elements;
      EXPECT_NEAR(tip.y, 0.6 * (small + shear), 1e-5 * small) << elements;
    }
  }
}

TEST(BeamRows, ALumpedLineLoadConvergesToTheBeam) {
  Row row;
  row.radius = 0.05;
  const double small = 1e-4, q = small * 8.0 * row.E * row.inertia();
  const auto error = [&](int elements) {
    std::vector<Vec3> loads(static_cast<std::size_t>(elements) + 1, Vec3{0, 0, q / elements});
    loads.back() *= 0.5;
    return std::abs(row.settle(elements, loads).z / small - 1.0);
  };
  const double coarse = error(4), fine = error(8);
  EXPECT_LE(fine, 0.01);
  EXPECT_NEAR(coarse / fine, 4.0, 0.2);
}

TEST(BeamRows, ALongBendFollowsTheElastica) {
  // Tip load α = P L²/EI = 1 that keeps its direction.
  Row row;
  const auto error = [&](int elements) {
    row.radius = 0.01;
    std::vector<Vec3> loads(static_cast<std::size_t>(elements) + 1);
    loads.back() = {0, 0, row.E * row.inertia()};
    const Vec3 tip = row.settle(elements, loads);
    return std::hypot(tip.z - 0.30172, tip.x + 0.05643);
  };
  const double coarse = error(4), fine = error(8);
  EXPECT_LE(fine, 2e-3);
  EXPECT_NEAR(coarse / fine, 4.0, 0.5);
}

TEST(BeamRows, ForcesAreBitwiseTheSameForAnyNumberOfThreads) {
  const auto run = [](int count) {
    setThreads(count);
    Row row;
    row.radius = 1e-4;
    Bonded scene = row.make(2000);
    Random random(11);
    for (Vec3& x : scene.particles.x) x += random.vector(1e-5);
    exchangeBonds(scene.particles, scene.bonds, {}, 0.0);
    setThreads(1);
    return scene.particles.f;
  };
  EXPECT_TRUE(run(1) == run(3));
}

/// A bonded block thrown onto a wall: everything that went in, less what is booked, over what went in.
struct Smash {
  double residual, fractured;
  std::size_t broken;
};

Smash smash(int stepsPerContact) {
  Impact scene(
      [] {
        Particles block;
        for (int i = 0; i < 4; ++i)
          for (int j = 0; j < 4; ++j)
            for (int k = 0; k < 4; ++k)
              addParticle(block, {0.1 * i - 0.11, 0.1 * j - 0.13, 0.1 * k + 0.0501}, {1.0, 0, -3.0}, 0.05,
                          Density{2000.0});
        return block;
      }(),
      FrictionalLaw{{1e6, 0.8}, {7e5, 0.4}}, true);
  Bonds bonds;
  BondMaterial material = unbreakable(1e7);
  material.tensileStrength = material.shearStrength = 2e5;
  material.dampingTime = 1e-6;
  bondTouching(bonds, scene.particles, scene.list, 1e-6, material);
  const std::size_t before = bonds.size();
  const double dt = pi * std::sqrt(scene.particles.mass[0] / 1e6) / stepsPerContact;
  double fractured = 0.0;
  for (double t = 0.0; t < 0.05; t += dt) {
    kick(scene.particles, 0.5 * dt);
    drift(scene.particles, dt);
    scene.exchange(dt);
    const ContactWork held = exchangeBonds(scene.particles, bonds, {}, dt);
    fractured += held.fracturePower * dt;
    scene.work += held;
    kick(scene.particles, 0.5 * dt);
    scene.book(dt);
  }
  return {scene.worstResidual / scene.start, fractured / scene.start, before - bonds.size()};
}

TEST(BeamRows, ABlockThatShattersKeepsItsLedger) {
  const Smash coarse = smash(50), fine = smash(200);
  EXPECT_GT(fine.broken, 20u);
  EXPECT_LT(fine.broken, 144u);
  EXPECT_GT(fine.fractured, 0.01);
  EXPECT_LE(coarse.residual, 5e-4);
  EXPECT_LE(fine.residual, 2e-4);
}

TEST(Damping, TakesWhatItSays) {
  Particles particles;
  addParticle(particles, {}, {3, 0, -1}, 0.1, Mass{2.0});
  switchOnRotation(particles);
  particles.omega[0] = {0, 4, 0};
  particles.f[0] = {1, -2, 3};
  particles.torque[0] = {1, -1, 0};
  EXPECT_DOUBLE_EQ(applyLocalDamping(particles, 0.5), 0.5 * (1.0 * 3.0 + 3.0 * 1.0 + 1.0 * 4.0));
  EXPECT_EQ(particles.f[0], (Vec3{0.5, -2, 4.5}));
  EXPECT_EQ(particles.torque[0], (Vec3{1, -1.5, 0}));
  const double power = applyViscousDamping(particles, 0.7);
  EXPECT_DOUBLE_EQ(power, 2.0 * 0.7 * kineticEnergy(particles));
  EXPECT_DOUBLE_EQ(particles.f[0].x, 0.5 - 0.7 * 2.0 * 3.0);
  EXPECT_THROW(applyLocalDamping(particles, 1.0), InputError);
  EXPECT_THROW(applyViscousDamping(particles, -1.0), InputError);
}

}  // namespace
}  // namespace dovetail::dem
