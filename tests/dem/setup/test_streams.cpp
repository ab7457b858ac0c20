// Grains that enter and leave a model while it runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "../../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"
#include "dovetail/dem/setup/streams.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

const FrictionalLaw frictional{{.stiffness = 2e4, .restitution = 0.7, .tension = true},
                               {.stiffness = 6e3, .friction = 0.4}};

TEST(Outlets, BookWhatAParticleCarriedToTheLastDigit) {
  Model model;
  model.laws = makeContactLaws(ElasticLaw{{.stiffness = 2e4}});
  model.gravity = {0, 0, -10};
  addParticle(model.particles, {0, 0, 0}, {1, 0, 0}, 0.05, Mass{2.0});
  addParticle(model.particles, {1, 0, 0}, {0, 0, 0}, 0.05, Mass{2.0});
  addOutlet(model, geometry::Box{{-9, -9, -9}, {0.5, 9, -0.1}});
  run(model, 1e-3, 200);
  EXPECT_EQ(model.particles.size(), 1u);
  EXPECT_EQ(model.particles.id[0], 1);
  EXPECT_EQ(model.left.count, 1);
  EXPECT_EQ(model.left.mass, 2.0);
  EXPECT_NEAR(model.left.momentum.x, 2.0, 1e-15);
  EXPECT_NEAR(model.booked.left, 1.0, 2e-2);  // ½ m v² + m g z of free fall from rest in z
  EXPECT_NEAR(energies(model).balance(), 1.0, 2e-2);
}

TEST(Insertions, KeepToTheirTimes) {
  Model model;
  model.laws = makeContactLaws(ElasticLaw{{.stiffness = 2e4}});
  const InsertionTerm& stream = addInsertion(model, {.region = {{0, 0, 0}, {9, 9, 9}},
                                                     .sizes = UniformSizes{0.05, 0.05},
                                                     .density = {1000.0},
                                                     .numberPerSecond = 1000.0,
                                                     .from = 0.0205,
                                                     .until = 0.0515});
  for (int step = 1; step <= 80; ++step) {
    run(model, 1e-3, 1);
    const double lasted = std::clamp(1e-3 * step - 0.0205, 0.0, 0.031);
    EXPECT_NEAR(static_cast<double>(stream.insertion.inserted), 1000.0 * lasted, 1.0) << step;
  }
  EXPECT_NEAR(static_cast<double>(stream.insertion.inserted), 31.0, 1.0);
}

/// Grains that fly through a box that repeats and never meet, fast and slow.
Model flyingApart() {
  Model model;
  model.laws = makeContactLaws(ElasticLaw{{.stiffness = 2e4}});
  model.pairs.setPeriodicity({{{0, 0, 0}, {10, 10, 10}}, {true, true, false}});
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j)
      addParticle(model.particles, {0.8 * i + 0.5, 0.8 * j + 0.5, 0.5 * ((5 * i + 7 * j) % 12)},
                  {0.02 * (i + 1), 0.05 * (j - 6), 0.3}, 1e-3, Mass{1.0});
  model.pairs.setSkin(0.04);
  return model;
}

