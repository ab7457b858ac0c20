#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

std::vector<int> nodesAt(const SolidMesh& mesh, int component, double value) {
  std::vector<int> found;
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    if (std::abs(mesh.X[n][component] - value) < 1e-9) found.push_back(static_cast<int>(n));
  return found;
}

/// A dead force on every node of a set.
class NodalForce : public Term {
public:
  NodalForce(std::vector<int> nodes, Vec3 each) : nodes_(std::move(nodes)), each_(each) {}
  std::string name() const override { return "force"; }
  void addForces(const Nodes&, const Instant& now, std::span<Vec3> f) override {
    for (const int n : nodes_) f[static_cast<std::size_t>(n)] += now.t * each_;
  }

private:
  std::vector<int> nodes_;
  Vec3 each_;
};

struct Bar {
  SolidMesh mesh;
  Model model;
  std::shared_ptr<Solid> solid;
};

Bar bar(const SolidKind& kind, std::array<int, 3> cells, Vec3 size, double lambda, double mu) {
  Bar b{boxOf(kind.shape, cells, {}, size), {}, {}};
  b.model = makeModel(b.mesh);
  b.solid = makeSolid(b.mesh, std::make_shared<PlainNeoHookean>(lambda, mu), {.formulation = kind.formulation});
  b.model.add(b.solid);
  return b;
}

TEST(Statics, StretchToTwiceTheLengthByPrescribedMotionIsUniform) {
  for (const SolidKind& kind : allSolidKinds()) {
    SCOPED_TRACE(kind.label());
    Bar b = bar(kind, {1, 1, 2}, {1.0, 1.0, 2.0}, 2e6, 1e6);
    for (int c = 0; c < 3; ++c) b.model.constraints.hold(nodesAt(b.mesh, c, 0.0), 1u << c);
    b.model.constraints.prescribe(nodesAt(b.mesh, 2, 2.0), 2, [](double t) { return 2.0 * t; });
    const StaticReport report = solveStatics(b.model, 1.0, {.firstStep = 0.25});
    const Solid::Sample sample = b.solid->sample(b.model.nodes, {1.0, 0.0});
    const double side = sample.F[0], J = side * side * 2.0;
    EXPECT_NEAR(1e6 * (side * side - 1.0) + 2e6 * std::log(J), 0.0, 1.0);  // free sides: μ(s² − 1) + λ ln J = 0
    for (std::size_t p = 0; p < sample.volume.size(); ++p) {
      EXPECT_NEAR(sample.F[9 * p + 8], 2.0, 1e-8);
      EXPECT_NEAR(sample.F[9 * p], side, 1e-8);
    }
    EXPECT_LT(std::abs(report.energyResidual()), 0.05 * report.storedAfter);
    EXPECT_EQ(report.steps.back().negativePivots, 0);
  }
}

/// Older enhanced bricks lose their stability here, in hourglass modes, at a stretch of about 0.6 (Wriggers & Reese
/// 1996).
TEST(Statics, EnhancedBricksStayStableAndEvenInCompression) {
  Bar b = bar({CellShape::hex8, Formulation::enhanced}, {4, 4, 1}, {1.0, 1.0, 0.25}, 2e6, 1e6);
  std::vector<int> all(b.mesh.X.size());
  for (std::size_t n = 0; n < all.size(); ++n) all[n] = static_cast<int>(n);
  b.model.constraints.hold(all, componentZ);
  b.model.constraints.hold(nodesAt(b.mesh, 0, 0.0), componentX);
  b.model.constraints.hold(nodesAt(b.mesh, 1, 0.0), componentY);
  b.model.constraints.prescribe(nodesAt(b.mesh, 1, 1.0), 1, [](double t) { return -0.6 * t; });
  int negative = 0;
  solveStatics(b.model, 1.0, {.firstStep = 0.05, .largestStep = 0.05}, [&](const Model&, const StaticStep& step) {
    negative = std::max(negative, step.negativePivots);
    return true;
  });
  EXPECT_EQ(negative, 0);
  const Solid::Sample sample = b.solid->sample(b.model.nodes, {1.0, 0.0});
  for (std::size_t p = 0; p < sample.volume.size(); ++p) {
    EXPECT_NEAR(sample.F[9 * p], sample.F[0], 1e-7);
    EXPECT_NEAR(sample.F[9 * p + 4], 0.4, 1e-7);
  }
}

TEST(Statics, TheBooksCloseToSecondOrderInTheStep) {
  const auto residual = [](double step) {
    Bar b = bar({CellShape::hex8, Formulation::standard}, {2, 2, 2}, {1.0, 1.0, 1.0}, 2e6, 1e6);
    b.model.constraints.hold(nodesAt(b.mesh, 2, 0.0));
    b.model.constraints.prescribe(nodesAt(b.mesh, 2, 1.0), 2, [](double t) { return 0.3 * t; });
    b.model.constraints.prescribe(nodesAt(b.mesh, 2, 1.0), 0, [](double t) { return 0.2 * t * t; });
    const StaticReport report = solveStatics(b.model, 1.0, {.firstStep = step, .largestStep = step});
    return std::abs(report.energyResidual());
  };
  EXPECT_NEAR(std::log2(residual(0.1) / residual(0.05)), 2.0, 0.1);
}

