// What falls along a periodic axis is lifted by a period now and then: the ledger knows.
#include <gtest/gtest.h>

#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

const ClumpShape& rod() {
  static const ClumpShape shape =
      makeClumpShape(std::vector<Vec3>{{0, 0, 0}, {0.06, 0, 0}}, std::vector<double>{0.04, 0.05}, Density{1000.0});
  return shape;
}

Model slope(const std::shared_ptr<const ContactLaws>& laws) {
  Model model;
  model.laws = laws;
  model.pairs.setSkin(0.02);
  model.pairs.setPeriodicity({{{0, 0, 0}, {1, 0.6, 1}}, {true, true, false}});
  addWall(model, makePlane({}, {0, 0, 1}));
  return model;
}

TEST(WrapLedger, FreeFallThroughManyPeriodsClosesToRoundOff) {
  Model model = slope(makeContactLaws(ElasticLaw{{1e4}}));
  model.gravity = {7, 3, 0};
  addParticle(model.particles, {0.5, 0.3, 0.5}, {3, 0, 0}, 0.05, Mass{2.0});
  addClump(model, rod(), {0.2, 0.1, 0.8}, {0.9, 0.1, 0.3, 0.2}, {1, -2, 0}, {});
  const double start = energies(model).balance();
  run(model, 1e-3, 3000);
  const Energies e = energies(model);
  const double fallen = 0.5 * 58.0 * 9.0;  // ½ g² t², J/kg, and more from the first velocities
  EXPECT_GT(e.lifted, fallen * 2.0);
  EXPECT_NEAR(e.balance(), start, 1e-12 * e.lifted);
}

/// Spheres and rods that slide and roll down a slope.
struct Slid {
  double residual, lifted, lost;
};
Slid slide(const std::shared_ptr<const ContactLaws>& laws, double dt) {
  Model model = slope(laws);
  model.gravity = {6, 0, -8};
  Random random(3);
  for (int i = 0; i < 12; ++i) {
    const Vec3 x{0.25 * (i % 4) + 0.1, 0.2 * (i / 4) + 0.1, 0.06}, v{random(1.0, 3.0), 0, 0};
    if (i % 2 == 0)
      addParticle(model.particles, x, v, 0.05, Density{1000.0});
    else
      addClump(model, rod(), x, fromRotationVector(random.vector(3.0)), v, {});
  }
  const double start = energies(model).balance();
  run(model, dt, static_cast<std::int64_t>(1.5 / dt + 0.5));
  const Energies e = energies(model);
  return {std::abs(e.balance() - start), e.lifted, e.lost.lostPower()};
}

TEST(WrapLedger, GrainsAndBodiesOnAnInclineWrapManyTimesAndItCloses) {
  const FrictionalLaw rough{{.stiffness = 2e4, .restitution = 0.6}, {.stiffness = 6e3, .friction = 0.3}};
  const Slid coarse = slide(makeContactLaws(rough), 1e-4), fine = slide(makeContactLaws(rough), 2.5e-5);
  for (const Slid& s : {coarse, fine}) {
    EXPECT_GT(s.lifted, 50.0);
    EXPECT_GT(s.lost, 5.0);
  }
  EXPECT_LE(coarse.residual, 2e-3 * coarse.lost);
  EXPECT_LE(fine.residual, 2e-4 * fine.lost);
}

}  // namespace
}  // namespace dovetail::dem
