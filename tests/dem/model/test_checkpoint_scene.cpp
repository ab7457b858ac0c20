// One scene with every term at once, saved at an odd step; and what a restart refuses.
#include <gtest/gtest.h>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <algorithm>
#include <filesystem>
#include <limits>

#include "../../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/streams.hpp"
#include "laws/own_law.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

using RollingLaw = ContactLaw<LinearSpringDashpot, TangentialSpring, RollingAndTwisting>;

RollingLaw rolling(double friction) {
  return {{.stiffness = 2e4, .restitution = 0.6},
          {.stiffness = 6e3, .friction = friction, .dampingRatio = 0.2},
          {{0.1, 0.1, 0.1}, {0.02, 0.1, 0.1}},
          {}};
}

std::shared_ptr<const ContactLaws> table(double friction) {
  LawTable<RollingLaw> laws(2, rolling(0.4));
  laws.set(0, 1, rolling(friction));
  return makeContactLaws(laws);
}

ClumpShape rod() {
  return makeClumpShape(std::vector<Vec3>{{0, 0, 0}, {0.03, 0, 0}}, std::vector<double>{0.035, 0.035}, Density{1000.0});
}

void addGrains(Model& m) {
  Random random(6);
  for (int i = 0; i < 300; ++i) {
    const Vec3 x{0.1 * (i % 10), 0.1 * (i / 10 % 6), 0.06 + 0.1 * (i / 60)}, v = random.vector(0.3);
    if (i % 10 == 5)
      addClump(m, rod(), x, fromRotationVector(random.vector(3.0)), v, random.vector(3.0));
    else
      addParticle(m.particles, x, v, random(0.04, 0.05), Density{1000.0});
  }
  switchOnRotation(m.particles);
  m.particles.material.resize(m.particles.size());
  for (std::size_t i = 0; i < m.particles.size(); ++i) m.particles.material[i] = i % 3 == 0;
}

void addBonds(Model& m) {
  BondMaterial material{.youngsModulus = 2e5, .tensileStrength = 2e3, .shearStrength = 2e3, .dampingTime = 1e-4};
  PairList near;
  near.setPeriodicity(m.pairs.periodicity());
  near.setSkin(0.005);
  findPairs(m.particles, near);
  for (std::size_t p = 0; p < near.size(); p += 7)
    addBond(bonds(m), m.particles, near.periodicity(), near.pairs()[p][0], near.pairs()[p][1], material);
  m.terms.all<BondTerm>()[0]->mutesContacts = true;
}

void addWalls(Model& m) {
  addWall(m, makePlane({}, {0, 0, 1})).material = 1;
  PrimitiveWall& lid = addWall(m, makePlane({0, 0, 0.9}, {0, 0, -1}));
  lid.servo = makeServo({0, 0, -1}, 20.0, 1.0, 5.0);
  PrimitiveWall& stirrer = addWall(m, makeCylinder({0.5, 0.3, -0.02}, {0, 1, 0}, 0.03, false));
  stirrer.motion = [](double time, PrimitiveWall& w) { w.velocity.x = 0.3 * std::cos(20.0 * time); };
  MeshWall& ramp = addWall(m, MeshWall{});
  ramp.wall = squares(4, 2, 0.2);
  for (Vec3& x : ramp.wall.x) x.z = 0.56 + 0.1 * x.x;
  MeshWall& paddle = addWall(m, MeshWall{});
  paddle.wall = squares(2, 2, 0.1);
  for (Vec3& x : paddle.wall.x) x += Vec3{0.3, 0.2, 0.52};
  prescribe(paddle, vibration({{0.3, 0.2, 0.52}, {}, {}, {}}, {0.02, 0, 0.02}, 10.0, 3.0), {0.3, 0.2, 0.52});
}

