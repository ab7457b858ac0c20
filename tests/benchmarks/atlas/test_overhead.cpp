#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "dem/scenes.hpp"
#include "dovetail/core/parallel.hpp"
#include "features.hpp"
#include "hand_loop.hpp"

namespace dovetail::overhead {
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

/// Bytes are counted; times are for a quiet machine.
TEST(Features, TakeNoBytePerGrainUnlessUsed) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the heap of sanitizers does not count";
#endif
  setThreads(1);  // what other threads allocate is not counted
  const std::vector<Feature> features = featuresOf(12, 1, 4);
  const double noise = features[0].bytesPerGrain;  // of the bare scene once more
  double most = 0.0;
  for (const Feature& feature : features) {
    EXPECT_GT(feature.time.second, 0.0) << feature.name;
    if (feature.used)
      most = std::max(most, feature.bytesPerGrain - noise);
    else
      EXPECT_LT(std::abs(feature.bytesPerGrain - noise), 2.0) << feature.name;
  }
  EXPECT_GT(most, 72.0);  // three pairs a grain remember three numbers each
}

}  // namespace
}  // namespace dovetail::overhead
