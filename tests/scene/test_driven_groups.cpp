// Groups that turn, clumps that are driven and bonded.
#include <cmath>
#include <numbers>

#include "../threads.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/setup/relax.hpp"
#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

const std::string three = R"("particles": [{"from": "list", "name": "g", "density": 2500, "spheres": [
    {"at": [0.3, 0.2, 0.1], "radius": 0.01}, {"at": [0.34, 0.2, 0.1], "radius": 0.012},
    {"at": [0.3, 0.25, 0.13], "radius": 0.01}]}],)";

/// Largest of the residuals of energy, momentum and angular momentum, relative to what was turned over.
double residual(coupling::CoupledRun& run) {
  const coupling::Totals totals = run.totals();
  const double work = std::abs(run.ledger().joules("particles: work of walls and drives (minus)"));
  return std::max({std::abs(run.ledger().residual()) / work, norm(totals.residual.linear) / totals.turnedOver,
                   norm(totals.residual.angular) / totals.turnedOverAngular});
}

TEST(TurningDrives, TakeEveryGrainAlongItsCircleAndBookTheWork) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP();
  Built built = started(sceneOf(three + R"("gravity": [0, 0, -9.81], "drives": [{"group": "g",
      "turn": {"axis": [0, 0, 2], "angle": "30*t + 1e3*t^2", "point": [0.3, 0.1, 0]}, "displacement": [0, 0, "5*t^2"]}],)"));
  built.run->advance(2000);
  built.run->ledger();
  const double t = 0.02, angle = 30 * t + 1e3 * t * t, rate = 30 + 2e3 * t;
  const dem::Particles& p = built.run->grains.particles;
  const Vec3 start[] = {{0.0, 0.1, 0.1}, {0.04, 0.1, 0.1}, {0.0, 0.15, 0.13}};
  for (const std::int64_t id : {0, 1, 2}) {
    const auto i = static_cast<std::size_t>(dem::find(p, id));
    const Vec3 arm = rotate(fromRotationVector({0, 0, angle}), start[id]), lift{0, 0, 5 * t * t};
    EXPECT_LT(norm(p.x[i] - (Vec3{0.3, 0.1, 0} + lift + arm)), 1e-12);
    EXPECT_LT(norm(p.v[i] - (Vec3{0, 0, 10 * t} + cross({0, 0, rate}, arm))), 1e-6);
  }
  EXPECT_LT(residual(*built.run), 1e-12);
}

TEST(TurningDrives, TurnAboutTheCentreOfTheirGroupUnlessToldAPoint) {
  Built built = started(sceneOf(R"("particles": [{"from": "list", "name": "g", "density": 2500, "spheres": [
      {"at": [0.3, 0.2, 0.1], "radius": 0.01}, {"at": [0.34, 0.2, 0.1], "radius": 0.012}]}],
      "drives": [{"group": "g", "angular_velocity": [0, 0, 40]}],)"));
  built.run->advance(100);
  const dem::Particles& p = built.run->grains.particles;
  EXPECT_LT(norm(0.5 * (p.x[0] + p.x[1]) - Vec3{0.32, 0.2, 0.1}), 1e-14);
  EXPECT_NEAR(p.x[1].y - p.x[0].y, 0.04 * std::sin(0.04), 1e-14);
}

/// Across a period: the same as in open space.
TEST(TurningDrives, GoOnAcrossPeriods) {
  const std::string drive = R"("drives": [{"group": "g", "velocity": [20, 0, 0], "angular_velocity": [0, 50, 0]}],)";
  Built open = started(sceneOf(three + drive));
  Built periodic =
      started(sceneOf(three + R"("periodic": {"box": [[0.2, 0, 0], [0.36, 1, 1]], "axes": ["x"]},)" + drive));
  for (Built* built : {&open, &periodic}) built->run->advance(1500);
  const dem::Particles &a = open.run->grains.particles, &b = periodic.run->grains.particles;
  for (const std::int64_t id : {0, 1, 2}) {
    const auto i = static_cast<std::size_t>(dem::find(a, id)), j = static_cast<std::size_t>(dem::find(b, id));
    const Vec3 apart = a.x[i] - b.x[j];
    EXPECT_LT(norm(periodic.run->grains.pairs.periodicity().minimumImage(apart)), 1e-12);
    EXPECT_LT(norm(a.v[i] - b.v[j]), 1e-10);
  }
}

