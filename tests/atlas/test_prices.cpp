#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "dem/scenes.hpp"
#include "dovetail/core/parallel.hpp"
#include "hand_loop.hpp"
#include "idle_features.hpp"
#include "rungs.hpp"

namespace dovetail::atlas {
namespace {

/// The loop that times are compared with does the same work: it gives the same motion.
TEST(HandLoop, MovesTheLatticeAsTheEngineDoes) {
  auto model = dem_benchmark::waveLattice(12, 12, 12);
  findForces(model);
  const std::vector<Vec3> start = model.particles.x;
  HandLoop loop(model, dem_benchmark::stiffness);
  for (int k = 0; k < 200; ++k) {
    loop.step(dem_benchmark::timeStep);
    advance(model, dem_benchmark::timeStep);
  }
  EXPECT_TRUE(loop.listIsGood());
  double apart = 0.0, moved = 0.0;
  for (std::size_t i = 0; i < start.size(); ++i) {
    apart = std::max(apart, norm(loop.x[i] - model.particles.x[i]));
    moved = std::max(moved, norm(start[i] - model.particles.x[i]));
  }
  EXPECT_GT(moved, 1e-4);
  EXPECT_LT(apart, 1e-12);
}

/// Idle features change no digit; bytes are counted, times are for a quiet machine.
TEST(IdleFeatures, TakeNoBytePerGrain) {
  setThreads(1);  // what other threads allocate is not counted
  const std::vector<IdleFeature> features = idleFeatures(12, 1, 4);
  for (const IdleFeature& feature : features)  // the first one is the bare scene once more
    EXPECT_LT(std::abs(feature.bytesPerGrain - features[0].bytesPerGrain), 2.0) << feature.name;
}

TEST(Ladder, EveryRungRunsAndKeepsItsEnergy) {
  for (std::size_t rung = 0; rung < ladder().size(); ++rung) {
    const auto run = makeRung(rung, 12);
    run->start(dem_benchmark::timeStep);
    run->advance(50);
    if (rung == 0) continue;  // books nothing
    double turned = 0.0;
    for (const auto& channel : run->ledger().channels()) turned += std::abs(channel.joules - channel.joulesAtOpening);
    EXPECT_GT(turned, 0.0) << ladder()[rung].name;
    EXPECT_LT(std::abs(run->ledger().residual()), 1e-3 * turned) << ladder()[rung].name;
  }
}

}  // namespace
}  // namespace dovetail::atlas
