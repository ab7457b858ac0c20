#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/laws/viscosity.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dynamics_helpers.hpp"

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
  for (const SolidKind& kind : spatialSolidKinds()) {
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
  Bar b = bar({ElementShape::hex8, Formulation::enhanced}, {4, 4, 1}, {1.0, 1.0, 0.25}, 2e6, 1e6);
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
    Bar b = bar({ElementShape::hex8, Formulation::standard}, {2, 2, 2}, {1.0, 1.0, 1.0}, 2e6, 1e6);
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
    Bar b = bar({ElementShape::hex8, Formulation::enhanced}, {1, 2, 16}, {0.1, 0.1, 2.0}, 0.0, 0.5e9);
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
  EXPECT_LT(
      norm(full - tip({.linear = {.method = linalg::LinearMethod::conjugateGradients, .relativeTolerance = 1e-10}}, 1)),
      1e-7);
  EXPECT_LT(norm(full - tip({.lineSearch = false}, 1)), 1e-7);
}

/// A shallow arch (clamped) with a force on its crown that grows with t.
struct Arch {
  SolidMesh mesh = boxOf(ElementShape::hex8, {24, 1, 1}, {0.0, 0.0, 0.0}, {2.0, 0.02, 0.1});
  Model model;
  int crown = -1;

  Arch() {
    for (Vec3& X : mesh.X) X.y += 0.08 * std::sin(std::numbers::pi * X.x / 2.0);
    model = makeModel(mesh);
    model.add(makeSolid(mesh, std::make_shared<PlainNeoHookean>(0.0, 0.5e9), {.formulation = Formulation::enhanced}));
    std::vector<int> ends = nodesAt(mesh, 0, 0.0), top;
    for (const int n : nodesAt(mesh, 0, 2.0)) ends.push_back(n);
    model.constraints.hold(ends);
    for (const int n : nodesAt(mesh, 0, 1.0))
      if (mesh.X[static_cast<std::size_t>(n)].y > 0.09) top.push_back(n);
    model.add(std::make_shared<NodalForce>(top, Vec3{0.0, -4000.0 / static_cast<double>(top.size()), 0.0}));
    crown = top[0];
  }
  double sunk() const { return -model.nodes.u[static_cast<std::size_t>(crown)].y; }
};

/// It snaps through: the load has a maximum and falls behind it.
struct Snap {
  double peak = 0.0, after = 1e300;
  bool unstable = false, passed = false;
  std::vector<double> sunk;
  StaticReport report;
};
Snap snapThrough(const ArcLengthOptions& options) {
  Arch arch;
  Snap snap;
  snap.report = followPath(arch.model, 10.0, options, [&](const Model&, const StaticStep& step) {
    snap.sunk.push_back(arch.sunk());
    if (!snap.passed) snap.peak = std::max(snap.peak, step.t);
    snap.passed = snap.passed || step.t < snap.peak - 1e-9;
    if (snap.passed) snap.after = std::min(snap.after, step.t);
    snap.unstable = snap.unstable || step.negativePivots > 0;
    return arch.sunk() < 0.25;
  });
  return snap;
}

TEST(ArcLength, FollowsASnapThroughThatLoadStepsCannot) {
  const Snap snap = snapThrough({.firstStep = 0.01, .maxSteps = 150});
  EXPECT_TRUE(snap.passed);
  EXPECT_LT(snap.after, 0.8 * snap.peak);
  EXPECT_TRUE(snap.unstable);
  EXPECT_EQ(snap.report.steps.back().negativePivots, 0);  // stable again on the far side
  EXPECT_LT(std::abs(snap.report.energyResidual()), 0.02 * snap.report.loadWork + 0.02 * snap.report.storedAfter);
  // Load steps: the last equilibrium below the peak, then an error or a jump beyond the snap.
  Arch other;
  solveStatics(other.model, 0.9 * snap.peak, {.firstStep = 0.05 * snap.peak});
  EXPECT_LT(other.sunk(), 0.1);
}

TEST(ArcLength, OneDisplacementLeadsThroughTheSameSnap) {
  const Snap arc = snapThrough({.firstStep = 0.01, .maxSteps = 150});
  ArcLengthOptions options{.firstStep = 0.01, .largestStep = 0.005, .maxSteps = 150};
  options.node = Arch().crown;
  options.component = 1;
  const Snap snap = snapThrough(options);
  EXPECT_TRUE(snap.passed);
  EXPECT_NEAR(snap.peak, arc.peak, 0.01 * arc.peak);
  EXPECT_LT(snap.after, 0.8 * snap.peak);
  for (std::size_t k = snap.sunk.size() / 2; k < snap.sunk.size(); ++k)
    EXPECT_NEAR(snap.sunk[k] - snap.sunk[k - 1], 0.005, 1e-12);
}

