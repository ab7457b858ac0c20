// Candidate facets: never one too few, and cheap to keep.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/walls/wall_clearances.hpp"
#include "dovetail/geometry/triangle.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

void expectComplete(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates) {
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (std::size_t t = 0; t < wall.facets.size(); ++t) {
      const auto corner = [&](std::size_t k) { return wall.x[static_cast<std::size_t>(wall.facets[t][k])]; };
      const Vec3 c = geometry::closestPointOnTriangle(particles.x[i], corner(0), corner(1), corner(2)).point;
      if (norm(particles.x[i] - c) >= particles.radius[i]) continue;
      const auto listed = std::lower_bound(candidates.particle.begin(), candidates.particle.end(), static_cast<int>(i));
      ASSERT_TRUE(listed != candidates.particle.end() && *listed == static_cast<int>(i));
      const auto k = static_cast<std::size_t>(listed - candidates.particle.begin());
      const auto first = candidates.facet.begin() + candidates.offsets[k];
      ASSERT_TRUE(std::binary_search(first, candidates.facet.begin() + candidates.offsets[k + 1], static_cast<int>(t)));
    }
}

TEST(WallCandidates, NoFacetInReachIsMissingWhileAllMove) {
  Random random(1);
  auto wall = squares(10, 10, 0.2);
  for (Vec3& v : wall.v) v = random.vector(0.5);
  Particles particles;
  for (int i = 0; i < 60; ++i)
    addParticle(particles, {random(0, 2), random(0, 2), random(-0.3, 0.3)}, random.vector(1.0),
                i % 2 == 0 ? 0.02 : random(0.1, 0.4), Mass{1.0});
  WallCandidates scanned, bounded;
  scanned.skin = bounded.skin = 0.05;
  const double dt = 1e-3, wallStep = dt * 0.5 * std::sqrt(3.0);
  for (int step = 0; step < 200; ++step) {
    drift(particles, dt);
    for (std::size_t v = 0; v < wall.x.size(); ++v) wall.x[v] += dt * wall.v[v];
    Moves moves = movesOf(particles, dt);
    updateWallCandidates(particles, wall, scanned, moves);
    moves.wall = wallStep;
    updateWallCandidates(particles, wall, bounded, moves);
    if (step % 10 != 0) continue;
    expectComplete(particles, wall, scanned);
    expectComplete(particles, wall, bounded);
  }
  EXPECT_GT(scanned.builds, 3);
  EXPECT_LT(scanned.builds, 60);
  EXPECT_LE(bounded.builds, 60);
}

TEST(WallCandidates, AWallAtRestIsNotSearchedAgain) {
  const auto wall = squares(4, 4, 0.5);
  Particles particles;
  addParticle(particles, {1, 1, 0.1}, {}, 0.1, Mass{1.0});
  WallCandidates candidates;
  candidates.skin = 0.02;
  const Moves none{0.0, 0.0};
  EXPECT_TRUE(updateWallCandidates(particles, wall, candidates, none));
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(updateWallCandidates(particles, wall, candidates, none));
  EXPECT_FALSE(updateWallCandidates(particles, wall, candidates, {0.019, Moves::unknown}));
  EXPECT_TRUE(updateWallCandidates(particles, wall, candidates, {0.002, 0.0}));
  addParticle(particles, {1.5, 1, 0.1}, {}, 0.1, Mass{1.0});
  EXPECT_TRUE(updateWallCandidates(particles, wall, candidates, none));
  EXPECT_EQ(candidates.builds, 3);
}

TEST(WallCandidates, APathToAndFroIsKnownFromThePairList) {
  const auto wall = squares(4, 4, 0.5);
  Particles particles;
  addParticle(particles, {1, 1, 0.1}, {}, 0.1, Mass{1.0});
  WallCandidates candidates;
  candidates.skin = 0.02;
  updateWallCandidates(particles, wall, candidates, {0.0, 0.0, 0.004, 1});
  // It shakes for ever by 3 mm a step, at most 5 mm from where the list was made.
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(updateWallCandidates(particles, wall, candidates, {0.003, 0.0, 0.005, 1}));
  EXPECT_NEAR(candidates.particleTravel.bound, 0.009, 1e-15);
  // The list is made anew where the particle is now, then it goes on for 10 mm.
  EXPECT_FALSE(updateWallCandidates(particles, wall, candidates, {0.001, 0.0, 0.0, 2}));
  EXPECT_FALSE(updateWallCandidates(particles, wall, candidates, {0.009, 0.0, 0.009, 2}));
  EXPECT_TRUE(updateWallCandidates(particles, wall, candidates, {0.003, 0.0, 0.012, 2}));
}

TEST(WallCandidates, ListOnlyWhatIsNearTheWall) {
  Random random(5);
  Particles particles;
  for (int i = 0; i < 5000; ++i)
    addParticle(particles, {random(0, 4), random(0, 4), random(-2, 2)}, {}, random(0.01, 0.05), Mass{1.0});
  auto wall = squares(8, 8, 0.5);
  for (Vec3& x : wall.x) x.z = 0.3 * x.x - 0.2 * x.y;
  WallCandidates candidates;
  findWallCandidates(particles, wall, 0.02, candidates);
  expectComplete(particles, wall, candidates);
  for (const int i : candidates.particle) {
    const Vec3& x = particles.x[static_cast<std::size_t>(i)];
    EXPECT_LE(std::abs(x.z - 0.3 * x.x + 0.2 * x.y) / std::sqrt(1.13),
              particles.radius[static_cast<std::size_t>(i)] + 0.02 + 1e-12);
  }
}

