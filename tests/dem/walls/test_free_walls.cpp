// Walls that free bodies of a model carry: whatever they meet, they meet as one of the scene's masses.
#include <gtest/gtest.h>

#include <filesystem>

#include "../../io/scratch_folder.hpp"
#include "box_wall.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/relax.hpp"
#include "dovetail/dem/setup/streams.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

const FrictionalLaw frictional{{.stiffness = 2e4, .restitution = 0.7}, {.stiffness = 6e3, .friction = 0.4}};
const ElasticLaw elastic{{.stiffness = 1e5}};

ClumpShape rod() {
  return makeClumpShape(std::vector<Vec3>{{0, 0, 0}, {0.06, 0, 0}}, std::vector<double>{0.05, 0.05}, Density{1000.0});
}

/// Balls fly at a free box that turns.
template <class Law>
Model billiard(const Law& law, bool wallFirst = false) {
  Model model;
  model.laws = makeContactLaws(law);
  model.pairs.setSkin(0.03);
  TriangulatedWall box = boxWall({-0.2, -0.15, -0.1}, {0.4, 0.3, 0.2});
  const Vec3 omega{0.5, 1.0, -2.0};
  if (wallFirst) {
    MeshWall& mesh = addWall(model, MeshWall{});
    mesh.wall = box;
    mesh.motion = addWallBody(bodies(model).bodies, mesh.wall, Density{500.0}, {}, omega);
  } else {
    addFreeWall(model, box, Density{500.0}, {}, omega);
  }
  Random random(5);
  for (int i = 0; i < 30; ++i) {
    const Vec3 way = normalized(random.vector(1.0));
    addParticle(model.particles, (0.35 + 0.06 * i) * way, -2.0 * way + random.vector(0.1), 0.05, Density{1000.0});
  }
  return model;
}

TEST(FreeWalls, KeepMomentaToRoundOffWhicheverTermCameFirst) {
  std::vector<char> once;
  for (const bool wallFirst : {false, true}) {
    Model model = billiard(frictional, wallFirst);
    const Momenta before = momenta(model);
    EXPECT_NEAR(bodies(model).bodies.mass[0], 12.0, 1e-12);
    run(model, 1e-4, 6000);
    const Momenta after = momenta(model);
    EXPECT_LE(norm(after.linear - before.linear), 1e-11);
    EXPECT_LE(norm(after.angular - before.angular), 1e-11);
    EXPECT_GT(norm(bodies(model).bodies.v[0]), 0.01);
    EXPECT_GT(energies(model).lost.frictionPower, 0.0);
    ByteWriter state;
    state(model.particles.x, bodies(model).bodies.x, bodies(model).bodies.angularMomentum);
    if (once.empty()) once = state.bytes();
    EXPECT_TRUE(state.bytes() == once);
  }
}

TEST(FreeWalls, ABallIsThrownBackFromABodyOfItsSizeWithTheRestitutionThatWasAskedFor) {
  Model model;
  model.laws = makeContactLaws(ContactLaw<LinearSpringDashpot>{{.stiffness = 1e5, .restitution = 0.6}});
  addFreeWall(model, boxWall({-0.1, -0.1, -0.1}, {0.2, 0.2, 0.2}), Density{500.0}, {0, 0, 0.5});
  addParticle(model.particles, {0, 0, 0.16}, {0, 0, -1.0}, 0.05, Mass{2.0});
  run(model, 1e-5, 8000);
  const Bodies& b = bodies(model).bodies;
  EXPECT_NEAR(model.particles.v[0].z - b.v[0].z, 0.6 * 1.5, 1e-3);
  EXPECT_NEAR(2.0 * model.particles.v[0].z + 4.0 * b.v[0].z, 0.0, 1e-12);
}

/// One ball hits a turning box beside its centre, under gravity: the worst residual on the way, over the energy.
template <class Law>
double residual(const Law& law, double dt) {
  Model model;
  model.laws = makeContactLaws(law);
  model.gravity = {0.3, 0, -1.0};
  addFreeWall(model, boxWall({-0.2, -0.15, -0.1}, {0.4, 0.3, 0.2}), Density{300.0}, {}, {0.5, 1.0, -2.0});
  addParticle(model.particles, {0.08, 0.05, 0.17}, {0.5, 0, -2.0}, 0.05, Density{1000.0});
  const double start = energies(model).balance();
  double worst = 0.0;
  while (model.time < 0.06) {
    run(model, dt, 4);
    worst = std::max(worst, std::abs(energies(model).balance() - start));
  }
  EXPECT_GT(model.particles.v[0].z - bodies(model).bodies.v[0].z, 0.5);
  return worst / energies(model).kinetic;
}

