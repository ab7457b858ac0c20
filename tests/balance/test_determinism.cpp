// Runs agree bit for bit, whatever the number of threads; NaN is named.
#include <gtest/gtest.h>

#include "coupled_block.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::surface {
namespace {

constexpr double dt = 2e-4;

dem::Particles manyParticles() {
  dem::Particles particles;
  for (int j = 0; j < 15; ++j)
    for (int i = 0; i < 15; ++i)
      dem::addParticle(particles, {0.025 + 0.0175 * i, 0.025 + 0.0175 * j, 0.0095 + 1e-4 * ((7 * i + 3 * j) % 5)},
                       {0.1 * std::sin(i + 2.0 * j), 0.1 * std::cos(3.0 * i - j), -0.3}, 0.01, dem::Mass{0.02});
  return particles;
}

enum class Kind { local, coarse, smooth, implicitSolid };

std::vector<char> stateAfter(Kind kind, int threadCount) {
  setThreads(threadCount);
  BlockSetup setup{.restitution = 0.9};
  if (kind == Kind::implicitSolid) setup.stepping = Stepping::implicitSteps;
  if (kind == Kind::coarse) setup.width = 0.1;
  setup.smooth = kind == Kind::smooth;
  const auto run = makeRun(setup, blockMesh({6, 6, 4}), manyParticles());
  run->start(dt, {.stepsPerMacroStep = kind == Kind::implicitSolid ? 2 : 1});
  run->advance(15);
  EXPECT_GT(norm(run->solid(0).nodes().u.end()[-25]), 1e-6) << "the particles have pressed the block";
  setThreads(1);
  return run->save();
}

class Determinism : public ::testing::TestWithParam<Kind> {};

TEST_P(Determinism, BitForBitForAnyNumberOfThreadsAndFromRunToRun) {
  const std::vector<char> one = stateAfter(GetParam(), 1);
  EXPECT_TRUE(one == stateAfter(GetParam(), 1));
  EXPECT_TRUE(one == stateAfter(GetParam(), 2));
}

INSTANTIATE_TEST_SUITE_P(Kinds, Determinism,
                         ::testing::Values(Kind::local, Kind::coarse, Kind::smooth, Kind::implicitSolid));

template <class Spoil>
std::string failureAfter(Spoil&& spoil) {
  const auto run = makeRun({});
  run->start(dt);
  spoil(*run);
  try {
    run->advance();
  } catch (const NumericalError& error) {
    return error.what();
  }
  return "not noticed";
}

TEST(Breakdown, ANaNInAParticleIsNamedWithinTheStep) {
  const std::string said = failureAfter([](CoupledRun& run) { run.grains.particles.v[1].x = std::nan(""); });
  EXPECT_NE(said.find("particle 1"), std::string::npos) << said;
}

/// On the skin and inside.
TEST(Breakdown, ANaNInANodeIsNamedWithinTheStep) {
  for (const int node : {blockMesh().nodeSets.at("z+")[5], 21}) {
    const std::string said =
        failureAfter([&](CoupledRun& run) { run.solid(0).nodes().v[static_cast<std::size_t>(node)].y = std::nan(""); });
    EXPECT_NE(said.find("node " + std::to_string(node)), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace dovetail::surface
