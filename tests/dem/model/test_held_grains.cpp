// Particles that are held or driven: spin, force and torque of what holds them, jumps, and models at rest on them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/relax.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

Vec3 still(double) { return {}; }

DriveTerm& hold(Model& m, std::vector<std::int64_t> ids, DriveTerm::Path spin = {}) {
  return m.terms.add(DriveTerm(std::move(ids), still, still, std::move(spin)));
}

/// One grain under a plate that moves along x, pressed with 10 N.
Model rubbed() {
  Model m;
  m.laws = makeContactLaws(FrictionalLaw{{1e5, 0.5}, {3e4, 0.4}});
  addParticle(m.particles, {}, {}, 0.01, Density{2500.0});
  addWall(m, makePlane({0, 0, 0.0099}, {0, 0, -1})).velocity = {0.2, 0, 0};
  return m;
}

TEST(HeldGrains, AreRubbedAsHardAsFrictionAllowsAndTheSupportTellsForceAndTorque) {
  Model m = rubbed();
  const DriveTerm& support = hold(m, {0});
  const double start = energies(m).balance();
  run(m, 1e-5, 3000);
  EXPECT_NEAR(primitiveWall(m, 0).force.x, -4.0, 1e-9);
  EXPECT_EQ(norm(m.particles.omega[0]), 0.0);
  EXPECT_LT(norm(support.support.linear - Vec3{-4, 0, 10}), 1e-9);
  EXPECT_LT(norm(support.support.angular - Vec3{0, -4 * 0.0099, 0}), 1e-11);
  const Energies end = energies(m);
  EXPECT_NEAR(end.lost.frictionPower, 4 * (0.2 * 0.03 - 4 / 3e4), 1e-3 * end.lost.frictionPower);
  EXPECT_NEAR(end.balance(), start, 1e-4 * end.lost.frictionPower);
}

TEST(HeldGrains, KeepTheSpinThatTheyAreGivenAndItsWorkIsBooked) {
  Model m = rubbed();
  primitiveWall(m, 0).velocity = {};
  switchOnRotation(m.particles);
  hold(m, {0}, [](double t) { return Vec3{0, 20 * std::sin(50 * t), 0}; });
  const double start = energies(m).balance();
  run(m, 1e-5, 5000);
  EXPECT_NEAR(m.particles.omega[0].y, 20 * std::sin(2.5), 1e-12);
  const Energies end = energies(m);
  EXPECT_GT(end.walls, 0.01);
  EXPECT_NEAR(end.balance(), start, 1e-3 * end.walls);
}

TEST(HeldGrains, OfModelsThatDoNotSpinAreGivenNoSpin) {
  Model m;
  m.laws = makeContactLaws(ElasticLaw{{1e4}});
  addParticle(m.particles, {}, {}, 0.1, Mass{1.0});
  hold(m, {0}, still);
  EXPECT_THROW(run(m, 1e-4, 1), InputError);
}

/// Deflection of a clamped beam under the same weight at all beads: w = Σ W x² (3 L − x)/(6 E I).
TEST(HeldGrains, OneCarriesABondedCantilever) {
  Model m;
  m.laws = makeContactLaws(ElasticLaw{{1e5}});
  m.gravity = {0, 0, -9.81};
  constexpr int beads = 6;
  constexpr double spacing = 0.02, radius = 0.01, young = 1e9;
  for (int i = 0; i <= beads; ++i) addParticle(m.particles, {spacing * i, 0, 0}, {}, radius, Density{2500.0});
  switchOnRotation(m.particles);
  bondTouching(bonds(m), m.particles, m.pairs, 1e-6,
               {.youngsModulus = young,
                .poissonRatio = 0.2,
                .shearCorrection = 0.0,
                .tensileStrength = 1e12,
                .shearStrength = 1e12});
  m.terms.all<BondTerm>()[0]->mutesContacts = true;
  const DriveTerm& support = hold(m, {0});
  const RelaxationReport report = relax(m, {.tolerance = 1e-5});
  ASSERT_TRUE(report.atRest) << report.residual << " after " << report.steps;
  const double weight = 9.81 * m.particles.mass[0], inertia = 0.25 * std::numbers::pi * std::pow(radius, 4);
  double expected = 0.0, moment = 0.0;
  for (int i = 1; i <= beads; ++i) {
    const double x = spacing * i;
    expected += weight * x * x * (3 * beads * spacing - x) / (6 * young * inertia);
    moment += weight * x;
  }
  EXPECT_NEAR(-m.particles.x[beads].z, expected, 1e-2 * expected);
  run(m, 0.1 * criticalStep(m).dt, 1);
  EXPECT_NEAR(support.support.linear.z, (beads + 1) * weight, 1e-2 * weight);
  EXPECT_NEAR(support.support.angular.y, -moment, 1e-2 * moment);
}