TEST(FreeWalls, TheLedgerClosesAtSecondOrder) {
  const FrictionalLaw lossless{{.stiffness = 2e4}, {.stiffness = 6e3, .friction = 1e3}};
  EXPECT_LE(residual(elastic, 2e-5), 2e-4);
  EXPECT_LE(residual(elastic, 2e-5), 0.3 * residual(elastic, 4e-5));
  EXPECT_LE(residual(lossless, 2e-5), 2e-4);
  EXPECT_LE(residual(lossless, 2e-5), 0.3 * residual(lossless, 4e-5));
  EXPECT_LE(residual(frictional, 2e-5), 4e-3);
  EXPECT_LE(residual(frictional, 2e-5), 0.6 * residual(frictional, 4e-5));  // while it slides: of first order
}

/// Balls, rods and two free boxes in a periodic box, sorted at every list update.
template <class Law>
Model gas(const Law& law) {
  Model model;
  model.laws = makeContactLaws(law);
  model.pairs.setSkin(0.02);
  model.pairs.setPeriodicity({{{0, 0, 0}, {1, 1, 1}}, {true, true, true}});
  model.sortEvery = 1;
  Random random(8);
  for (int i = 0; i < 64; ++i) {
    const Vec3 x{0.125 + 0.25 * (i % 4), 0.125 + 0.25 * (i / 4 % 4), 0.125 + 0.25 * (i / 16)}, v = random.vector(1.0);
    if (i == 21 || i == 42)
      addFreeWall(model, boxWall(x - 0.06 * Vec3{1, 1, 1}, {0.14, 0.12, 0.1}), Density{800.0}, 3.0 * v,
                  random.vector(5.0));
    else if (i % 5 == 0)
      addClump(model, rod(), x, fromRotationVector(random.vector(3.0)), v, random.vector(5.0));
    else
      addParticle(model.particles, x, v, 0.05, Density{1000.0});
  }
  return model;
}

TEST(FreeWalls, FlyThroughPeriodsAndKeepEnergyAndMomentum) {
  Model model = gas(elastic);
  model.gravity = {0.5, 0, 0};
  const Energies start = energies(model);
  const Vec3 push = momenta(model).linear;
  const Bodies& b = bodies(model).bodies;
  run(model, 2e-5, 25001);
  double mass = 0.0;
  for (const double m : b.mass) mass += m;
  for (std::size_t i = 0; i < model.particles.size(); ++i)
    if (!model.particles.isMember(i)) mass += model.particles.mass[i];
  EXPECT_LE(norm(momenta(model).linear - push - (model.time * mass) * model.gravity), 1e-9);
  EXPECT_NE(model.booked.lifted, 0.0);
  EXPECT_NEAR(energies(model).balance(), start.balance(), 2e-3 * start.kinetic);
  for (std::size_t k = 0; k < b.size(); ++k)
    for (int axis = 0; axis < 3; ++axis) EXPECT_TRUE(b.x[k][axis] > -0.1 && b.x[k][axis] < 1.1);
  for (std::size_t w : {0u, 1u}) {
    const auto& carrier = std::get<WallOnBody>(meshWall(model, w).motion);
    const Vec3 arm = rotate(b.orientation[static_cast<std::size_t>(carrier.body)], carrier.offset[3]);
    EXPECT_LE(norm(meshWall(model, w).wall.x[3] - b.x[static_cast<std::size_t>(carrier.body)] - arm), 1e-14);
  }
}

TEST(FreeWalls, RunsAreTheSameForAnyThreadsAndFromACheckpoint) {
  const io::test::ScratchFolder scratch;
  const auto path = scratch / "dovetail_free_walls.ckp";
  std::vector<char> once;
  for (const int count : {1, 2, 3}) {
    setThreads(count);
    Model model = gas(frictional);
    damping(model).viscousRate = 0.1;
    for (int s = 0; s < 701; ++s) {
      advance(model, 4e-5);
      if (s != 350) continue;
      writeCheckpoint(path, model);
      Model other = gas(frictional);
      damping(other);
      if (count == 3) other.terms = Terms();
      readCheckpoint(path, other);
      EXPECT_TRUE(saveState(other) == saveState(model)) << count;
      if (count > 1) model = other;
    }
    close(model);
    if (once.empty()) once = saveState(model);
    EXPECT_TRUE(saveState(model) == once) << count;
  }
  setThreads(1);
}