const std::string dumbbell = R"({"name": "d", "density": 2500, "at": [0.1, 0.2, 0.3], "spheres": [
    {"at": [0, 0, 0], "radius": 0.01}, {"at": [0.012, 0.009, 0], "radius": 0.008}]})";

/// A body that is turned about no principal axis asks for the torque ω × Iω.
TEST(DrivenClumps, TurnAsTheyAreToldAndTheDriveGivesTheTorqueOfTheirInertia) {
  Built built = started(sceneOf("\"gravity\": [0, 0, -9.81], \"clumps\": [" + dumbbell +
                                R"(], "drives": [{"group": "d", "angular_velocity": [60, 0, 0]}],)"));
  dem::Model& grains = built.run->grains;
  const dem::BodyTerm& term = dem::bodies(grains);
  const Quaternion before = term.bodies.orientation[0];
  built.run->advance(1000);
  built.run->ledger();
  const Quaternion expected = fromRotationVector({0.6, 0, 0}) * before, found = term.bodies.orientation[0];
  EXPECT_LT(norm(rotate(found, {1, 2, 3}) - rotate(expected, {1, 2, 3})), 1e-12);
  EXPECT_LT(norm(term.bodies.x[0] - Vec3{0.1, 0.2, 0.3}), 1e-15);
  EXPECT_LT(norm(dem::angularVelocity(term.bodies, 0) - Vec3{60, 0, 0}), 1e-9);
  const Momenta support = grains.terms.all<dem::DriveTerm>()[0]->support;
  EXPECT_LT(norm(support.linear - Vec3{0, 0, 9.81 * term.bodies.mass[0]}), 1e-12);
  const Vec3 torque = cross({60, 0, 0}, term.bodies.angularMomentum[0]);
  ASSERT_GT(norm(torque), 1e-4);
  EXPECT_LT(norm(support.angular - torque), 1e-3 * norm(torque));
  EXPECT_LT(residual(*built.run), 1e-12);
}

/// A paddle of one clump stirs grains; its friction, damping and weight are in the books.
std::string stirred() {
  std::string beads;
  for (int k = 0; k < 27; ++k)
    beads += (k > 0 ? "," : "") + std::string("{\"at\": [") + std::to_string(0.021 * (k % 3)) + "," +
             std::to_string(0.021 * (k / 3 % 3)) + "," + std::to_string(0.011 + 0.021 * (k / 9)) +
             "], \"radius\": 0.01}";
  return R"("gravity": [0, 0, -9.81], "damping": {"rate": 2, "local": 0.1},
      "particles": [{"from": "list", "density": 2500, "spheres": [)" +
         beads + R"(]}],
      "clumps": [{"name": "paddle", "density": 2500, "at": [-0.05, 0.02, 0.03], "spheres": [
        {"at": [0, 0, 0], "radius": 0.012}, {"at": [0, 0.015, 0], "radius": 0.012}, {"at": [0, 0.03, 0.005], "radius": 0.01}]}],
      "drives": [{"group": "paddle", "velocity": [0.8, 0, 0], "angular_velocity": [0, 20, 10]}],
      "walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],)";
}

TEST(DrivenClumps, StirGrainsAndTheBooksClose) {
  Built built = started(sceneOf(stirred()));
  built.run->advance(10000);
  EXPECT_GT(std::abs(built.run->ledger().joules("particles: work of walls and drives (minus)")), 1e-3);
  EXPECT_LT(residual(*built.run), 2e-3) << built.run->ledger();
  const coupling::Totals totals = built.run->totals();
  EXPECT_LT(norm(totals.residual.linear), 1e-12 * totals.turnedOver) << totals;
  EXPECT_LT(norm(totals.residual.angular), 1e-12 * totals.turnedOverAngular) << totals;
}

TEST(DrivenClumps, DoNotDependOnTheNumberOfThreads) {
  const auto places = [](int threads) {
    return onThreads(threads, [] {
      Built built = started(sceneOf(stirred()));
      built.run->advance(5000);
      return built.run->grains.particles.x;
    });
  };
  EXPECT_EQ(places(1), places(2));
}

// ---- bonds of clumps

std::string chain(const std::string& more) {
  std::string clumps;
  for (int k = 0; k < 3; ++k)
    clumps += (k > 0 ? "," : "") + std::string(R"({"name": ")") + (k == 0 ? "first" : "rest") +
              R"(", "density": 2500, "at": [)" + std::to_string(0.04 * k) + ", 0, 0]" +
              (k == 1 ? R"(, "spin": [0, 0, 20])" : "") + R"(, "spheres": [
              {"at": [0, 0, 0], "radius": 0.01}, {"at": [0.02, 0, 0], "radius": 0.01}]})";
  const std::string bond = R"("gap": 1e-6, "youngs_modulus": 1e8, "poisson_ratio": 0.25, "contacts": false)";
  return "\"clumps\": [" + clumps + R"(], "bonds": [{"group": "first", "with": "rest", )" + bond +
         R"(}, {"group": "rest", )" + bond + "}]," + more;
}

