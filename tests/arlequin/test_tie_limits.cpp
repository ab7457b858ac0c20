// The limit of the step with an overlap: explicit and implicit solids, and windows.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
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
  const bool resonates = GetParam().stepping == coupling::Stepping::explicitSteps && GetParam().K > 1;
  if (resonates) return;  // in narrow bands beyond the limit only
  EXPECT_GT(growth(GetParam(), 1.0 / 0.4), 1e3);
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

}  // namespace
}  // namespace dovetail::arlequin