/// All terms at once, with periods, sorting, a domain and a table of laws.
Model everything() {
  Model m;
  m.laws = table(0.6);
  m.gravity = {2, 0, -9.81};
  m.sortEvery = 2;
  m.pairs.setSkin(0.012);
  m.pairs.setPeriodicity({{{0, 0, 0}, {1, 0.6, 1}}, {true, true, false}});
  m.domain = Domain{{{-1, -1, -0.5}, {2, 2, 2}}, EscapePolicy::remove};
  addGrains(m);
  addBonds(m);
  addWalls(m);
  damping(m).viscousRate = 0.2;
  damping(m).local = 0.05;
  m.terms.add(ExternalForceTerm("wind", [](const Particles& p, double time, std::span<Vec3> f) {
    for (std::size_t i = 0; i < p.size(); ++i) f[i].y += 0.1 * std::sin(9.0 * time) * p.mass[i];
  }));
  m.terms.add(DriveTerm(
      {3},
      [](double t) {
        return Vec3{0, 0, 0.05 * std::sin(8.0 * t)};
      },
      [](double t) {
        return Vec3{0, 0, 0.4 * std::cos(8.0 * t)};
      }));
  addOutlet(m, geometry::Box{{0.72, 0.22, 0.0}, {0.9, 0.38, 0.3}}).every = 3;
  addInsertion(m, {.region = {{0, 0, 0.7}, {1, 0.6, 0.8}},
                   .sizes = UniformSizes{0.03, 0.04},
                   .density = {1000.0},
                   .velocity = {0, 0, -3.0},
                   .spin = {1, 2, 0},
                   .material = 1,
                   .numberPerSecond = 400.0});
  return m;
}

constexpr double dt = 1e-4;

TEST(CheckpointScene, OfEveryTermGoesOnToTheLastBitForAnyThreads) {
  const io::test::ScratchFolder scratch;
  const auto path = scratch / "dovetail_everything.ckp";
  std::vector<char> once;
  for (const int count : {1, 2, 3}) {
    setThreads(count);
    Model m = everything();
    const std::size_t bonded = bonds(m).size();
    for (int s = 0; s < 601; ++s) advance(m, dt);  // open: half a kick is still to be made
    EXPECT_LT(bonds(m).size(), bonded);
    EXPECT_GT(bonds(m).size(), 0u);
    EXPECT_GT(m.entered.count, 3);
    EXPECT_GT(m.left.count, 0);
    EXPECT_GT(m.listUpdates, 4);
    EXPECT_NE(m.booked.lifted, 0.0);
    EXPECT_GT(meshWall(m, 0).contacts.size() + meshWall(m, 1).contacts.size(), 0u);
    EXPECT_GT(primitiveWall(m, 2).contacts.size(), 0u);
    writeCheckpoint(path, m);
    Model resumed = everything();
    readCheckpoint(path, resumed);
    EXPECT_TRUE(saveState(resumed) == saveState(m)) << count;
    for (Model* model : {&m, &resumed}) {
      for (int s = 0; s < 300; ++s) advance(*model, dt);
      close(*model);
    }
    EXPECT_TRUE(saveState(resumed) == saveState(m)) << count;
    if (once.empty()) once = saveState(m);
    EXPECT_TRUE(saveState(m) == once) << count;
  }
  setThreads(1);
}

#if defined(__GLIBC__)
TEST(CheckpointScene, TheSameStateIsTheSameBytesWhateverMemoryHeldBefore) {
  const auto state = [](int fill) {
    mallopt(M_PERTURB, fill);
    Model m = everything();
    m.domain.reset();
    m.pairs.setSkin(std::nullopt);
    run(m, dt, 51);
    const std::vector<char> bytes = saveState(m);
    mallopt(M_PERTURB, 0);
    return bytes;
  };
  EXPECT_TRUE(state(0x11) == state(0xEE));
}
#endif

/// What reading the checkpoint of `everything` into a model that differs says.
template <class Change>
std::string refusal(Change&& change) {
  static const io::test::ScratchFolder scratch;
  static const auto path = [] {
    const auto file = scratch / "dovetail_refusals.ckp";
    Model m = everything();
    run(m, dt, 3);
    writeCheckpoint(file, m);
    return file;
  }();
  Model m = everything();
  change(m);
  const std::vector<char> before = saveState(m);
  try {
    readCheckpoint(path, m);
  } catch (const InputError& error) {
    EXPECT_TRUE(saveState(m) == before);
    return error.what();
  }
  return "nothing";
}

void expectSaid(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text << " lacks " << part;
}

/// Puts a term in the place of the first of its type.
template <class T>
void without(Model& m) {
  m.terms.remove(*m.terms.all<T>().at(0));
}

TEST(CheckpointRefusals, NothingIsRefusedWhereAllIsThere) {
  EXPECT_EQ(refusal([](Model&) {}), "nothing");
}