TEST(Outlets, LetNobodyPassUnseenBetweenSearches) {
  for (const OutletTerm::Region& region :
       {OutletTerm::Region(geometry::Box{{2, 2, 3}, {8, 8, 3.5}}),
        OutletTerm::Region(HalfSpace{{0, 0, 6}, {0, 0, 3}})}) {  // both far from where positions wrap
    Model model = flyingApart(), all = flyingApart();
    OutletTerm& outlet = addOutlet(model, region);
    outlet.region = HalfSpace{{0, 0, 1e3}, {0, 0, 1}};  // out of the way, and then somewhere else
    std::vector<char> in(all.particles.size(), 0);
    std::size_t left = 0;
    for (int step = 0; step < 1500; ++step) {
      if (step == 20) outlet.region = region;
      move(all, 2e-3);
      for (std::size_t i = 0; step >= 20 && i < in.size(); ++i) {
        const Vec3& x = all.particles.x[i];
        const auto* const box = std::get_if<geometry::Box>(&region);
        const bool isIn = box ? x.x >= 2 && x.x <= 8 && x.y >= 2 && x.y <= 8 && x.z >= 3 && x.z <= 3.5 : x.z > 6;
        char& was = in[static_cast<std::size_t>(all.particles.id[i])];
        if (isIn && was == 0) ++left;
        was = static_cast<char>(was | static_cast<char>(isIn));
      }
      updateNeighbourList(all);
      addForces(all);
      advance(model, 2e-3);
      ASSERT_EQ(model.particles.size(), in.size() - left) << "step " << step;
    }
    EXPECT_GT(left, 5U);
    EXPECT_LT(left, in.size());
    for (const std::int64_t id : model.particles.id) EXPECT_EQ(in[static_cast<std::size_t>(id)], 0);
  }
}

TEST(Outlets, BadOnesAreRefused) {
  Model model;
  model.laws = makeContactLaws(frictional);
  addParticle(model.particles, {}, {}, 0.05, Mass{1.0});
  OutletTerm& outlet = addOutlet(model, HalfSpace{{0, 0, 0}, {0, 0, 0}});
  EXPECT_THROW(check(model), InputError);
  outlet.region = geometry::Box{{0, 0, 1}, {1, 1, 0}};
  EXPECT_THROW(check(model), InputError);
  outlet.region = geometry::Box{{0, 0, 1}, {1, 1, 2}};
  EXPECT_NO_THROW(check(model));
  outlet.every = 0;
  EXPECT_THROW(check(model), InputError);
}

TEST(Insertions, BookWhatComesInAndItFallsFreeFromThatMoment) {
  Model model;
  model.laws = makeContactLaws(frictional);
  model.gravity = {0, 0, -10};
  switchOnRotation(model.particles);
  InsertionTerm& stream = addInsertion(model, {.region = {{0, 0, 0}, {0.1, 0.1, 0.1}},
                                               .sizes = UniformSizes{0.05, 0.05},
                                               .density = {1000.0},
                                               .velocity = {0, 0, -1},
                                               .spin = {3, 0, 0},
                                               .numberPerSecond = 1.0});
  const double dt = 1e-3, mass = 1000.0 * 4.0 / 3.0 * std::numbers::pi * 0.05 * 0.05 * 0.05;
  run(model, dt, 1250);  // one, at t = 1 s
  ASSERT_EQ(model.particles.size(), 1u);
  EXPECT_EQ(stream.insertion.inserted, 1);
  EXPECT_NEAR(model.particles.v[0].z, -1.0 - 10.0 * 0.25, 1e-9);
  EXPECT_NEAR(model.particles.x[0].z, 0.05 - 0.25 - 5.0 * 0.0625, 1e-9);
  EXPECT_NEAR(model.entered.mass, mass, 1e-12);
  EXPECT_NEAR(model.entered.momentum.z, -mass, 1e-12);
  EXPECT_NEAR(model.booked.entered, mass * (0.5 + 0.5) + 0.2 * mass * 0.0025 * 9.0, 1e-6);
  EXPECT_NEAR(energies(model).balance(), 0.0, 1e-9);
}

TEST(Insertions, OfClumpsBookEachBodyOnce) {
  Model model;
  model.laws = makeContactLaws(frictional);
  model.gravity = {0, 0, -10};
  const ClumpShape rod =
      makeClumpShape(std::vector<Vec3>{{0, 0, 0}, {0.06, 0, 0}}, std::vector<double>{0.03, 0.03}, Density{1000.0});
  addInsertion(model, {.region = {{0, 0, 0}, {1, 1, 1}},
                       .sizes = UniformSizes{1, 1},
                       .shapes = {rod},
                       .velocity = {0, 0, -1},
                       .numberPerSecond = 100.0});
  run(model, 1e-3, 95);
  const BodyTerm& rigid = bodies(model);
  ASSERT_EQ(rigid.bodies.size(), 9u);
  EXPECT_EQ(model.entered.count, 9);
  EXPECT_NEAR(model.entered.mass, 9.0 * rod.properties.mass, 1e-12);
  EXPECT_NEAR(energies(model).balance(), 0.0, 1e-6);
}