TEST(BondsOfClumps, JoinClumpsAndNeverTheMembersOfOne) {
  Built built = started(sceneOf(chain("")));
  const dem::Bonds& bonds = dem::bonds(built.run->grains);
  ASSERT_EQ(bonds.size(), 2U);
  for (const dem::Bond& bond : bonds.bonds) EXPECT_EQ(std::abs(bond.i - bond.j), 1);
  expectParts(refusalOfRun("\"clumps\": [" + dumbbell + R"(], "bonds": [{"group": "d", "gap": 1e-3,
      "youngs_modulus": 1e7, "poisson_ratio": 0.2}],)"),
              {"bonds.0", "of different clumps"});
}

/// The ends of the bonds turn with the bodies, so that energy is kept to the second order of the step.
TEST(BondsOfClumps, KeepEnergyAndMomentumWhileTheySwing) {
  const auto error = [](double dt) {
    Built built = build(sceneOf(chain("")));
    built.run->start(dt, {});
    const double before = built.run->ledger().storedAtOpening();
    built.run->advance(static_cast<std::int64_t>(std::llround(0.05 / dt)));
    const coupling::Totals totals = built.run->totals();
    EXPECT_LT(norm(totals.residual.linear), 1e-12);
    EXPECT_LT(norm(totals.residual.angular), 1e-14);
    return std::abs(built.run->ledger().residual()) / before;
  };
  const double coarse = error(2e-6), fine = error(1e-6);
  EXPECT_LT(fine, 1e-3);
  EXPECT_LT(fine, 0.4 * coarse) << coarse << " " << fine;
}

/// A rigid clump at the end of one bond that is held at its other end: a cantilever of the bond's length under a force
/// and a moment.
TEST(BondsOfClumps, BendAsBeams) {
  const Scene scene = sceneOf(R"("gravity": [0, 0, -9.81], "clumps": [
      {"name": "held", "density": 2500, "at": [0, 0, 0], "spheres": [{"at": [0, 0, 0], "radius": 0.01}, {"at": [0.02, 0, 0], "radius": 0.01}]},
      {"name": "hangs", "density": 2500, "at": [0.04, 0, 0], "spheres": [{"at": [0, 0, 0], "radius": 0.01}, {"at": [0.02, 0, 0], "radius": 0.01}]}],
      "bonds": [{"group": "held", "with": "hangs", "gap": 1e-6, "youngs_modulus": 1e8, "poisson_ratio": 0.25, "contacts": false}],
      "drives": [{"group": "held"}],)");
  Built built = build(scene);
  dem::Model& grains = built.run->grains;
  const dem::RelaxationReport report = dem::relax(grains, {.tolerance = 1e-8});
  ASSERT_TRUE(report.atRest) << report.residual;
  const dem::Bodies& bodies = dem::bodies(grains).bodies;
  const double E = 1e8, G = E / 2.5, L = 0.02, r = 0.01, area = std::numbers::pi * r * r, I = 0.25 * area * r * r;
  const double force = 9.81 * bodies.mass[1], arm = 0.01, moment = force * arm;
  const double end = force * L * L * L / (3 * E * I) + moment * L * L / (2 * E * I) + force * L / (0.9 * G * area);
  const double slope = force * L * L / (2 * E * I) + moment * L / (E * I);
  EXPECT_NEAR(-bodies.x[1].z, end + slope * arm, 1e-3 * end);
  EXPECT_EQ(bodies.x[0], Vec3{});
}