TEST(CheckpointRefusals, EveryMissingTermIsNamed) {
  expectSaid(refusal([](Model& m) { without<BondTerm>(m); }), "'bonds'");
  expectSaid(refusal([](Model& m) { without<DampingTerm>(m); }), "'damping'");
  expectSaid(refusal([](Model& m) { without<BodyTerm>(m); }), "'bodies'");
  expectSaid(refusal([](Model& m) { without<OutletTerm>(m); }), "'outlet'");
  expectSaid(refusal([](Model& m) { without<InsertionTerm>(m); }), "'insertion'");
  expectSaid(refusal([](Model& m) { without<DriveTerm>(m); }), "'drive'");
  expectSaid(refusal([](Model& m) { without<ExternalForceTerm>(m); }), "'wind'");
  expectSaid(refusal([](Model& m) { without<PrimitiveWallTerm>(m); }), "'walls'");
  expectSaid(refusal([](Model& m) { without<MeshWallTerm>(m); }), "'mesh walls'");
  expectSaid(refusal([](Model& m) { addOutlet(m, HalfSpace{{0, 0, 5}, {0, 0, 1}}); }), "'outlet'");
}

TEST(CheckpointRefusals, WhatIsCodeIsNamedWhereItIsMissingOrNew) {
  expectSaid(refusal([](Model& m) { m.terms = Terms(); }), "a motion");
  expectSaid(refusal([](Model& m) { primitiveWall(m, 2).motion = nullptr; }), "a motion");
  expectSaid(refusal([](Model& m) { primitiveWall(m, 0).motion = [](double, PrimitiveWall&) {}; }), "a motion");
  expectSaid(refusal([](Model& m) { meshWall(m, 1).motion = AtRest{}; }), "a motion");
  expectSaid(refusal([](Model& m) { meshWall(m, 0).motion = MovedByOthers{0.0}; }), "somebody who moves it");
  const std::string other = refusal([](Model& m) {
    without<ExternalForceTerm>(m);
    m.terms.add(ExternalForceTerm("magnet", [](const Particles&, double, std::span<Vec3>) {}));
  });
  expectSaid(other, "'wind'");
}

