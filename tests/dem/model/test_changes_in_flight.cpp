// Laws, walls and particles that change between steps; terms that enter within one; models that lack something.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>

#include "../../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/streams.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

FrictionalLaw rough(double stiffness = 1e4) { return {{stiffness, 0.5}, {0.3 * stiffness, 0.4, 0.2}, {}, {}}; }

Model oneOnFloor(std::shared_ptr<const ContactLaws> laws) {
  Model m;
  m.laws = std::move(laws);
  m.gravity = {0, 0, -10.0};
  addParticle(m.particles, {0, 0, 0.099}, {}, 0.1, Mass{1.0});
  addWall(m, makePlane({}, {0, 0, 1}));
  return m;
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

ClumpShape rod() {
  return makeClumpShape(std::vector<Vec3>{{}, {0.03, 0, 0}}, std::vector<double>{0.02, 0.02}, Density{1000.0});
}

TEST(ChangesInFlight, ParticlesRollWhenLawsBeginToRub) {
  Model m = oneOnFloor(makeContactLaws(ElasticLaw{{1e4, 0.5}}));
  m.particles.v[0].x = 0.1;
  run(m, 1e-4, 100);
  EXPECT_FALSE(m.particles.rotates());
  m.laws = makeContactLaws(rough());
  run(m, 1e-4, 5000);
  ASSERT_TRUE(m.particles.rotates());
  EXPECT_NEAR(m.particles.v[0].x, 0.1 * 5.0 / 7.0, 1e-3);
}

TEST(ChangesInFlight, AStepThatNewLawsDoNotBearIsRefused) {
  Model m = oneOnFloor(makeContactLaws(ElasticLaw{{1e4}}));
  run(m, 1e-3, 10);
  m.laws = makeContactLaws(ElasticLaw{{1e8}});
  EXPECT_NE(refusal([&] { run(m, 1e-3, 1); }).find("exceeds the critical step"), std::string::npos);
}

/// Spheres that friction holds on a slope, on a floor of either kind.
Model onSlope(bool triangles) {
  Model m;
  m.laws = makeContactLaws(rough());
  m.gravity = {2.0, 0, -10.0};
  m.rotation = Rotation::off;
  m.sortEvery = 0;
  for (int i = 0; i < 9; ++i) addParticle(m.particles, {0.3 * i + 0.15, 0.15, 0.0995}, {}, 0.1, Mass{1.0 + 0.1 * i});
  if (triangles)
    addWall(m, MeshWall{}).wall = squares(9, 2, 0.3);
  else
    addWall(m, makePlane({}, {0, 0, 1}));
  return m;
}

/// Also by laws that remember nothing.
TEST(ChangesInFlight, SpringsOfPairsDoNotOutliveTheirLaw) {
  Model m;
  m.laws = makeContactLaws(rough());
  addParticle(m.particles, {}, {0.0, 0.05, 0.0}, 0.1, Mass{1.0});
  addParticle(m.particles, {0.19, 0.0, 0.0}, {}, 0.1, Mass{1.0});
  run(m, 1e-4, 20);
  ASSERT_GT(m.work.tangentialEnergy, 0.0);
  m.laws = makeContactLaws(ElasticLaw{{1e4}});
  run(m, 1e-4, 1);
  EXPECT_TRUE(m.pairs.memory().empty());
  m.particles.v[0] = m.particles.v[1] = {};
  m.laws = makeContactLaws(rough());
  findForces(m);
  EXPECT_LT(m.work.tangentialEnergy, 1e-100);
}

TEST(ChangesInFlight, WhatOtherLawsRememberedIsForgottenNotMistaken) {
  using Rolling = ContactLaw<LinearSpringDashpot, TangentialSpring, RollingAndTwisting>;
  for (const bool triangles : {false, true}) {
    Model m = onSlope(triangles);
    run(m, 1e-4, 3000);
    m.laws = makeContactLaws(Rolling{{1e4, 0.5}, {3e3, 0.4, 0.2}, {{0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}}, {}});
    m.gravity = {0, 0, -10.0};
    for (Vec3& v : m.particles.v) v = {};
    run(m, 1e-4, 1);
    for (const Vec3& v : m.particles.v) EXPECT_NEAR(v.x, 0.0, 1e-12) << triangles;  // springs start without stretch
  }
}

/// Three numbers per contact with a wall are velocities to the first law and a spring to the second.
TEST(ChangesInFlight, VelocitiesOfWallContactsAreNotTakenForSprings) {
  for (const bool triangles : {false, true}) {
    Model m = onSlope(triangles);
    m.laws = makeContactLaws(ElasticLaw{{1e4, 0.5}});
    run(m, 1e-4, 300);
    ASSERT_GT(m.particles.v[0].x, 0.01);
    m.laws = makeContactLaws(FrictionalLaw{{1e4}, {3e3, 0.4}, {}, {}});
    findForces(m);
    EXPECT_LT(m.work.tangentialEnergy, 1e-100) << triangles;
    EXPECT_EQ(m.booked.lost.frictionPower, 0.0) << triangles;
  }
}

TEST(ChangesInFlight, SpringsStayWhenDashpotsComeOrGo) {
  const std::array laws{makeContactLaws(rough()), makeContactLaws(FrictionalLaw{{1e4}, {3e3, 0.4}, {}, {}})};
  for (const bool triangles : {false, true}) {
    Model m = onSlope(triangles);
    addParticle(m.particles, {0.15, 0.15, 0.2985}, {0.0, 0.01, 0.0}, 0.1, Mass{1.0});  // on the first
    m.laws = laws[0];
    run(m, 1e-4, 300);
    const double before = m.work.tangentialEnergy;
    ASSERT_GT(before, 1e-7);
    for (const std::size_t next : {1, 0}) {
      m.laws = laws[next];
      findForces(m);
      EXPECT_NEAR(m.work.tangentialEnergy, before, 1e-12 * before) << triangles << next;
    }
  }
}

/// Springs against sliding and against rolling take as many numbers.
TEST(ChangesInFlight, SpringsOfOnePartAreNotTakenForThoseOfAnother) {
  using Rolling = ContactLaw<LinearSpringDashpot, NoTangential, RollingAndTwisting>;
  static_assert(Rolling::memory != FrictionalLaw::memory || Rolling::memoryKind != FrictionalLaw::memoryKind);
  static_assert(ContactLaw<LinearSpringDashpot>::memoryKind == 0);
  PairList list;
  Particles particles;
  for (const double x : {0.0, 1.9}) addParticle(particles, {x, 0, 0}, {}, 1.0, Mass{1.0});
  findPairs(particles, list);
  const auto fill = [&](unsigned kind) {
    for (double& number : list.prepareMemory(3, 7, kind)) number = 1.0;
  };
  fill(FrictionalLaw::memoryKind);
  EXPECT_EQ(list.prepareMemory(3, 7, FrictionalLaw::memoryKind)[0], 1.0);
  EXPECT_EQ(list.prepareMemory(3, 7, FrictionalLaw::memoryKind << 4)[0], 0.0);
}

TEST(ChangesInFlight, WallsThatComeLaterAreChecked) {
  Model m = oneOnFloor(makeContactLaws(rough()));
  run(m, 1e-4, 10);
  addWall(m, makePlane({0, 0, -0.05}, {0, 0, 1})).axis = {0, 0, 5};
  EXPECT_NE(refusal([&] { run(m, 1e-4, 1); }).find("no unit vector"), std::string::npos);
}

TEST(ChangesInFlight, AParticleAddedAmidRunsFallsFreeFromThatMoment) {
  Model m = oneOnFloor(makeContactLaws(rough()));
  for (int i = 0; i < 100; ++i) advance(m, 1e-4);
  addParticle(m.particles, {1, 0, 5}, {}, 0.1, Mass{1.0});
  for (int i = 0; i < 100; ++i) advance(m, 1e-4);
  close(m);
  EXPECT_NEAR(m.particles.v[1].z, -0.1, 1e-13);
}

TEST(ChangesInFlight, BondsMuteContactsFromTheStepInWhichTheyAreAdded) {
  Model m;
  m.laws = makeContactLaws(rough());
  for (const double x : {0.0, 0.199}) addParticle(m.particles, {x, 0, 0}, {}, 0.1, Mass{1.0});
  run(m, 1e-4, 1);
  addBond(bonds(m), m.particles, {}, 0, 1, {.youngsModulus = 1e4, .tensileStrength = 1e9, .shearStrength = 1e9});
  m.terms.all<BondTerm>()[0]->mutesContacts = true;
  run(m, 1e-4, 1);
  EXPECT_EQ(m.pairs.factor(0), 0.0);
}

TEST(ChangesInFlight, ARestartGoesOnAsIfALawOrAWallHadJustChanged) {
  const io::test::ScratchFolder scratch;
  const auto path = scratch / "dovetail_changes.ckp";
  Model m = oneOnFloor(makeContactLaws(rough()));
  m.particles.v[0].x = 0.3;
  for (int i = 0; i < 101; ++i) advance(m, 1e-4);
  m.laws = makeContactLaws(rough(2e4));
  addWall(m, makePlane({0.1, 0, 0}, {-1, 0, 0}));
  Model other = m;
  writeCheckpoint(path, m);
  readCheckpoint(path, other);
  for (Model* one : {&m, &other}) run(*one, 1e-4, 200);
  EXPECT_EQ(saveState(m), saveState(other));
}

TEST(ModelsThatLackSomething, AreToldSo) {
  const auto lawless = [](const std::function<void(Model&)>& add) {
    Model m;
    add(m);
    return refusal([&] { run(m, 1e-4, 10); });
  };
  const std::string expected = "no contact laws";
  EXPECT_NE(lawless([](Model& m) { addWall(m, makePlane({}, {0, 0, 1})); }).find(expected), std::string::npos);
  EXPECT_NE(lawless([](Model& m) { addWall(m, MeshWall{}).wall = squares(1, 1, 1.0); }).find(expected),
            std::string::npos);
  EXPECT_NE(lawless([](Model& m) {
              addInsertion(m, {.region = {{0, 0, 0}, {1, 1, 1}},
                               .sizes = UniformSizes{0.03, 0.04},
                               .density = {1000.0},
                               .numberPerSecond = 1.0});
            }).find(expected),
            std::string::npos);
}

TEST(ModelsThatLackSomething, MembersOfClumpsAreNeitherDrivenAloneNorWeighed) {
  Model m;
  m.laws = makeContactLaws(rough());
  addClump(m, rod(), {});
  m.particles.weight = {0.5, 0.5};
  EXPECT_NE(refusal([&] { run(m, 1e-4, 1); }).find("weight 1"), std::string::npos);
  m.particles.weight = {1.0, 1.0};
  run(m, 1e-4, 1);
  const auto still = [](double) { return Vec3{}; };
  m.terms.add(DriveTerm({0}, still, still));
  EXPECT_NE(refusal([&] { run(m, 1e-4, 1); }).find("others not"), std::string::npos);
}

InsertionOptions rods() {
  InsertionOptions s{.region = {{0, 0, 0.4}, {0.6, 0.6, 0.55}}, .sizes = UniformSizes{0.02, 0.03}, .density = {1000.0}};
  s.shapes = {rod()};
  s.numberPerSecond = 1000.0;
  return s;
}

/// As many terms as their list has room for, so that one more moves them.
Model rodsFallOut(bool byHand) {
  Model m;
  m.laws = makeContactLaws(rough());
  m.gravity = {0, 0, -10.0};
  if (byHand)
    m.terms.add(InsertionTerm(rods()));
  else
    addInsertion(m, rods());
  addOutlet(m, HalfSpace{{0, 0, 0.1}, {0, 0, -1}});
  return m;
}

TEST(StreamsOfClumps, NeedNoBodiesFromTheStart) {
  for (const bool byHand : {true, false}) {
    Model m = rodsFallOut(byHand);
    const double before = energies(m).balance();
    run(m, 1e-4, 3000);
    EXPECT_GT(m.left.count, 0);
    EXPECT_NEAR(energies(m).balance(), before, 1e-3 * energies(m).kinetic);
  }
}

TEST(StreamsOfClumps, GoOnFromACheckpointInAModelThatIsSetUpAnew) {
  const io::test::ScratchFolder scratch;
  const auto path = scratch / "dovetail_rods.ckp";
  Model m = rodsFallOut(false), other = rodsFallOut(false);
  for (int i = 0; i < 501; ++i) advance(m, 1e-4);
  writeCheckpoint(path, m);
  readCheckpoint(path, other);
  for (Model* one : {&m, &other}) run(*one, 1e-4, 500);
  EXPECT_EQ(saveState(m), saveState(other));
}

/// Two that have yet to meet.
TEST(CriticalStep, IsKnownBeforeTheFirstStep) {
  Model m;
  m.laws = makeContactLaws(rough());
  m.pairs.setSkin(0.1);
  addParticle(m.particles, {}, {}, 0.1, Mass{1.0});
  addParticle(m.particles, {0.25, 0, 0}, {}, 0.1, Mass{1.0});
  const double before = criticalStep(m, 1e-3).dt;
  findForces(m);
  EXPECT_EQ(before, criticalStep(m, 1e-3).dt);
  EXPECT_LT(before, 0.1);
}

}  // namespace
}  // namespace dovetail::dem