/// On rough ground, while particles and vertices move at random and together by no more than is told.
void expectSameWithClearances(const Vec3& origin, double reach, const geometry::Periodicity& periodicity,
                              unsigned seed) {
  Random random(seed);
  auto wall = squares(10, 10, 0.2);
  for (Vec3& x : wall.x) x += origin + Vec3{0, 0, random(-0.03, 0.03)};
  Particles particles;
  for (int i = 0; i < 300; ++i)
    addParticle(particles, origin + Vec3{random(0, 2), random(0, 2), random(-0.2, 0.2)}, {}, random(0.02, 0.15),
                Mass{1.0});
  WallCandidates candidates;
  candidates.reach = reach;
  findWallCandidates(particles, wall, 0.1, candidates, periodicity);
  WallClearances clearances = clearancesNow(particles, wall, candidates);
  const double travel = 0.08;
  for (const double fraction : {0.0, 0.3, 1.0}) {
    clearances.travelled = fraction * travel;
    for (Vec3& x : particles.x) x += (fraction * travel / 4.0) * normalized(random.vector(1.0));
    for (Vec3& x : wall.x) x += (fraction * travel / 4.0) * normalized(random.vector(1.0));
    for (const EdgeRule rule : {EdgeRule::projected, EdgeRule::paper}) {
      WallContacts all, spared;
      findWallContacts(particles, wall, candidates, rule, all);
      findWallContacts(particles, wall, candidates, clearances, rule, spared);
      ASSERT_GT(all.size(), 100u);
      EXPECT_EQ(all.particle, spared.particle);
      EXPECT_EQ(all.facet, spared.facet);
      EXPECT_EQ(all.weight, spared.weight);
      EXPECT_EQ(all.normal, spared.normal);
      EXPECT_EQ(all.overlap, spared.overlap);
      EXPECT_EQ(all.image, spared.image);
    }
  }
}

TEST(WallCandidates, ClearancesChangeNoDigit) {
  const geometry::Periodicity periodic{{{0, 0, -1}, {2, 2, 1}}, {true, true, false}};
  for (unsigned seed = 1; seed <= 4; ++seed) {
    expectSameWithClearances({}, 0.0, {}, seed);
    expectSameWithClearances({1e6, -2e6, 3e5}, 0.0, {}, seed);
    expectSameWithClearances({}, 0.04, {}, seed);
    expectSameWithClearances({}, 0.0, periodic, seed);
  }
}

TEST(WallCandidates, ClearancesSpareWhatIsFar) {
  const auto wall = squares(2, 2, 1.0);
  Particles particles;
  addParticle(particles, {0.3, 0.2, 0.15}, {}, 0.1, Mass{1.0});
  WallCandidates candidates;
  findWallCandidates(particles, wall, 0.3, candidates);
  WallClearances clearances = clearancesNow(particles, wall, candidates);
  ASSERT_EQ(clearances.whenListed.size(), candidates.facet.size());
  EXPECT_NEAR(*std::min_element(clearances.whenListed.begin(), clearances.whenListed.end()), 0.05, 1e-15);
  for (std::size_t k = 0; k < clearances.whenListed.size(); ++k) {
    const double clearance = clearances.whenListed[k];
    clearances.travelled = clearance - 1e-3;
    EXPECT_FALSE(clearances.mayBeWithin(k, 0.1, 0.0));
    EXPECT_TRUE(clearances.mayBeWithin(k, 0.1, 2e-3));
    clearances.travelled = clearance + 1e-3;
    EXPECT_TRUE(clearances.mayBeWithin(k, 0.1, 0.0));
  }
}

TEST(WallCandidates, EmptyScenesAndBadInput) {
  WallCandidates candidates;
  WallContacts contacts;
  const auto wall = squares(2, 2, 1.0);
  findWallCandidates({}, wall, 0.1, candidates);
  findWallContacts({}, wall, candidates, EdgeRule::projected, contacts);
  EXPECT_EQ(contacts.size(), 0u);
  Particles particles;
  addParticle(particles, {1, 1, 0}, {}, 0.1, Mass{1.0});
  const TriangulatedWall nothing = makeWall({}, {});
  findWallCandidates(particles, nothing, 0.1, candidates);
  for (const EdgeRule rule : {EdgeRule::projected, EdgeRule::paper}) {
    findWallContacts(particles, nothing, candidates, rule, contacts);
    EXPECT_EQ(contacts.size(), 0u);
    EXPECT_EQ(sweepWall(ElasticLaw{{1.0}}, particles, nothing, contacts).storedEnergy(), 0.0);
  }
  EXPECT_THROW(findWallCandidates(particles, wall, -0.1, candidates), InputError);
  findWallCandidates(particles, wall, 0.1, candidates);
  particles.x[0].x = NAN;
  EXPECT_THROW(updateWallCandidates(particles, wall, candidates, {}), NumericalError);
}

}  // namespace
}  // namespace dovetail::dem