TEST(ArcLength, EndsAtTheTimeAskedForWhetherLoadsGoOnOrNot) {
  const auto pull = [](bool path, const TimeFunction& scale, StaticReport& report) {
    Bar b = bar({ElementShape::hex8, Formulation::standard}, {1, 1, 4}, {1.0, 1.0, 4.0}, 2e6, 1e6);
    b.model.constraints.hold(nodesAt(b.mesh, 2, 0.0));
    b.model.add(nodalForce(nodesAt(b.mesh, 2, 4.0), {1e2, 0.0, 2e5}, scale));
    report = path ? followPath(b.model, 1.0, {.firstStep = 0.1}) : solveStatics(b.model, 1.0);
    EXPECT_EQ(b.model.t, 1.0);
    return b.model.nodes.u;
  };
  for (const TimeFunction& scale : {ramp(1.0, 1.0), TimeFunction([](double t) { return t; })}) {
    StaticReport ofPath, ofSteps;
    const std::vector<Vec3> followed = pull(true, scale, ofPath), stepped = pull(false, scale, ofSteps);
    for (std::size_t n = 0; n < followed.size(); ++n) EXPECT_LT(norm(followed[n] - stepped[n]), 1e-7);
    EXPECT_LE(ofPath.steps.size(), 20u);
    EXPECT_NEAR(ofPath.steps[0].t, 0.1, 0.02);  // the ramp's slope at its foot is that on its right
  }
}

TEST(ArcLength, MultipliersOfContactSettleInEveryStep) {
  Bar b = bar({ElementShape::hex8, Formulation::standard}, {2, 2, 2}, {1.0, 1.0, 1.0}, 2e6, 1e6);
  b.model.constraints.hold(nodesAt(b.mesh, 2, 1.0), 3u);
  ContactOptions options;
  options.penalty = 2e7;
  options.augmented = true;
  options.gapTolerance = 1e-8;
  options.maxAugmentations = 100;
  const ContactPlane& contact =
      b.model.add(makeContactPlane(b.mesh, faceSet(b.mesh, "z-"), {{0, 0, 0}, {0, 0, 1}, {}}, options));
  b.model.constraints.hold(nodesAt(b.mesh, 0, 0.0), 1u);
  b.model.constraints.hold(nodesAt(b.mesh, 1, 0.0), 2u);
  b.model.add(groundSprings(nodesAt(b.mesh, 2, 1.0), {0.0, 0.0, 1.0}));  // holds it before it touches
  b.model.add(std::make_shared<NodalForce>(nodesAt(b.mesh, 2, 1.0), Vec3{0.0, 0.0, -1e4}));
  followPath(b.model, 1.0, {.firstStep = 0.3, .maxAugmentations = 100});
  EXPECT_EQ(b.model.t, 1.0);
  const ContactPlane::Report report = contact.report(b.model.nodes, {1.0, 0.0});
  EXPECT_NEAR(report.force.z, 9e4, 1.0);
  EXPECT_LT(report.deepest, 1e-7);  // the penalty alone: 9e4 N/m² / 2e7 N/m³ = 4.5e-3 m
}

TEST(Statics, MixingConvergesFasterToTheSameWithTheSameFactors) {
  const auto shear = [](int mixing) {
    Bar b = bar({ElementShape::hex8, Formulation::standard}, {2, 2, 2}, {1.0, 1.0, 1.0}, 2e6, 1e6);
    b.model.constraints.hold(nodesAt(b.mesh, 2, 0.0));
    b.model.constraints.prescribe(nodesAt(b.mesh, 2, 1.0), 2, [](double t) { return 0.2 * t; });
    b.model.constraints.prescribe(nodesAt(b.mesh, 2, 1.0), 0, [](double t) { return 0.1 * t; });
    StaticOptions options{.newton = {.maxIterations = 200, .lineSearch = false, .reuseContraction = 0.99}};
    options.firstStep = options.largestStep = 1.0;
    options.newton.mixing = mixing;
    const StaticReport report = solveStatics(b.model, 1.0, options);
    EXPECT_EQ(report.cuts, 0);
    for (const StaticStep& step : report.steps) EXPECT_LE(step.residual, step.tolerance);
    return std::tuple(report.iterations, report.factorisations, b.model.nodes.u);
  };
  const auto [plain, factors, u] = shear(0);
  const auto [mixed, mixedFactors, w] = shear(5);
  EXPECT_LE(mixedFactors, factors);
  EXPECT_LT(4 * mixed, 3 * plain);
  EXPECT_LT(largestDifference(u, w), 1e-7);
  EXPECT_GT(largestDifference(u, std::vector<Vec3>(u.size())), 0.05);
  Bar b = bar({ElementShape::hex8, Formulation::standard}, {1, 1, 1}, {1, 1, 1}, 1e6, 1e6);
  EXPECT_THROW(solveStatics(b.model, 1.0, {.newton = {.mixing = 5}}), InputError);
  EXPECT_THROW(solveStatics(b.model, 1.0, {.newton = {.reuseContraction = 0.5, .mixing = -1}}), InputError);
}