TEST(Statics, BendingToALargeAngleGivesTheSameWithEverySolverAndNumberOfThreads) {
  const auto tip = [](const NewtonOptions& newton, int threadCount) {
    setThreads(threadCount);
    Bar b = bar({CellShape::hex8, Formulation::enhanced}, {1, 2, 16}, {0.1, 0.1, 2.0}, 0.0, 0.5e9);
    b.model.constraints.hold(nodesAt(b.mesh, 2, 0.0));
    const std::vector<int> end = nodesAt(b.mesh, 2, 2.0);
    b.model.add(std::make_shared<NodalForce>(end, Vec3{0.0, 2500.0 / static_cast<double>(end.size()), 0.0}));
    solveStatics(b.model, 1.0, {.newton = newton});
    setThreads(1);
    return b.model.nodes.u[static_cast<std::size_t>(end[0])];
  };
  const Vec3 full = tip({}, 1);
  EXPECT_GT(full.y, 0.3);
  EXPECT_EQ(full, tip({}, 2));
  EXPECT_LT(norm(full - tip({.reuseContraction = 0.3}, 1)), 1e-7);
  EXPECT_LT(norm(full - tip({.linear = {.method = LinearMethod::conjugateGradients, .relativeTolerance = 1e-10}}, 1)),
            1e-7);
  EXPECT_LT(norm(full - tip({.lineSearch = false}, 1)), 1e-7);
}

/// A shallow arch (two straight limbs, clamped) snaps through: the load has a maximum and falls behind it.
TEST(ArcLength, FollowsASnapThroughThatLoadStepsCannot) {
  SolidMesh mesh = boxOf(CellShape::hex8, {24, 1, 1}, {0.0, 0.0, 0.0}, {2.0, 0.02, 0.1});
  for (Vec3& X : mesh.X) X.y += 0.08 * std::sin(std::numbers::pi * X.x / 2.0);
  const auto make = [&] {
    Model model = makeModel(mesh);
    model.add(makeSolid(mesh, std::make_shared<PlainNeoHookean>(0.0, 0.5e9), {.formulation = Formulation::enhanced}));
    std::vector<int> ends = nodesAt(mesh, 0, 0.0);
    for (const int n : nodesAt(mesh, 0, 2.0)) ends.push_back(n);
    model.constraints.hold(ends);
    std::vector<int> crown;
    for (const int n : nodesAt(mesh, 0, 1.0))
      if (mesh.X[static_cast<std::size_t>(n)].y > 0.09) crown.push_back(n);
    model.add(std::make_shared<NodalForce>(crown, Vec3{0.0, -4000.0 / static_cast<double>(crown.size()), 0.0}));
    return std::pair(std::move(model), crown[0]);
  };
  auto [model, crown] = make();
  double peak = 0.0, after = 1e300;
  bool unstable = false, passed = false;
  const StaticReport report = followPath(model, 10.0, {.firstStep = 0.01, .maxSteps = 150},
                                         [&, node = crown](const Model& m, const StaticStep& step) {
                                           const double sunk = -m.nodes.u[static_cast<std::size_t>(node)].y;
                                           if (!passed) peak = std::max(peak, step.t);
                                           passed = passed || step.t < peak - 1e-9;
                                           if (passed) after = std::min(after, step.t);
                                           unstable = unstable || step.negativePivots > 0;
                                           return sunk < 0.25;
                                         });
  EXPECT_TRUE(passed);
  EXPECT_LT(after, 0.8 * peak);
  EXPECT_TRUE(unstable);
  EXPECT_EQ(report.steps.back().negativePivots, 0);  // stable again on the far side
  EXPECT_LT(std::abs(report.energyResidual()), 0.02 * report.loadWork + 0.02 * report.storedAfter);
  // Load steps: the last equilibrium below the peak, then an error or a jump beyond the snap.
  auto [other, node] = make();
  solveStatics(other, 0.9 * peak, {.firstStep = 0.05 * peak});
  EXPECT_LT(-other.nodes.u[static_cast<std::size_t>(node)].y, 0.1);
}

TEST(Statics, AFailureLeavesTheLastEquilibriumAndSaysWhy) {
  Bar b = bar({CellShape::hex8, Formulation::standard}, {1, 1, 1}, {1.0, 1.0, 1.0}, 2e6, 1e6);
  b.model.constraints.hold(nodesAt(b.mesh, 2, 0.0));
  b.model.constraints.prescribe(nodesAt(b.mesh, 2, 1.0), 2, [](double t) { return -1.2 * t; });  // through itself
  try {
    solveStatics(b.model, 1.0, {.firstStep = 0.2, .smallestStep = 1e-3});
    FAIL() << "a body cannot be pressed to less than nothing";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("last equilibrium"), std::string::npos) << error.what();
  }
  EXPECT_GT(b.model.t, 0.5);
  EXPECT_LT(b.model.t, 1.0 / 1.2);
  b.solid->requireValid(b.model.nodes, "at the end", Scrutiny::all);
  EXPECT_THROW(solveStatics(b.model, 0.0), InputError);
  EXPECT_THROW(solveStatics(b.model, 2.0, {.firstStep = -1.0}), InputError);
}

}  // namespace
}  // namespace dovetail::fem