// ---- refusals

TEST(DrivenGroups, WhatCannotBeIsRefusedByName) {
  expectParts(refusalOfRun(three + R"("drives": [{"group": "g", "spin": [0, 0, 1], "angular_velocity": [0, 0, 1]}],)"),
              {"drives.0", "both a spin and a turn", "leave one out"});
  expectParts(refusalOfRun(three + R"("drives": [{"group": "g", "turn": {"axis": [0, 0, 0], "angle": 0}}],)"),
              {"drives.0", "no length"});
  expectParts(refusalOfRun(three + R"("drives": [{"group": "g", "angular_velocity": [0, 0, 1],
      "turn": {"axis": [0, 0, 1], "angle": 0}}],)"),
              {"drives.0", "both an angular velocity and a turn"});
  expectParts(refusalOfRun(three + R"("periodic": {"box": [[0.2, 0, 0], [0.4, 1, 1]], "axes": ["x"]},
      "drives": [{"group": "g", "turn": {"axis": [0, 0, 1], "angle": 0, "point": [0.3, 0.1, 0.1]}}],)"),
              {"drives.0", "repeats every 0.2", "along x", "half a period"});
  expectParts(refusalOfRun("\"clumps\": [" + dumbbell + R"(], "drives": [{"group": "e"}],)"), {"drives.0", "\"d\""});
  expectParts(refusalOfRun(three + R"("clumps": [{"name": "g", "density": 1, "at": [1, 1, 1],
      "spheres": [{"at": [0, 0, 0], "radius": 0.01}]}],)"),
              {"clumps.0", "group of particles \"g\""});
  const auto relaxed = [](const std::string& drive) {
    build(sceneFromText(
        "{" + law + three + R"("drives": [{"group": "g", )" + drive + R"(}], "stages": [{"do": "relax"}]})", "s.json",
        "/"));
  };
  EXPECT_THROW(relaxed(R"("angular_velocity": [0, 0, 1])"), InputError);
  EXPECT_NO_THROW(relaxed(R"("turn": {"axis": [0, 0, 1], "angle": 0})"));
}

// ---- books of insertions

/// Newcomers get no half kick at the end of the step in which they come, damping included.
TEST(InsertedClumps, BesideDampingTheMomentumIsInTheBooks) {
  for (const char* const grains : {R"("clumps": [{"spheres": [{"at": [0, 0, 0], "radius": 0.004},
      {"at": [0.005, 0, 0], "radius": 0.004}]}])",
                                   R"("radius": {"smallest": 0.003, "largest": 0.004})"}) {
    Built built = started(sceneOf(R"("gravity": [0, 0, -9.81], "damping": {"local": 0.5, "rate": 3},
        "insertions": [{"region": [[0, 0, 0], [0.3, 0.3, 0.3]], "density": 2500, "number_per_second": 5000, )" +
                                  std::string(grains) + "}],"));
    built.run->advance(1000);
    const coupling::Totals totals = built.run->totals();
    EXPECT_GT(built.run->grains.entered.count, 40);
    EXPECT_LT(norm(totals.residual.linear), 1e-12 * totals.turnedOver) << totals;
    EXPECT_LT(norm(totals.residual.angular), 1e-12 * totals.turnedOverAngular) << totals;
  }
}

}  // namespace
}  // namespace dovetail::scene::test