TEST(Statics, MixingKeepsFactorsFromStepToStepWhileTheyDo) {
  const auto factorisations = [](double compression) {
    Bar b = bar({ElementShape::hex8, Formulation::standard}, {2, 2, 2}, {1.0, 1.0, 1.0}, 2e6, 1e6);
    b.model.constraints.hold(nodesAt(b.mesh, 2, 0.0));
    b.model.constraints.prescribe(nodesAt(b.mesh, 2, 1.0), 2, [=](double t) { return -compression * t; });
    const StaticReport report =
        solveStatics(b.model, 1.0,
                     {.newton = {.relativeTolerance = 1e-6, .lineSearch = false, .reuseContraction = 0.5, .mixing = 5},
                      .firstStep = 0.125,
                      .largestStep = 0.125,
                      .iterationTarget = 1000});
    EXPECT_EQ(report.steps.size(), 8u);
    return report.factorisations;
  };
  EXPECT_EQ(factorisations(0.01), 1);
  EXPECT_GT(factorisations(0.6), 1);
}

/// A block pressed onto a plane that is far stiffer: the plane's force comes at once, and kept factors know nothing of
/// it.
StaticReport pressOnto(double gap, const NewtonOptions& newton, std::vector<Vec3>& u) {
  Bar b = bar({ElementShape::hex8, Formulation::standard}, {2, 2, 2}, {1.0, 1.0, 1.0}, 2e6, 1e6);
  const std::vector<int> top = nodesAt(b.mesh, 2, 1.0);
  b.model.constraints.prescribe(top, 0, [](double) { return 0.0; });
  b.model.constraints.prescribe(top, 1, [](double) { return 0.0; });
  b.model.constraints.prescribe(top, 2, [](double t) { return -0.2 * t; });
  ContactOptions options;
  options.penalty = 1e9;
  b.model.add(makeContactPlane(b.mesh, faceSet(b.mesh, "z-"), {{0, 0, -gap}, {0, 0, 1}, {}}, options));
  const StaticReport report =
      solveStatics(b.model, 1.0, {.newton = newton, .firstStep = 0.125, .largestStep = 0.125, .iterationTarget = 1000});
  for (const StaticStep& step : report.steps) EXPECT_LE(step.residual, step.tolerance);
  u = b.model.nodes.u;
  return report;
}

TEST(Statics, KeptFactorsGiveWayWhereContactCloses) {
  int kept = 0, mixed = 0;
  for (const double gap : {0.083, 0.09, 0.095, 0.107, 0.111, 0.118}) {  // it closes within a step, not at its end
    std::vector<Vec3> u, v, w;
    EXPECT_EQ(pressOnto(gap, {}, u).cuts, 0);
    kept += pressOnto(gap, {.lineSearch = false, .reuseContraction = 0.5}, v).cuts;
    mixed += pressOnto(gap, {.lineSearch = false, .reuseContraction = 0.5, .mixing = 5}, w).cuts;
    EXPECT_LT(largestDifference(u, v), 1e-8) << gap;
    EXPECT_LT(largestDifference(u, w), 1e-8) << gap;
  }
  EXPECT_GT(kept, 0);
  EXPECT_LE(mixed, 1.5 * kept);
}

TEST(Statics, AFailureLeavesTheLastEquilibriumAndSaysWhy) {
  Bar b = bar({ElementShape::hex8, Formulation::standard}, {1, 1, 1}, {1.0, 1.0, 1.0}, 2e6, 1e6);
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

/// A bar of Kelvin–Voigt material under a sudden pull creeps towards Hooke's strain: ε = σ/E (1 − e^(−t/τ)).
TEST(Statics, CreepTakesItsTime) {
  constexpr double young = 1e6, time = 2.0, stress = 1.0;
  const auto error = [&](double step) {
    SolidMesh mesh = boxOf(ElementShape::hex8, {1, 1, 1}, {}, {1.0, 1.0, 1.0});
    Model model = makeModel(mesh);
    model.add(makeSolid(mesh, pointMaterial(kelvinVoigt(pointMaterial(Hencky{young, 0.0, 1000.0}), time, young, 0.0))));
    for (int c = 0; c < 3; ++c) model.constraints.hold(nodesAt(mesh, c, 0.0), 1u << c);
    model.add(nodalForce(nodesAt(mesh, 2, 1.0), {0.0, 0.0, 0.25 * stress}));
    model.t = 5.0;  // it counts from wherever it starts
    solveStatics(model, 5.0 + time, {.firstStep = step, .largestStep = step});
    const double found = model.nodes.u[static_cast<std::size_t>(nodesAt(mesh, 2, 1.0)[0])].z;
    return found * young / stress - (1.0 - std::exp(-1.0));
  };
  const double coarse = error(0.1), fine = error(0.05);
  EXPECT_LT(std::abs(fine), 0.02);
  EXPECT_NEAR(coarse / fine, 2.0, 0.1);  // rates by backward differences
}

}  // namespace
}  // namespace dovetail::fem
