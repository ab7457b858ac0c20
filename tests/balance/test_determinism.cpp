// Runs agree bit for bit, whatever the number of threads; NaN is named.
#include <gtest/gtest.h>

#include "coupled_block.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
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

struct State {
  std::vector<Vec3> x, v, u, nodeV;
  double energy;
  friend bool operator==(const State&, const State&) = default;
};

enum class Kind { local, coarse, smooth, implicitSolid };

template <class Model>
State stateAfter(Model model, Kind kind) {
  Profile profile;
  start(model, dt, profile);
  const bool implicitSolid = kind == Kind::implicitSolid;
  const int K = implicitSolid ? 2 : 1;
  fem::ImplicitMotion solid(*model.solid, newmarkLumped());
  for (int w = 0; w < 15; ++w)
    implicitSolid ? stepImplicit(model, solid, dt, K, {}, true, profile)
                  : stepExplicit(model, dt, K, {}, true, profile);
  return {model.discrete.particles.x, model.discrete.particles.v, model.solid->nodes.u, model.solid->nodes.v,
          storedEnergy(model)};
}

State runKind(Kind kind, int threadCount) {
  setThreads(threadCount);
  const fem::SolidMesh mesh = fem::boxOf(fem::CellShape::hex8, {6, 6, 4}, {0, 0, -0.2}, {0.3, 0.3, 0});
  const BlockSetup setup{.restitution = 0.9};
  const Skin skin = blockSkin(mesh, kind == Kind::coarse ? 0.1 : 0.0);
  State state = kind == Kind::smooth
                    ? stateAfter(makeModel(setup, mesh, Coupling(makeSmoothSurface(skin)), manyParticles()), kind)
                    : stateAfter(makeModel(setup, mesh, Coupling(skin), manyParticles()), kind);
  setThreads(1);
  return state;
}

class Determinism : public ::testing::TestWithParam<Kind> {};

TEST_P(Determinism, BitForBitForAnyNumberOfThreadsAndFromRunToRun) {
  const State one = runKind(GetParam(), 1);
  EXPECT_GT(norm(one.u[one.u.size() - 25]), 1e-6) << "the particles have pressed the block";
  EXPECT_TRUE(one == runKind(GetParam(), 1));
  EXPECT_TRUE(one == runKind(GetParam(), 2));
}

INSTANTIATE_TEST_SUITE_P(Kinds, Determinism,
                         ::testing::Values(Kind::local, Kind::coarse, Kind::smooth, Kind::implicitSolid));

template <class Spoil>
std::string failureAfter(Spoil&& spoil) {
  CoupledModel model = flatModel({});
  Profile profile;
  start(model, dt, profile);
  spoil(model);
  try {
    stepExplicit(model, dt, 1, {}, false, profile);
  } catch (const NumericalError& error) {
    return error.what();
  }
  return "not noticed";
}

TEST(Breakdown, ANaNInAParticleIsNamedWithinTheStep) {
  const std::string said = failureAfter([](CoupledModel& model) { model.discrete.particles.v[1].x = std::nan(""); });
  EXPECT_NE(said.find("particle 1"), std::string::npos) << said;
}

TEST(Breakdown, ANaNInANodeOfTheSkinIsNamedWithinTheStep) {
  const fem::SolidMesh mesh = blockMesh();
  const int node = mesh.nodeSets.at("z+")[5];
  const std::string said = failureAfter([&](CoupledModel& model) { model.solid->nodes.v[node].y = std::nan(""); });
  EXPECT_NE(said.find("node " + std::to_string(node)), std::string::npos) << said;
}

/// A node inside the solid does not meet the seam: whoever runs the steps checks the nodes, and is told which.
TEST(Breakdown, ANaNInsideTheSolidIsFoundByTheCheckOfTheNodes) {
  CoupledModel model = flatModel({});
  const int inside = 16 + 5;
  Profile profile;
  start(model, dt, profile);
  model.solid->nodes.v[inside].z = std::nan("");
  stepExplicit(model, dt, 1, {}, false, profile);
  try {
    requireFinite(model.solid->nodes.u, "node", "displacement", "step 1");
    FAIL() << "not noticed";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("node 21"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace dovetail::surface
