// The model and its step, primitive walls, checkpoints.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "../../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

const FrictionalLaw law{{2e3, 0.4}, {6e2, 0.5}};

/// Particles in a box of planes, falling.
Model pile(int n, bool meshFloor = false) {
  Model model;
  model.laws = makeContactLaws(law);
  model.gravity = {0, 0, -10};
  Random random(7);
  for (int i = 0; i < n; ++i) {
    const Vec3 at{0.11 * (i % 8) + 0.06, 0.11 * (i / 8 % 8) + 0.06, 0.11 * (i / 64) + 0.07};
    addParticle(model.particles, at, random.vector(0.5), random(0.04, 0.05), Density{1000.0});
  }
  switchOnRotation(model.particles);
  model.pairs.setSkin(0.01);
  findPairs(model.particles, model.pairs);
  for (const auto& [point, normal] : {std::pair<Vec3, Vec3>{{0, 0, 0}, {1, 0, 0}},
                                      {{0.9, 0, 0}, {-1, 0, 0}},
                                      {{0, 0, 0}, {0, 1, 0}},
                                      {{0, 0.9, 0}, {0, -1, 0}}})
    addWall(model, makePlane(point, normal)).skin = 0.02;
  if (meshFloor) {
    MeshWall& floor = addWall(model, MeshWall{});
    floor.wall = squares(13, 13, 0.1);
    for (Vec3& x : floor.wall.x) x += Vec3{-0.2, -0.2, 0.0} - Vec3{0, 0, x.z};
    floor.candidates.skin = 0.02;
  } else {
    addWall(model, makePlane({}, {0, 0, 1})).skin = 0.02;
  }
  return model;
}

TEST(Model, TheLedgerClosesWithTheStep) {
  const auto residual = [](double dt) {
    auto model = pile(200);
    const double start = energies(model).balance();
    run(model, dt, static_cast<std::int64_t>(0.3 / dt + 0.5));
    const Energies end = energies(model);
    EXPECT_GT(end.lost.frictionPower, 0.0);
    EXPECT_GT(end.lost.dissipatedPower, 0.0);
    return std::abs(end.balance() - start) / end.lost.lostPower();
  };
  const double coarse = residual(4e-5), fine = residual(1e-5);
  EXPECT_LT(coarse, 2e-2);
  EXPECT_LT(fine, 0.5 * coarse);  // first order: dashpots switch on and off suddenly
}

TEST(Model, WeightIsTheSumOverAllParticles) {
  for (const int n : {1, 7, 8, 9, 31, 64}) {
    Model all = pile(n);
    all.gravity = {1.0, -2.0, -10.0};
    Momenta sum;
    for (std::size_t i = 0; i < all.particles.size(); ++i)
      sum.add(all.particles.x[i], all.particles.mass[i] * all.gravity);
    Model shared = all;
    shared.particles.weight.assign(shared.particles.size(), 0.5);
    for (const auto& [model, fraction] : {std::pair(&all, 1.0), std::pair(&shared, 0.5)}) {
      const Momenta found = weight(*model);
      EXPECT_LT(norm(found.linear - fraction * sum.linear), 1e-14 * norm(sum.linear));
      EXPECT_LT(norm(found.angular - fraction * sum.angular), 1e-13 * norm(sum.angular));
    }
  }
}

TEST(Model, AdvanceAndCloseHaveTheDigitsOfTheVerbs) {
  auto model = pile(60);
  auto plain = pile(60);
  model.sortEvery = 0;
  run(model, 1e-4, 50);
  const auto forces = [&](double dt) {
    updatePairs(plain.particles, plain.pairs);
    clearForces(plain.particles);
    applyGravity(plain.particles, plain.gravity);
    plain.laws->pairs(plain.particles, plain.pairs, dt, Booking::on);
    for (auto* term : plain.terms.all<PrimitiveWallTerm>()) {
      findContacts(plain.particles, term->wall, {});
      plain.laws->wall(plain.particles, term->wall, dt, Booking::on);
    }
  };
  forces(1e-100);
  for (int i = 0; i < 50; ++i) {
    kick(plain.particles, 0.5e-4);
    drift(plain.particles, 1e-4);
    forces(1e-4);
    kick(plain.particles, 0.5e-4);
  }
  EXPECT_EQ(model.particles.x, plain.particles.x);
  EXPECT_EQ(model.particles.v, plain.particles.v);
  EXPECT_EQ(model.particles.omega, plain.particles.omega);
}

