// The weight of grains and bodies, and its moment: what the ledger of impulses books as given by gravity.
#include <gtest/gtest.h>

#include "../../core/every_vector_code.hpp"
#include "bonds/beam_scenes.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bodies/body_term.hpp"

namespace dovetail::dem {
namespace {

/// n grains, some with a fraction of their weight, and a clump if asked for.
Model grains(int n, bool weighted, bool clump) {
  Model m;
  m.gravity = {1.0, -2.0, -9.81};
  Random random(n + 1);
  for (int i = 0; i < n; ++i) addParticle(m.particles, random.vector(3.0), {}, random(0.01, 0.02), Density{2500.0});
  if (clump) {
    const ClumpShape rod =
        makeClumpShape(std::vector<Vec3>{{0, 0, 0}, {0.03, 0, 0}}, std::vector<double>{0.03, 0.03}, Density{1000.0});
    addClump(m, rod, {5, 6, 7}, {}, {}, {});
  }
  if (weighted)
    for (std::size_t i = 0; i < m.particles.size(); ++i)
      m.particles.weight.push_back(m.particles.isMember(i) ? 1.0 : random(0.1, 1.0));
  return m;
}

Momenta byHand(const Model& m) {
  Momenta sum;
  const Particles& p = m.particles;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!p.isMember(i)) sum.add(p.x[i], p.weightOf(i) * p.mass[i] * m.gravity);
  for (const BodyTerm* term : m.terms.all<BodyTerm>())
    for (std::size_t b = 0; b < term->bodies.size(); ++b) sum.add(term->bodies.x[b], term->bodies.mass[b] * m.gravity);
  return sum;
}

TEST(Weight, IsTheSumOverGrainsAndBodiesForAnyNumberOfThem) {
  for (const int n : {0, 1, 3, 4, 5, 11, 64, 10001})
    for (const bool weighted : {false, true})
      for (const bool clump : {false, true}) {
        const Model m = grains(n, weighted, clump);
        const Momenta now = weight(m), sum = byHand(m);
        EXPECT_LE(norm(now.linear - sum.linear), 1e-12 * norm(sum.linear)) << n;
        EXPECT_LE(norm(now.angular - sum.angular), 1e-12 * (1.0 + norm(sum.angular))) << n;
      }
}

TEST(Weight, HasTheSameDigitsInEveryVectorCodeAndForAnyNumberOfThreads) {
  const Model m = grains(10001, true, false);
  setThreads(1);
  const Momenta one = weight(m);
  setThreads(3);
  EXPECT_EQ(weight(m), one);
  setThreads(1);
  dovetail::test::expectSameDigitsOfEveryVectorCode("weight", [&] {
    const auto [f, moment] = weight(m);
    return std::vector{f.x, f.y, f.z, moment.x, moment.y, moment.z};
  });
}

}  // namespace
}  // namespace dovetail::dem
