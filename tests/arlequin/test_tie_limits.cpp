// The limit of the step with an overlap: explicit and implicit solids, windows, and contacts on the same nodes.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "tie_scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

struct Windows {
  coupling::Stepping stepping;
  int K;
};

class TieLimits : public testing::TestWithParam<Windows> {};

/// Energy of small noise after some windows over that at the start.
double growth(const Windows& windows, double share) {
  SceneOptions o;
  o.across = 1;
  TieRun run = tieBar(o, fem::CellShape::hex8, windows.stepping);
  run.K = windows.K;
  std::mt19937 random(2);
  for (Vec3& v : run.grains.particles.v) v = randomVector(random, 1e-4);
  run.start(1e-7);
  run.start(share * run.run->criticalStep().dt);
  const double first = run.run->ledger().stored();
  try {
    run.run->advance(3000);
  } catch (const NumericalError&) {
    return 1e30;
  }
  return run.run->ledger().stored() / first;
}

TEST_P(TieLimits, HoldAndAreNotFarFromWhereMotionGrows) {
  EXPECT_LT(growth(GetParam(), 0.95), 3.0);
  EXPECT_GT(growth(GetParam(), 1.0 / 0.7), 1e3);
}
INSTANTIATE_TEST_SUITE_P(Windows, TieLimits,
                         testing::Values(Windows{coupling::Stepping::explicitSteps, 1},
                                         Windows{coupling::Stepping::explicitSteps, 4},
                                         Windows{coupling::Stepping::implicitSteps, 1},
                                         Windows{coupling::Stepping::implicitSteps, 4},
                                         Windows{coupling::Stepping::implicitSteps, 16}),
                         [](const auto& c) {
                           return (c.param.stepping == coupling::Stepping::explicitSteps ? "explicit" : "implicit") +
                                  std::to_string(c.param.K);
                         });

/// A heavy grain against the side of the bar, within the overlap or beyond it.
TEST(TieDemand, SharesTheNodesWithContactsOnThem) {
  const auto limitWith = [](double place, double softer) {
    SceneOptions o;
    TieRun run = tieBar(o);
    dem::addParticle(run.grains.particles, {o.across * edge * 0.5 + 0.0999, place, 0.0}, {}, 0.1, dem::Mass{1e4});
    dem::findPairs(run.grains.particles, run.grains.pairs);
    const fem::SolidMesh mesh = barMesh(o);
    run.grains.terms.add(surface::SurfaceContact(*run.side,
                                                 surface::Coupling(surface::makeSkin(mesh.X, mesh.faceSets.at("x+"))),
                                                 dem::makeContactLaws(dem::ElasticLaw{{1e9 / softer}})));
    run.start(1e-9);
    return dem::criticalStep(run.grains).dt;
  };
  SceneOptions o;
  const double inside = particleEnd(o) - 0.5 * edge, beyond = particleEnd(o) + 1.5 * edge;
  const double tie = limitWith(beyond, 1e6);
  EXPECT_LT(limitWith(inside, 1e3), 0.999 * tie);
}

}  // namespace
}  // namespace dovetail::arlequin