TEST(Model, ResultsDoNotDependOnThreads) {
  const auto end = [](int count) {
    setThreads(count);
    auto model = pile(1600);
    run(model, 1e-4, 120);
    setThreads(1);
    return model;
  };
  const auto one = end(1), two = end(2), three = end(3);
  EXPECT_EQ(one.particles.x, two.particles.x);
  EXPECT_EQ(one.particles.omega, two.particles.omega);
  EXPECT_EQ(one.pairs.memory(), two.pairs.memory());
  EXPECT_EQ(one.particles.v, three.particles.v);
  EXPECT_EQ(energies(one).balance(), energies(three).balance());
}

TEST(Model, ATriangulatedFloorGivesTheAnswerOfThePlane) {
  auto plane = pile(120), mesh = pile(120, true);
  plane.sortEvery = mesh.sortEvery = 0;
  run(plane, 1e-4, 600);
  run(mesh, 1e-4, 600);
  double worst = 0.0;
  for (std::size_t i = 0; i < plane.particles.size(); ++i)
    worst = std::max(worst, norm(plane.particles.x[i] - mesh.particles.x[i]));
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(meshWall(mesh, 0).contacts.size(), 10u);
}

TEST(Model, ARunFromACheckpointIsTheSameToTheLastBit) {
  const io::test::ScratchFolder scratch;
  const auto path = scratch / "dovetail_model_checkpoint";
  for (const bool meshFloor : {false, true}) {
    auto whole = pile(500, meshFloor);
    run(whole, 1e-4, 151);
    writeCheckpoint(path, whole);
    double alive = 0.0;
    for (const double m : whole.pairs.memory()) alive = std::max(alive, std::abs(m));
    ASSERT_GT(alive, 0.0);
    auto resumed = pile(1, meshFloor);
    readCheckpoint(path, resumed);
    run(whole, 1e-4, 101);
    run(resumed, 1e-4, 101);
    EXPECT_TRUE(saveState(whole) == saveState(resumed)) << meshFloor;
  }
}

TEST(Model, DamagedAndForeignCheckpointsAreRefused) {
  const io::test::ScratchFolder scratch;
  const auto path = scratch / "dovetail_model_damaged";
  auto model = pile(20);
  const auto before = model.particles.x;
  writeCheckpoint(path, model);
  const auto size = std::filesystem::file_size(path);
  const auto flip = [&](std::uint64_t at) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(static_cast<std::streamoff>(at));
    const int byte = file.get() ^ 4;
    file.seekp(static_cast<std::streamoff>(at));
    file.put(static_cast<char>(byte));
  };
  for (const std::uint64_t at : {std::uint64_t{0}, std::uint64_t{9}, std::uint64_t{26}, std::uint64_t{100}, size - 1}) {
    flip(at);
    EXPECT_THROW(readCheckpoint(path, model), InputError) << at;
    flip(at);
  }
  EXPECT_NO_THROW(readCheckpoint(path, model));
  auto other = pile(20, true);
  EXPECT_THROW(readCheckpoint(path, other), InputError);
  std::filesystem::resize_file(path, size / 2);
  EXPECT_THROW(readCheckpoint(path, model), InputError);
  EXPECT_THROW(readCheckpoint(path / "nothing", model), InputError);
  EXPECT_EQ(model.particles.x, before);
}

TEST(Model, WhoLeavesTheDomainIsRefusedOrRemovedAndCounted) {
  for (const auto policy : {EscapePolicy::refuse, EscapePolicy::remove}) {
    auto model = pile(50);
    model.particles.v[7] = {0, 0, 60};
    model.domain = Domain{{{-1, -1, -1}, {2, 2, 2}}, policy};
    const double mass = model.particles.mass[7];
    const double start = energies(model).balance();
    if (policy == EscapePolicy::refuse) {
      try {
        run(model, 1e-4, 2000);
        FAIL();
      } catch (const NumericalError& error) {
        EXPECT_NE(std::string(error.what()).find("particle 7"), std::string::npos) << error.what();
      }
      continue;
    }
    run(model, 1e-4, 2000);
    EXPECT_EQ(model.left.count, 1);
    EXPECT_EQ(model.left.mass, mass);
    EXPECT_EQ(model.particles.size(), 49u);
    EXPECT_NEAR(energies(model).balance(), start, 0.02 * energies(model).lost.lostPower());
  }
}

TEST(Model, NaNAndTunnellingAreCaughtAtOnceByName) {
  auto model = pile(30);
  run(model, 1e-4, 1);
  model.particles.v[11].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(advance(model, 1e-4), NumericalError);
  auto fast = pile(30);
  fast.particles.v[12] = {1e4, 0, 0};
  try {
    advance(fast, 1e-4);
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("particle 12"), std::string::npos) << error.what();
  }
}