/// 2 kg at 1 m/s, and then at 3 m/s: 8 J, whatever the step.
TEST(Drives, BookAJumpWithTheMeanVelocity) {
  for (const double dt : {1e-2, 1e-4}) {
    Model m;
    m.laws = makeContactLaws(FrictionalLaw{{1e4, 0.5}, {3e3, 0.4}});
    addParticle(m.particles, {}, {1, 0, 0}, 0.1, Mass{2.0});
    switchOnRotation(m.particles);
    m.particles.omega[0] = {0, 0, 5};
    auto& drive = m.terms.add(DriveTerm(
        {0},
        [](double t) {
          return Vec3{3 * t, 0, 0};
        },
        [](double) {
          return Vec3{3, 0, 0};
        }));
    const double spin = 0.5 * momentOfInertia(m.particles, 0) * 25.0;
    run(m, dt, 10);
    EXPECT_NEAR(energies(m).walls, 8.0 - spin, 1e-12) << dt;
    advance(m, dt);
    m.terms.remove(drive);
    hold(m, {0});
    run(m, dt, 10);
    EXPECT_NEAR(energies(m).walls, -1.0 - spin, 1e-12) << dt;
  }
}

TEST(Drives, WorkAgainstDampingToo) {
  Model m;
  m.laws = makeContactLaws(ElasticLaw{{1e4}});
  addParticle(m.particles, {}, {0.3, 0, 0}, 0.1, Mass{1.0});
  m.terms.add(DriveTerm(
      {0},
      [](double t) {
        return Vec3{0.01 * std::sin(30 * t), 0, 0};
      },
      [](double t) {
        return Vec3{0.3 * std::cos(30 * t), 0, 0};
      }));
  damping(m).viscousRate = 20.0;
  const double start = energies(m).balance();
  run(m, 1e-4, 3000);
  const Energies end = energies(m);
  EXPECT_GT(end.damping, 0.1);
  EXPECT_NEAR(end.balance(), start, 1e-5 * end.damping);
}

Model crate() {
  Model m;
  m.laws = makeContactLaws(FrictionalLaw{{2e4, 0.5}, {6e3, 0.4, 0.2}});
  m.gravity = {0, 0, -9.81};
  Random random(5);
  for (int i = 0; i < 64; ++i)
    addParticle(
        m.particles,
        Vec3{0.021 * (i % 4), 0.021 * (i / 4 % 4), 0.021 * (i / 16)} + Vec3{0.012, 0.012, 0.012} + random.vector(4e-4),
        {}, 0.01, Density{2500.0});
  for (const auto& [point, normal] :
       {std::pair{Vec3{}, Vec3{0, 0, 1}}, std::pair{Vec3{}, Vec3{1, 0, 0}}, std::pair{Vec3{}, Vec3{0, 1, 0}},
        std::pair{Vec3{0.088, 0, 0}, Vec3{-1, 0, 0}}, std::pair{Vec3{0, 0.088, 0}, Vec3{0, -1, 0}}})
    addWall(m, makePlane(point, normal));
  return m;
}

TEST(Relax, ALidWithAServoCarriesItsLoadAtRest) {
  Model m = crate();
  PrimitiveWall& lid = addWall(m, makePlane({0, 0, 0.1}, {0, 0, -1}));
  lid.servo = makeServo({0, 0, -1}, 50.0, 0.5, 20.0);
  const double start = energies(m).balance();
  const RelaxationReport report = relax(m);
  ASSERT_TRUE(report.atRest) << report.residual << " after " << report.steps;
  EXPECT_EQ(lid.servo->speed, 0.0);
  EXPECT_NEAR(lid.force.z, 50.0, 0.005);
  const Energies end = energies(m);
  EXPECT_NEAR(end.balance(), start, 1e-2 * end.external);
  run(m, 1e-5, 200);
  EXPECT_LT(energies(m).kinetic, 2e-6 * end.contacts);
}

TEST(Relax, HoldsWhatADriveHolds) {
  Model m = crate();
  const Vec3 place = m.particles.x[60];
  hold(m, {60});
  const RelaxationReport report = relax(m, {.tolerance = 1e-3});
  EXPECT_TRUE(report.atRest) << report.residual << " after " << report.steps;
  EXPECT_EQ(m.particles.x[static_cast<std::size_t>(find(m.particles, 60))], place);
}

TEST(Relax, RefusesBeltsAndDrivesThatMove) {
  Model belt = crate();
  primitiveWall(belt, 0).surfaceVelocity = {1, 0, 0};
  EXPECT_THROW(relax(belt), InputError);
  Model mesh = crate();
  MeshWall floor;
  floor.wall = squares(2, 2, 0.1);
  floor.surfaceVelocity = {1, 0, 0};
  addWall(mesh, floor);
  EXPECT_THROW(relax(mesh), InputError);
  Model driven = crate();
  driven.terms.add(DriveTerm(
      {3},
      [](double t) {
        return Vec3{t, 0, 0};
      },
      [](double) {
        return Vec3{1, 0, 0};
      }));
  EXPECT_THROW(relax(driven), InputError);
}

}  // namespace
}  // namespace dovetail::dem