/// Grains that fall past an obstacle, leave at the bottom, and enter again at the top of a column with periods aside.
Model circulation() {
  Model model;
  model.laws = makeContactLaws(frictional);
  model.gravity = {0, 0, -9.81};
  model.pairs.setSkin(0.01);
  model.sortEvery = 3;
  model.pairs.setPeriodicity({{{0, 0, 0}, {0.5, 0.5, 1}}, {true, true, false}});
  Random random(5);
  for (int i = 0; i < 75; ++i)
    addParticle(model.particles, {0.1 * (i % 5), 0.1 * (i / 5 % 5), 0.25 + 0.11 * (i / 25)}, random.vector(0.5),
                0.03 + 0.015 * random(0.0, 1.0), Density{1000.0});
  switchOnRotation(model.particles);
  addWall(model, makeSphere({0.25, 0.25, 0.1}, 0.1, false));
  addOutlet(model, HalfSpace{{0, 0, 0}, {0, 0, -1}});
  addInsertion(model, {.region = {{0, 0, 0.7}, {0.5, 0.5, 1.0}},
                       .sizes = UniformSizes{0.03, 0.045},
                       .density = {1000.0},
                       .velocity = {0, 0, -0.5},
                       .replacesLeavers = true});
  return model;
}

TEST(Streams, GrainsThatCirculateOverAHundredRenewalsKeepTheLedgerAndTheirContacts) {
  Model model = circulation();
  const double start = energies(model).balance(), dt = 1e-4;
  std::int64_t both = 0;  // steps in which as many entered as left
  while (model.listUpdates < 100 || both <= 20) {
    const Exchanged left = model.left, entered = model.entered;
    run(model, dt, 1);
    both += model.left.count > left.count && model.entered.count - entered.count == model.left.count - left.count;
    ASSERT_LT(model.steps, 100000);
    if (model.steps % 50 != 0) continue;
    std::size_t touching = 0;  // by brute force
    for (std::size_t i = 0; i < model.particles.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        touching += norm(model.pairs.periodicity().minimumImage(model.particles.x[i] - model.particles.x[j])) <
                    model.particles.radius[i] + model.particles.radius[j];
    EXPECT_EQ(model.laws->sample(model.particles, model.pairs).size(), touching);
  }
  EXPECT_EQ(static_cast<std::int64_t>(model.particles.size()), 75 + model.entered.count - model.left.count);
  EXPECT_GE(model.particles.size(), 70u);
  const Energies e = energies(model);
  EXPECT_NEAR(e.balance(), start, 0.02 * e.lost.lostPower());
}

TEST(Streams, CirculationIsTheSameForAnyThreadsAndFromACheckpoint) {
  const io::test::ScratchFolder scratch;
  const auto path = scratch / "dovetail_streams.ckp";
  std::vector<Vec3> once;
  for (const int count : {1, 2, 3}) {
    setThreads(count);
    Model model = circulation();
    for (int s = 0; s < 3001; ++s) {
      advance(model, 1e-4);
      if (count != 3 || s != 1500) continue;
      writeCheckpoint(path, model);
      Model other = circulation();
      readCheckpoint(path, other);
      model = other;
    }
    close(model);
    EXPECT_GT(model.left.count, 5);
    if (once.empty()) once = model.particles.x;
    EXPECT_TRUE(model.particles.x == once) << count;
  }
  setThreads(1);
}

}  // namespace
}  // namespace dovetail::dem
