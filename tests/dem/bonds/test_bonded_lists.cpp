// Lists of a law that bonds their pairs stay when particles come and go.
#include <gtest/gtest.h>

#include <filesystem>

#include "../../io/scratch_folder.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

constexpr int beads = 700;  // of the ring: several chunks
constexpr double radius = 0.05, pitch = 0.1, dt = 1e-4;

/// A chain of bonded beads that closes through the period, with `loners` beside it that belong to no pair, before and
/// behind the beads in number.
Model ring(int loners) {
  ElasticLaw law{{.stiffness = 1e4}};
  law.normal.bonded = true;
  Model model;
  model.laws = makeContactLaws(law);
  model.pairs.setPeriodicity({{{0, 0, 0}, {pitch * beads, 10, 10}}, {true, false, false}});
  const auto alone = [&](int i) { addParticle(model.particles, {1.0 * i, 5, 5}, {}, radius, Mass{1.0}); };
  for (int i = 0; i < loners; ++i) alone(i);
  Random random(2);
  for (int i = 0; i < beads; ++i)
    addParticle(model.particles, {pitch * i, 1, 1}, random.vector(0.3), radius, Mass{1.0 + 0.5 * (i % 2)});
  for (int i = 0; i < loners; ++i) alone(10 + i);
  model.pairs.setSkin(0.01);
  findPairs(model.particles, model.pairs);
  EXPECT_EQ(model.pairs.size(), static_cast<std::size_t>(beads));
  EXPECT_EQ(model.pairs.images().size(), 1u);
  return model;
}

std::vector<Vec3> beadsOf(const Model& model, int loners) {
  std::vector<Vec3> x;
  for (int i = 0; i < beads; ++i)
    x.push_back(model.particles.x[static_cast<std::size_t>(find(model.particles, loners + i))]);
  return x;
}

TEST(BondedLists, KeepTheirBondsWhenOthersLeaveAndEnter) {
  Model alone = ring(0), disturbed = ring(3);
  run(alone, dt, 100);
  run(disturbed, dt, 30);
  for (int i = 0; i < 1500; ++i)  // more chunks than there were
    addParticle(disturbed.particles, {0.2 * i, 8, 8}, {}, radius, Mass{1.0});
  run(disturbed, dt, 30);
  removeParticles(disturbed, std::vector<int>{0, 2, beads + 3});
  run(disturbed, dt, 40);
  EXPECT_EQ(disturbed.pairs.size(), static_cast<std::size_t>(beads));
  const std::vector<Vec3> wanted = beadsOf(alone, 0), got = beadsOf(disturbed, 3);
  double worst = 0.0;
  for (std::size_t i = 0; i < wanted.size(); ++i) worst = std::max(worst, norm(wanted[i] - got[i]));
  EXPECT_LE(worst, 1e-12);
  const Energies e = energies(disturbed);
  EXPECT_NEAR(e.balance(), energies(ring(3)).balance(), 1e-3 * e.kinetic);
}

TEST(BondedLists, OfWhichBeadsLeaveAreTheSameForAnyThreadsAndFromACheckpoint) {
  const io::test::ScratchFolder scratch;
  const auto path = scratch / "dovetail_bonded_list.ckp";
  std::vector<Vec3> once;
  for (const int count : {1, 2, 3}) {
    setThreads(count);
    Model model = ring(1);
    run(model, dt, 20);
    std::vector<int> third;
    for (int i = 0; i < beads; i += 3) third.push_back(i);
    removeParticles(model, third);
    run(model, dt, 20);
    if (count == 3) {
      writeCheckpoint(path, model);
      Model other;
      other.laws = model.laws;
      readCheckpoint(path, other);
      model = other;
    }
    run(model, dt, 20);
    EXPECT_LT(model.pairs.size(), static_cast<std::size_t>(beads / 2));
    EXPECT_EQ(model.pairs.chunks().begin.size(), (model.particles.size() + 255) / 256 + 1);
    if (once.empty()) once = model.particles.x;
    EXPECT_TRUE(model.particles.x == once) << count;
  }
  setThreads(1);
}

TEST(BondedLists, WallsSeeTheirParticlesComeFromAfar) {
  ElasticLaw law{{.stiffness = 1e4}};
  law.normal.bonded = true;
  Model model;
  model.laws = makeContactLaws(law);
  for (int i = 0; i < 3; ++i) addParticle(model.particles, {pitch * i, 0, 0.5}, {0, 0, -1}, radius, Mass{1.0});
  addWall(model, makePlane({0, 0, 0}, {0, 0, 1}));
  run(model, 1e-3, 1000);
  for (const Vec3& x : model.particles.x) EXPECT_GT(x.z, 0.4);  // on their way back
}

}  // namespace
}  // namespace dovetail::dem
