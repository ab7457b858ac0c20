// What a list of pairs refuses, and when it asks to be made anew.
#include <gtest/gtest.h>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/pairs/pairs.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

using detail::PairParts;

/// A block of particles, half a period of it across the border.
struct Block {
  Particles particles;
  PairList list;

  explicit Block(double skin) {
    Random random(5);
    for (int i = 0; i < 4000; ++i)
      addParticle(particles, random.vector(0.5), {}, random(0.018, 0.024), Density{1000.0});
    list.setPeriodicity({{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}, {true, false, false}});
    list.setSkin(skin);
    findPairs(particles, list);
  }
};

TEST(PairListGuards, SettingsThatChangeAskForANewListOnce) {
  Block b(0.01);
  const auto asksOnce = [&](auto&& change) {
    change();
    EXPECT_FALSE(b.list.fits(b.particles));
    EXPECT_TRUE(updatePairs(b.particles, b.list, 0.0));
    change();
    EXPECT_TRUE(b.list.fits(b.particles));
    EXPECT_FALSE(updatePairs(b.particles, b.list, 0.0));
  };
  const std::size_t before = b.list.size();
  asksOnce([&] { b.list.setReach(0.01); });
  EXPECT_GT(b.list.size(), before);
  asksOnce([&] { b.list.setSkin(0.012); });
  asksOnce([&] { b.list.setPeriodicity({}); });
  EXPECT_EQ(b.list.images().size(), 0u);
  for (const double wrong : {-1.0, std::nan("")}) {
    EXPECT_THROW(b.list.setSkin(wrong), InputError);
    EXPECT_THROW(b.list.setReach(wrong), InputError);
  }
}

TEST(PairListGuards, AListThatWasKeptIsMadeAnewByAnUpdate) {
  Block b(0.01);
  keepPairs(b.particles, b.list);
  const std::int64_t builds = b.list.builds();
  EXPECT_TRUE(b.list.fits(b.particles));
  EXPECT_TRUE(updatePairs(b.particles, b.list, 0.0));
  EXPECT_EQ(b.list.builds(), builds + 1);
}

TEST(PairListGuards, NewPairsKnowOfNoMotionAndOldOnesKeepTheirs) {
  Block b(0.01);
  const auto motionOf = [](const PairList& list, std::size_t p) {
    return Vec3{list.motion()[p], list.motion()[list.size() + p], list.motion()[2 * list.size() + p]};
  };
  b.list.prepareMotion(3, true);
  RawVector<double>& motion = detail::partsOf(b.list).motion;
  for (std::size_t k = 0; k < motion.size(); ++k) motion[k] = 1.0 + static_cast<double>(k);
  const PairList before = b.list;
  const std::vector<std::size_t> places{3, before.size() - 1};
  PairList some = selectPairs(b.particles, before, places);
  some.prepareMotion(3, true);
  std::ranges::fill(detail::partsOf(some).motion, -1.0);
  b.list.takeMemory(places, some);
  for (const std::size_t p : places) EXPECT_EQ(motionOf(b.list, p), (Vec3{-1, -1, -1}));
  b.list = before;
  b.list.setReach(0.01);
  updatePairs(b.particles, b.list, 0.0);
  ASSERT_GT(b.list.size(), before.size());
  for (std::size_t p = 0; p < b.list.size(); ++p) {
    const auto old = before.find(b.list.pairs()[p]);
    ASSERT_EQ(motionOf(b.list, p), old ? motionOf(before, *old) : Vec3{});
  }
  b.list.forgetMotion();
  EXPECT_EQ(motionOf(b.list, 0), Vec3{});
}

TEST(PairListGuards, SelectedPairsHandBackWhatTheyRemember) {
  Block b(0.01);
  b.list.prepareMemory(2, 0, 0);
  const std::vector<std::size_t> places{3, b.list.size() - 1};
  PairList some = selectPairs(b.particles, b.list, places);
  EXPECT_THROW(b.list.takeMemory(places, some), InputError);  // which has none yet
  const std::span<double> memory = some.prepareMemory(2, 0, 0);
  for (std::size_t k = 0; k < memory.size(); ++k) memory[k] = 1.0 + static_cast<double>(k);
  EXPECT_THROW(b.list.takeMemory(std::vector<std::size_t>{3}, some), InputError);
  b.list.takeMemory(places, some);
  for (std::size_t k = 0; k < places.size(); ++k) {
    EXPECT_EQ(some.pairs()[k], b.list.pairs()[places[k]]);
    EXPECT_EQ(some.shift(k), b.list.shift(places[k]));
    for (std::size_t c = 0; c < 2; ++c)
      EXPECT_EQ(b.list.memory()[c * b.list.size() + places[k]], memory[c * places.size() + k]);
  }
}

std::vector<char> saved(const PairList& list) {
  ByteWriter writer;
  list.save(writer);
  return writer.bytes();
}
PairList loaded(const std::vector<char>& bytes) {
  PairList list;
  ByteReader reader(bytes);
  list.load(reader);
  return list;
}

TEST(PairListGuards, AListIsReadAsItWasWritten) {
  Block b(0.01);
  b.list.prepareMemory(3, 7, 0);
  b.list.writeFactors()[2] = 0.5;
  EXPECT_GT(b.list.candidates().size(), b.list.size());
  const PairList read = loaded(saved(b.list));
  EXPECT_TRUE(saved(read) == saved(b.list));
  EXPECT_TRUE(read.fits(b.particles));
  EXPECT_TRUE(read.chunks().begin == b.list.chunks().begin);
  EXPECT_TRUE(read.chunks().crosses == b.list.chunks().crosses);
  EXPECT_TRUE(read.chunks().images == b.list.chunks().images);
  EXPECT_TRUE(read.chunks().candidates == b.list.chunks().candidates);
  b.list.setSkin(0.02);
  EXPECT_FALSE(loaded(saved(b.list)).fits(b.particles));
}

TEST(PairListGuards, WhatIsNoListIsRefused) {
  Block b(0.01);
  b.list.prepareMemory(3, 7, 0);
  b.list.writeFactors()[2] = 0.5;
  const auto refuses = [&](auto&& spoil) {
    PairList broken = b.list;
    spoil(detail::partsOf(broken));
    EXPECT_THROW(loaded(saved(broken)), InputError);
  };
  refuses([](PairParts& p) { std::swap(p.pairs[4], p.pairs[5]); });
  refuses([](PairParts& p) { p.pairs[5] = p.pairs[4]; });
  refuses([](PairParts& p) { std::swap(p.pairs[0][0], p.pairs[0][1]); });
  refuses([](PairParts& p) { p.pairs[0][0] = -1; });
  refuses([](PairParts& p) { p.pairs.back()[1] = 4000; });
  refuses([](PairParts& p) { std::swap(p.candidates[4], p.candidates[5]); });
  refuses([](PairParts& p) { p.candidates.clear(); });
  refuses([](PairParts& p) { p.positionAtPruning.pop_back(); });
  refuses([](PairParts& p) { p.positionAtBuild.pop_back(); });
  refuses([](PairParts& p) { p.images.push_back(p.images.front()); });
  refuses([](PairParts& p) { p.images.back().pair = p.size(); });
  refuses([](PairParts& p) { p.factors.pop_back(); });
  refuses([](PairParts& p) { p.memory.pop_back(); });
  refuses([](PairParts& p) { p.ended.memory.push_back(1.0); });
  refuses([](PairParts& p) { p.skin = -1.0; });
  refuses([](PairParts& p) { p.travel = std::nan(""); });
}

}  // namespace
}  // namespace dovetail::dem
