// Momentum, angular momentum and mass with everything that gave or took some.
#include <algorithm>
#include <array>
#include <sstream>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "full_scene.hpp"

namespace dovetail::coupling {
namespace {

/// Of both residuals, relative to all impulses: linear, angular.
std::array<double, 2> residuals(const CoupledRun& run) {
  const Totals totals = run.totals();
  return {norm(totals.residual.linear) / totals.turnedOver, norm(totals.residual.angular) / totals.turnedOverAngular};
}

bool hasChannel(const Totals& totals, const std::string& name) {
  return std::ranges::any_of(totals.given.channels(), [&](const auto& channel) { return channel.name == name; });
}

class Books : public testing::TestWithParam<Case> {
protected:
  static bool isImplicit() { return GetParam().stepping == Stepping::implicitSteps; }
  /// To the tolerance of the solid's solver.
  static double tolerance() { return isImplicit() ? 1e-9 : 1e-12; }
};
INSTANTIATE_TEST_SUITE_P(MacroSteps, Books, macroCases, [](const auto& c) { return c.param.name; });

TEST_P(Books, CloseWithWallsSupportsClumpsInsertionAndOutlet) {
  const auto run = fullRun({.name = "block", .stepping = GetParam().stepping});
  dem::addWall(run->grains, dem::makePlane({0.06, 0, 0}, {1, 0, 0}));
  dem::addWall(run->grains, dem::MeshWall{}).wall =
      dem::makeWall({{0.55, -1, -1}, {0.55, 2, -1}, {0.55, 0.3, 2}}, {{0, 1, 2}});
  dem::damping(run->grains).viscousRate = 0.3;
  dem::damping(run->grains).local = 0.1;
  const std::vector<std::int64_t> driven{run->grains.particles.id[3]};
  run->grains.terms.add(dem::DriveTerm(
      driven,
      [](double t) {
        return Vec3{0.01 * std::sin(9.0 * t), 0.0, 0.0};
      },
      [](double t) {
        return Vec3{0.09 * std::cos(9.0 * t), 0.0, 0.0};
      }));
  run->start(dt, {.stepsPerMacroStep = GetParam().K});
  for (int part = 0; part < 4; ++part) {
    run->advance(500 / GetParam().K);
    const auto [linear, angular] = residuals(*run);
    EXPECT_LT(linear, tolerance()) << run->totals();
    EXPECT_LT(angular, isImplicit() ? 1e-6 : 1e-12) << run->totals();
  }
  const Totals totals = run->totals();
  EXPECT_GT(run->grains.entered.count, 20);
  EXPECT_GT(run->grains.left.count, 0);
  EXPECT_LT(std::abs(totals.massResidual), 1e-13 * totals.mass);
  for (const char* name : {"particles: gravity", "particles: walls", "particles: mesh walls", "particles: damping",
                           "particles: drive", "block: supports", "entered", "left"})
    EXPECT_TRUE(hasChannel(totals, name)) << name;
}

/// Newmark's steps keep angular momentum to second order, energy–momentum steps to the tolerance of their solver, and
/// loads kick either alike.
TEST(EnergyMomentumWindows, KeepAngularMomentumToTheTolerance) {
  const auto residual = [](const fem::ImplicitOptions& implicitOptions, int K) {
    const auto run =
        fullRun({.name = "block", .stepping = Stepping::implicitSteps, .implicitOptions = implicitOptions});
    run->start(dt, {.stepsPerMacroStep = K});
    run->advance(800 / K);
    EXPECT_LT(std::abs(run->ledger().residual()), 1e-2 * run->ledger().storedAtOpening());
    return residuals(*run)[1];
  };
  for (const int K : {1, 4}) {
    const fem::ImplicitOptions conserving{.scheme = fem::energyMomentum(), .relativeTolerance = 1e-12};
    EXPECT_LT(residual(conserving, K), 1e-12) << K;
    EXPECT_GT(residual({.scheme = fem::newmark(), .relativeTolerance = 1e-12}, K), 1e-11) << K;
  }
}

/// Everything that acts on a solid but its elements: supports that move, held through the list of constraints, a mass
/// that is not lumped, loads with and without an energy.
TEST_P(Books, CloseWithMovingSupportsAndLoads) {
  for (const double massFraction : {0.0, 0.5}) {
    const auto run = emptyRun();
    const fem::SolidMesh mesh = tetBlock();
    auto model = block(mesh, false);
    model->add(fem::gravity({0.0, 0.0, -9.81}));
    model->add(fem::gravity([](double t) { return Vec3{3.0 * std::sin(50.0 * t), 0.0, 0.0}; }, "shaking"));
    model->add(fem::deadPressure(mesh, mesh.faceSets.at("x+"), 300.0));
    model->add(fem::massDamping(2.0));
    const std::vector<int>& bottom = mesh.nodeSets.at("z-");
    model->constraints.prescribe(bottom, 0, fem::TimeFunction([](double t) { return 0.01 * std::sin(20.0 * t); }));
    model->constraints.hold(bottom, fem::componentY | fem::componentZ);
    SolidSide& side = run->addSolid(std::move(model),
                                    {.name = "block", .stepping = GetParam().stepping, .massFraction = massFraction});
    run->grains.terms.add(
        surface::SurfaceContact(side, surface::SurfaceCoupler(topOf(mesh)), frictionalLaws(), "contacts"));
    addLayer(*run, 20);
    run->start(dt, {.stepsPerMacroStep = GetParam().K});
    run->advance(800 / GetParam().K);
    const auto [linear, angular] = residuals(*run);
    EXPECT_LT(linear, tolerance()) << run->totals();
    EXPECT_LT(angular, isImplicit() ? 2e-5 : 1e-12) << run->totals();
    EXPECT_LT(std::abs(run->ledger().residual()), 1e-2 * run->ledger().joules("particles: friction")) << run->ledger();
    for (const char* name : {"block: gravity", "block: shaking", "block: dead pressure", "block: mass damping"})
      EXPECT_TRUE(hasChannel(run->totals(), name)) << name;
  }
}

/// Newmark's steps turn a solid by angles that are right to second order.
TEST(Book, AngularResidualOfImplicitSolidsFallsWithTheSquareOfTheStep) {
  const auto after = [](double step) {
    const auto run = fullRun({.name = "block", .stepping = Stepping::implicitSteps});
    run->start(step);
    run->advance(static_cast<std::int64_t>(std::llround(0.02 / step)));
    return residuals(*run)[1];
  };
  const double coarse = after(1e-4), fine = after(0.5e-4);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.5) << coarse << " " << fine;
}

TEST(Book, ClosesWithLoadsOneStepOldAndARunBroughtToRest) {
  for (const Lag lag : {Lag::load, Lag::loadAndSkin}) {
    const auto run = fullRun({.name = "block"});
    run->start(dt, {.stepsPerMacroStep = 2, .lag = lag});
    run->advance(200);
    run->stop();
    run->advance(200);
    EXPECT_LT(residuals(*run)[0], 1e-12) << run->totals();
    EXPECT_LT(residuals(*run)[1], 1e-12) << run->totals();
    EXPECT_TRUE(hasChannel(run->totals(), "staggering error"));
    EXPECT_TRUE(hasChannel(run->totals(), "kinetic damping"));
  }
}

/// Linear momentum, and moments about the axis that repeats.
TEST(Book, ClosesWhereSpaceRepeats) {
  const auto run = emptyRun();
  run->grains.pairs.setPeriodicity({{{0.0, 0.0, -1.0}, {0.6, 0.6, 1.0}}, {true, false, false}});
  addLayer(*run, 36);
  for (Vec3& v : run->grains.particles.v) v.x += 2.0;
  dem::addWall(run->grains, dem::makePlane({}, {0, 0, 1}));
  dem::addWall(run->grains, dem::makePlane({}, {0, 1, 0}));
  dem::addWall(run->grains, dem::makePlane({0, 0.6, 0}, {0, -1, 0}));
  run->start(dt);
  run->advance(3000);
  EXPECT_LT(residuals(*run)[0], 1e-12) << run->totals();
  EXPECT_LT(residuals(*run)[1], 1e-12) << run->totals();
}

TEST(Book, GoesOnWithAStateAndWithAnotherStep) {
  const auto whole = fullRun({.name = "block"}), parted = fullRun({.name = "block"});
  for (CoupledRun* run : {whole.get(), parted.get()}) run->start(dt, {.stepsPerMacroStep = 2});
  whole->advance(100);
  parted->load(whole->save());
  for (CoupledRun* run : {whole.get(), parted.get()}) {
    run->advance(100);
    run->start(0.5 * dt);
    run->advance(200);
  }
  EXPECT_EQ(whole->totals().residual, parted->totals().residual);
  EXPECT_LT(residuals(*whole)[0], 1e-12) << whole->totals();
  EXPECT_LT(residuals(*whole)[1], 1e-12) << whole->totals();
}

TEST(Book, IsPrinted) {
  const auto run = fullRun({.name = "block"});
  run->start(dt);
  run->advance(300);
  std::ostringstream text;
  text << run->totals();
  for (const char* part : {"particles: gravity", "block: supports", "residual", "mass"})
    EXPECT_NE(text.str().find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace dovetail::coupling