TEST(FreeWalls, LightBodiesAskForShorterSteps) {
  const auto limit = [](double density) {
    Model model;
    model.laws = makeContactLaws(elastic);
    addFreeWall(model, boxWall({-0.1, -0.1, -0.1}, {0.2, 0.2, 0.2}), Density{density});
    addParticle(model.particles, {0, 0, 0.149}, {}, 0.05, Mass{2.0});
    addParticle(model.particles, {0, 0, -0.149}, {}, 0.05, Mass{2.0});
    findForces(model);
    return criticalStep(model).dt;
  };
  const double apart = 2.0 / std::sqrt(1e5 / 2.0);
  EXPECT_NEAR(limit(1e9), apart, 1e-3 * apart);
  const double exact = 2.0 / std::sqrt(1e5 * (1.0 / 2.0 + 2.0 / 0.08));  // the box between the two, which mirror it
  EXPECT_LE(limit(10.0), exact);
  EXPECT_GE(limit(10.0), 0.4 * exact);
}

TEST(FreeWalls, ABoxComesToRestOnGrains) {
  Model model;
  model.laws = makeContactLaws(frictional);
  model.gravity = {0, 0, -9.81};
  addWall(model, makePlane({}, {0, 0, 1}));
  for (int i = 0; i < 9; ++i)
    addParticle(model.particles, {0.11 * (i % 3), 0.11 * (i / 3), 0.05 + 0.0005 * (i % 4)}, {}, 0.05, Density{2000.0});
  const MeshWall& box = addFreeWall(model, boxWall({-0.05, -0.04, 0.105}, {0.3, 0.3, 0.1}), Density{600.0});
  const double before = energies(model).balance();
  const RelaxationReport report = relax(model, {.tolerance = 1e-4});
  ASSERT_TRUE(report.atRest) << report.residual << " after " << report.steps;
  EXPECT_NEAR(totalForce(box.wall).z, 9.81 * bodies(model).bodies.mass[0], 1e-2 * 9.81 * bodies(model).bodies.mass[0]);
  EXPECT_EQ(forcePower(box.wall), 0.0);
  EXPECT_NEAR(energies(model).balance(), before, 0.02 * std::abs(before));
  run(model, 0.1 * criticalStep(model).dt, 300);  // left alone, it stays
  EXPECT_LT(energies(model).kinetic, 1e-2 * model.work.storedEnergy());
}

TEST(FreeWalls, KeepTheirBodiesWhereClumpsBeforeThemLeave) {
  Model model;
  model.laws = makeContactLaws(frictional);
  model.pairs.setSkin(0.02);
  addClump(model, rod(), {5, 0, 0}, {}, {0, 0, -1});
  const MeshWall& box = addFreeWall(model, boxWall({-0.1, -0.1, -0.1}, {0.2, 0.2, 0.2}), Density{500.0}, {}, {0, 1, 0});
  addClump(model, rod(), {0.03, 0, 0.2}, {}, {0, 0, -1});
  addOutlet(model, HalfSpace{{4, 0, 0}, {1, 0, 0}});
  const double before = energies(model).balance();
  run(model, 1e-4, 1500);
  EXPECT_EQ(bodies(model).bodies.size(), 2u);
  EXPECT_EQ(std::get<WallOnBody>(box.motion).body, 0);
  EXPECT_NEAR(bodies(model).bodies.mass[0], 4.0, 1e-12);
  EXPECT_LT(bodies(model).bodies.v[0].z, -0.1);
  EXPECT_NEAR(energies(model).balance(), before, 1e-3 * std::abs(before));
}

TEST(FreeWalls, WhatCarriesNoWallIsRefusedWithWordsThatHelp) {
  const auto refusal = [](auto&& change) -> std::string {
    Model model = billiard(elastic);
    change(model, std::get<WallOnBody>(meshWall(model, 0).motion));
    try {
      check(model);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  };
  const auto expectSaid = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_NE(text.find("addFreeWall"), std::string::npos) << text;
  };
  EXPECT_EQ(refusal([](Model&, WallOnBody&) {}), "nothing");
  expectSaid(refusal([](Model& m, WallOnBody&) { m.terms.remove(bodies(m)); }), "has none");
  expectSaid(refusal([](Model&, WallOnBody& carrier) { carrier.body = 7; }), "no body 7");
  expectSaid(refusal([](Model&, WallOnBody& carrier) { carrier.offset.pop_back(); }), "7 offsets for its 8");
  expectSaid(refusal([](Model& m, WallOnBody& carrier) { carrier.body = addClump(m, rod(), {9, 9, 9}); }), "a clump");
  Model two = billiard(elastic);
  two.terms.add(BodyTerm{});
  EXPECT_THROW(check(two), InputError);
  MeshWall alone;
  alone.wall = boxWall({}, {1, 1, 1});
  alone.motion = WallOnBody{};
  EXPECT_THROW(gatherForces(alone), InputError);
}

}  // namespace
}  // namespace dovetail::dem