TEST(CheckpointRefusals, TermsOfCodeAloneAreNamedWithIt) {
  const io::test::ScratchFolder scratch;
  const auto path = scratch / "dovetail_code_alone.ckp";
  const auto alone = [&](auto&& add) {
    Model m;
    m.laws = table(0.6);
    addParticle(m.particles, {}, {}, 0.05, Mass{1.0});
    add(m);
    writeCheckpoint(path, m);
    Model empty;
    empty.laws = m.laws;
    try {
      readCheckpoint(path, empty);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  expectSaid(alone([](Model& m) { m.terms.add(ExternalForceTerm("wind", {})); }), "'wind' needs");
  expectSaid(alone([](Model& m) { m.terms.add(ExternalForceTerm("wind", {})); }), "a force");
  expectSaid(alone([](Model& m) { m.terms.add(DriveTerm({0}, {}, {})); }), "a path");
  expectSaid(alone([](Model& m) {
               addInsertion(m, {.region = {{0, 0, 0}, {1, 1, 1}},
                                .sizes = UniformSizes{0.1, 0.1},
                                .density = {1.0},
                                .numberPerSecond = 1.0});
             }),
             "settings of an insertion");
  EXPECT_EQ(alone([](Model& m) { damping(m).local = 0.1; }), "nothing");
}

TEST(CheckpointRefusals, OtherLawsAndOtherMeshesAre) {
  expectSaid(refusal([](Model& m) { m.laws = table(0.61); }), "parameters of the laws");
  expectSaid(refusal([](Model& m) { m.laws = makeContactLaws(rolling(0.4)); }), "parameters of the laws");
  expectSaid(refusal([](Model& m) { m.laws = makeContactLaws(ElasticLaw{{2e4}}); }), "rolling and twisting");
  expectSaid(refusal([](Model& m) { m.laws = makeOwnLaws({{1e9}, {0.8, 0.4}}); }), "a part of one's own");
  expectSaid(refusal([](Model& m) { m.laws.reset(); }), "'none'");
  expectSaid(refusal([](Model& m) { meshWall(m, 0).wall.x[3].z += 1e-9; }), "another one");
  expectSaid(refusal([](Model& m) { std::swap(meshWall(m, 0).wall.facets[0], meshWall(m, 0).wall.facets[1]); }),
             "another one");
}

/// What is said of a state whose bytes are whole, but not what they hold.
template <class Damage>
std::string refusalOfDamaged(Damage&& damage) {
  static const Model whole = [] {
    Model m = everything();
    run(m, dt, 600);
    return m;
  }();
  Model m = whole;
  damage(m);
  Model resumed = everything();
  const std::vector<char> before = saveState(resumed);
  try {
    loadState(saveState(m), "state", resumed);
  } catch (const InputError& error) {
    EXPECT_TRUE(saveState(resumed) == before);
    return error.what();
  }
  return "nothing";
}

constexpr double notANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

TEST(DamagedStates, WholeOnesAreNotRefused) {
  EXPECT_EQ(refusalOfDamaged([](Model&) {}), "nothing");
}

TEST(DamagedStates, ParticlesWithoutNumbersAreNamed) {
  expectSaid(refusalOfDamaged([](Model& m) { m.particles.v[7].y = notANumber; }), "velocity");
  expectSaid(refusalOfDamaged([](Model& m) { m.particles.x[7].y = infinite; }), "position");
  expectSaid(refusalOfDamaged([](Model& m) { m.particles.omega[7].y = notANumber; }), "angular velocity");
  expectSaid(refusalOfDamaged([](Model& m) { m.particles.mass[7] = -1.0; }), "mass");
  expectSaid(refusalOfDamaged([](Model& m) { m.particles.f[7].x = notANumber; }), "force");
  expectSaid(refusalOfDamaged([](Model& m) { m.particles.torque.pop_back(); }), "torque");
}

TEST(DamagedStates, EnumerationsStandForSomething) {
  for (const int wrong : {-1, 2, 1 << 20}) {
    const std::string number = std::to_string(wrong);
    expectSaid(refusalOfDamaged([&](Model& m) { m.rotation = static_cast<Rotation>(wrong); }), number);
    expectSaid(refusalOfDamaged([&](Model& m) { m.booking = static_cast<Booking>(wrong); }), number);
    expectSaid(refusalOfDamaged([&](Model& m) { m.domain->policy = static_cast<EscapePolicy>(wrong); }), number);
  }
  expectSaid(refusalOfDamaged([](Model& m) { m.terms.all<InsertionTerm>()[0]->insertion.nextShape = 5; }),
             "no shape 5");
}

TEST(DamagedStates, ContactsOfPrimitiveWallsAreLookedAt) {
  const auto contacts = [](auto&& damage) {
    return refusalOfDamaged([&](Model& m) { damage(primitiveWall(m, 0).contacts); });
  };
  expectSaid(contacts([](PrimitiveContacts& c) { c.overlap.at(0) = notANumber; }), "not finite");
  expectSaid(contacts([](PrimitiveContacts& c) { c.normal.at(0).z = infinite; }), "not finite");
  expectSaid(contacts([](PrimitiveContacts& c) { c.memory.at(0) = notANumber; }), "not finite");
  expectSaid(contacts([](PrimitiveContacts& c) { c.memory.pop_back(); }), "do not fit");
  expectSaid(contacts([](PrimitiveContacts& c) { c.force.pop_back(); }), "do not fit");
  expectSaid(contacts([](PrimitiveContacts& c) { c.particle.back() = 1 << 24; }), "no particle 16777216");
  expectSaid(contacts([](PrimitiveContacts& c) { c.particle.at(0) = -1; }), "no particle -1");
}

TEST(DamagedStates, ContactsOfMeshWallsAreLookedAt) {
  const auto contacts = [](auto&& damage) {
    return refusalOfDamaged([&](Model& m) {
      for (const std::size_t k : {0, 1})
        if (meshWall(m, k).contacts.size() > 0) return damage(meshWall(m, k).contacts);
      FAIL() << "nobody touches a mesh wall";
    });
  };
  expectSaid(contacts([](WallContacts& c) { c.engagement.at(0) = notANumber; }), "not finite");
  expectSaid(contacts([](WallContacts& c) { c.weight.at(0)[1] = notANumber; }), "not finite");
  expectSaid(contacts([](WallContacts& c) { c.force.at(0).x = infinite; }), "not finite");
  expectSaid(contacts([](WallContacts& c) { c.normal.pop_back(); }), "do not fit");
  expectSaid(contacts([](WallContacts& c) { c.facet.at(0) = 1 << 24; }), "no facet 16777216");
  expectSaid(contacts([](WallContacts& c) { c.particle.back() = 1 << 24; }), "no particle 16777216");
  expectSaid(contacts([](WallContacts& c) { c.springs.particle.at(0) = 1 << 24; }), "no particle 16777216");
  expectSaid(contacts([](WallContacts& c) { c.springs.memory.at(0) = notANumber; }), "not finite");
  expectSaid(contacts([](WallContacts& c) { c.springs.fraction.clear(); }), "do not fit");
}

}  // namespace
}  // namespace dovetail::dem