TEST(PrimitiveWalls, DistanceAndNormalAreTheGradient) {
  Random random(3);
  std::vector<PrimitiveWall> walls{makePlane({0.1, 0.2, 0.3}, {1, 2, 3})};
  for (const bool inside : {true, false}) {
    walls.push_back(makeCylinder({0.1, 0, 0}, {1, -1, 2}, 1.5, inside));
    walls.push_back(makeSphere({0.1, 0, 0}, 1.2, inside));
  }
  for (const PrimitiveWall& wall : walls)
    for (int k = 0; k < 20; ++k) {
      const Vec3 x = random.vector(1.0), along = random.vector(1.0);
      const double h = 1e-6;
      const double slope =
          (distanceTo(wall, x + h * along).distance - distanceTo(wall, x - h * along).distance) / (2 * h);
      EXPECT_NEAR(slope, dot(distanceTo(wall, x).normal, along), 1e-7);
    }
}

TEST(PrimitiveWalls, AParticleRidesInATurningDrumAndTheWorkIsBooked) {
  Model model;
  model.laws = makeContactLaws(law);
  model.gravity = {0, 0, -10};
  addParticle(model.particles, {0, 0, -0.94}, {}, 0.05, Density{1000.0});
  switchOnRotation(model.particles);
  model.pairs.setSkin(0.01);
  addWall(model, makeCylinder({}, {0, 1, 0}, 1.0)).angularVelocity = {0, 0.5, 0};
  const double start = energies(model).balance();
  run(model, 2e-5, 100000);
  const Energies end = energies(model);
  EXPECT_GT(end.walls, 0.0);
  EXPECT_NEAR(end.balance(), start, 1e-3 * end.walls);
}

TEST(PrimitiveWalls, BadOnesAreRefused) {
  EXPECT_THROW(makePlane({}, {}), InputError);
  EXPECT_THROW(makeCylinder({}, {0, 0, 0}, 1.0), InputError);
  EXPECT_THROW(makeCylinder({}, {0, 0, 1}, -1.0), InputError);
  EXPECT_THROW(makeSphere({NAN, 0, 0}, 1.0), InputError);
}

TEST(Pairs, PeriodicImagesMakeNoDifference) {
  const auto end = [](const Vec3& moved) {
    Model model;
    model.laws = makeContactLaws(law);
    Random random(11);
    model.pairs.setPeriodicity({{{0, 0, 0}, {0.8, 0.8, 0.8}}, {true, true, true}});
    for (int i = 0; i < 400; ++i) {
      const Vec3 at{0.1 * (i % 8) + 0.05, 0.1 * (i / 8 % 8) + 0.05, 0.1 * (i / 64) + 0.05};
      addParticle(model.particles, at + moved, random.vector(1.0), 0.0502, Density{1000.0});
    }
    switchOnRotation(model.particles);
    wrapPositions(model.particles, model.pairs.periodicity());
    model.pairs.setSkin(0.02);
    model.sortEvery = 0;
    run(model, 1e-4, 300);
    for (Vec3& x : model.particles.x) x -= moved;
    wrapPositions(model.particles, model.pairs.periodicity());
    return model;
  };
  const auto here = end({}), there = end({0.37, 0.21, 0.55});
  EXPECT_GT(here.pairs.images().size(), 50u);
  const double speed = std::sqrt(2.0 * kineticEnergy(here.particles));
  EXPECT_LT(norm(momentum(here.particles) - momentum(end({}).particles)), 1e-14 * speed);
  for (std::size_t i = 0; i < 400; ++i)
    EXPECT_LT(norm(here.pairs.periodicity().minimumImage(here.particles.x[i] - there.particles.x[i])), 1e-8);
}

TEST(Pairs, PruningChangesNothing) {
  const auto end = [](double skin) {
    auto model = pile(3000);
    model.sortEvery = 0;
    model.pairs.setSkin(skin);
    findPairs(model.particles, model.pairs);
    run(model, 1e-4, 150);
    return model;
  };
  const auto pruned = end(0.03), plain = end(0.0);
  EXPECT_LT(pruned.pairs.innerSkin(), pruned.pairs.skin());
  EXPECT_GT(pruned.pairs.revision(), pruned.pairs.builds());
  EXPECT_EQ(pruned.particles.x, plain.particles.x);
  EXPECT_EQ(pruned.particles.omega, plain.particles.omega);
}

}  // namespace
}  // namespace dovetail::dem
