// Material points that meet grains, walls and each other in coupled runs.
#include <gtest/gtest.h>

#include <cmath>

#include "../threads.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/mesh/mesh_places.hpp"
#include "dovetail/mpm/face_contact.hpp"
#include "dovetail/mpm/fill.hpp"
#include "dovetail/mpm/point_contact.hpp"
#include "random_points.hpp"

namespace dovetail::mpm::test {
namespace {

using coupling::CoupledRun;
using coupling::Stepping;

constexpr double youngs = 1e6, poisson = 0.3, spacing = 0.0625;
const double confined = youngs * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));

struct Case {
  Stepping stepping = Stepping::explicitSteps;
  int K = 1;
  double fraction = 1.0;  ///< of the step
  Transfer transfer = Transfer::apic;
  double friction = 0.3;
  bool plane = true;
  bool faces = false;  ///< in place of spheres
};

/// A block of 0.5 m that falls on loose grains at 3 m/s and drives some aside.
struct Splash {
  std::shared_ptr<PointSolid> points;
  CoupledRun run;
  std::size_t grains = 0;
};

std::unique_ptr<Splash> splash(const Case& c) {
  auto made = std::make_unique<Splash>();
  const double d = c.plane ? spacing : 2.0 * spacing, k = c.plane ? confined : confined * d;
  MaterialPoints points = block({}, {0.5, 0.5, 0.25}, d, c.plane);
  for (Vec3& v : points.v) v = {1.0, -3.0, 0.0};
  const GridOptions grid{.spacing = 2.0 * d, .plane = c.plane};
  made->points = makePoints(points, elastic(youngs, poisson), {.grid = grid, .transfer = c.transfer});
  CoupledRun& run = made->run;
  auto& side = run.addSolid(std::make_unique<fem::Model>(makeModel(made->points)),
                            {.name = "block",
                             .stepping = c.stepping,
                             .implicitOptions = {.scheme = fem::newmark(), .relativeTolerance = 1e-11}});
  run.grains.laws = dem::makeContactLaws(dem::FrictionalLaw{{k}, {0.8 * k, c.friction}});
  for (int j = 0; j < (c.plane ? 1 : 2); ++j)
    for (int i = 0; i < 5; ++i)
      dem::addParticle(run.grains.particles, {0.05 + 0.1 * i, -0.055, 0.05 + 0.12 * j * (c.plane ? 0.0 : 1.0)}, {},
                       0.05, dem::Mass{c.plane ? 8.0 : 2.0});
  if (c.plane)
    for (Vec3& x : run.grains.particles.x) x.z = 0.0;
  made->grains = run.grains.particles.size();
  if (c.faces) {
    const fem::SolidMesh skin = facesOfBox(grid, {{}, {0.5, 0.5, c.plane ? 1.0 : 0.25}}, 2);
    const std::size_t set = made->points->addMarkers(skin.X);
    run.grains.terms.add(FaceContact(side, made->points, set, fem::faceSet(skin, "skin"), run.grains.laws));
  } else {
    addSpheres(run.grains, side, made->points, {.radius = 0.5 * d});
  }
  run.start(c.fraction * 1e-4 / (c.stepping == Stepping::explicitSteps ? c.K : 1), {.stepsPerMacroStep = c.K});
  return made;
}

struct Course {
  double residual = 0.0, moved = 0.0;    // J, the largest of 20 instants; of all that was kinetic
  double momentum = 0.0, turning = 0.0;  // of what was turned over
  std::vector<Vec3> x;
  std::int64_t renewals = 0;
};

Course fall(const Case& c, double duration = 0.06) {
  const auto made = splash(c);
  CoupledRun& run = made->run;
  Course course;
  course.moved = run.kineticEnergy();
  constexpr int looks = 20;
  for (int k = 0; k < looks; ++k) {
    run.advance(std::llround(duration / looks / run.macroStep()));
    course.residual = std::max(course.residual, std::abs(run.ledger().residual()));
  }
  const coupling::Totals totals = run.totals();
  course.momentum = norm(totals.residual.linear) / totals.turnedOver;
  course.turning = norm(totals.residual.angular) / totals.turnedOverAngular;
  course.x = made->points->places(run.solid(0).nodes());
  course.renewals = made->points->renewals();
  return course;
}

/// Spins included: points turn with half of the curl of the grid.
TEST(PointContact, KeepsMomenta) {
  for (const auto& [plane, faces] : std::vector<std::pair<bool, bool>>{{true, false}, {false, false}, {true, true}})
    for (const int K : {1, 4}) {
      const Course explicitly = fall({.K = K, .plane = plane, .faces = faces}),
                   implicitly = fall({.stepping = Stepping::implicitSteps, .K = K, .plane = plane, .faces = faces});
      EXPECT_GT(explicitly.renewals, 1);
      EXPECT_LE(explicitly.momentum, 1e-13);
      EXPECT_LE(explicitly.turning, 1e-12);
      EXPECT_GT(implicitly.renewals, 1);
      EXPECT_LE(implicitly.momentum, 1e-12);
      EXPECT_LE(implicitly.turning, 1e-5);  // Newmark's steps: of second order
    }
}

/// Springs of contacts that open and close within a step leave an error of their own.
TEST(PointContact, KeepsTheBooks) {
  const auto residual = [](Case c, double fraction) {
    c.fraction = fraction;
    c.friction = 0.0;
    const Course course = fall(c, 0.04);
    return course.residual / course.moved;
  };
  for (const Case& c : {Case{},
                        {.K = 4},
                        {.transfer = Transfer::flip},
                        {.stepping = Stepping::implicitSteps},
                        {.stepping = Stepping::implicitSteps, .K = 4},
                        {.faces = true},
                        {.K = 4, .faces = true},
                        {.stepping = Stepping::implicitSteps, .faces = true}}) {
    const double coarse = residual(c, 1.0), fine = residual(c, 0.5);
    EXPECT_LT(coarse, 6e-4);
    EXPECT_LT(fine, 0.4 * coarse);
  }
}

TEST(PointContact, GoesOnFromAState) {
  for (const Stepping stepping : {Stepping::explicitSteps, Stepping::implicitSteps})
    for (const auto& [K, faces] : std::vector<std::pair<int, bool>>{{1, false}, {4, false}, {4, true}}) {
      const Case c{.stepping = stepping, .K = K, .faces = faces};
      const auto whole = splash(c), broken = splash(c), again = splash(c);
      const std::int64_t half = std::llround(0.02 / whole->run.macroStep());
      whole->run.advance(half);
      whole->run.advance(half);
      broken->run.advance(half);
      const std::vector<char> state = broken->run.save();
      again->run.advance(3);
      again->run.load(state);
      again->run.advance(half);
      EXPECT_GT(broken->points->renewals(), 0);
      EXPECT_GT(whole->points->renewals(), broken->points->renewals());
      EXPECT_TRUE(again->points->places(again->run.solid(0).nodes()) ==
                  whole->points->places(whole->run.solid(0).nodes()));
      EXPECT_TRUE(again->run.grains.particles.x == whole->run.grains.particles.x);
      EXPECT_EQ(again->run.ledger().residual(), whole->run.ledger().residual());

      std::vector<char> damaged = state;
      damaged.resize(damaged.size() - 40);
      const std::vector<Vec3> before = again->points->places(again->run.solid(0).nodes());
      EXPECT_THROW(again->run.load(damaged), InputError);
      EXPECT_TRUE(again->points->places(again->run.solid(0).nodes()) == before);
      again->run.advance(1);
    }
}

TEST(PointContact, HasTheSameDigitsForAnyThreads) {
  for (const bool faces : {false, true}) {
    const auto run = [&] { return fall({.faces = faces}, 0.04).x; };
    const std::vector<Vec3> one = onThreads(1, run);
    EXPECT_TRUE(onThreads(2, run) == one);
  }
}

/// A block that bounces on a wall, and one that bounces on it.
TEST(PointContact, MeetsWallsAndOtherBodies) {
  CoupledRun run;
  run.grains.laws = dem::makeContactLaws(dem::FrictionalLaw{{confined}, {0.8 * confined, 0.3}});
  dem::addWall(run.grains, dem::makePlane({}, {0.0, 1.0, 0.0}));
  std::vector<std::shared_ptr<PointSolid>> bodies;
  for (const double height : {0.01, 0.52}) {
    MaterialPoints points = block({0.0, height, 0.0}, {0.5, 0.5, 0.0}, spacing, true);
    for (Vec3& v : points.v) v = {1.0, -2.0 * height, 0.0};
    bodies.push_back(makePoints(points, elastic(youngs, poisson),
                                {.grid = {.spacing = 2.0 * spacing}, .name = "body " + formatNumber(height)}));
    auto& side = run.addSolid(std::make_unique<fem::Model>(makeModel(bodies.back())), {.name = bodies.back()->name()});
    addSpheres(run.grains, side, bodies.back(), {.radius = 0.5 * spacing});
  }
  run.start(1e-4);
  const double moved = run.kineticEnergy();
  run.advance(1500);
  const coupling::Totals totals = run.totals();
  EXPECT_LE(norm(totals.residual.linear), 1e-12 * totals.turnedOver);
  EXPECT_LE(norm(totals.residual.angular), 1e-11 * totals.turnedOverAngular);
  EXPECT_LE(std::abs(run.ledger().residual()), 1e-3 * moved);
  double lowest = 1.0;
  for (const auto& body : bodies)
    for (const Vec3& x : body->places(run.solid(body == bodies[0] ? 0 : 1).nodes())) lowest = std::min(lowest, x.y);
  EXPECT_GT(lowest, 0.4 * spacing);
  EXPECT_GT(totals.momentum.y, 0.0);
}

/// What a border gives is the impulse of the points' own forces.
TEST(PointContact, BalancesWhatBordersGive) {
  CoupledRun run;
  MaterialPoints points = block({}, {0.5, 0.5, 0.0}, spacing, true);
  for (Vec3& v : points.v) v = {1.0, -1.0, 0.0};
  const auto body = makePoints(points, elastic(youngs, poisson), {.grid = {.spacing = 2.0 * spacing, .borders = {{}}}});
  auto model = std::make_unique<fem::Model>(makeModel(body));
  model->add(gravity(body, {0.0, -9.81, 0.0}));
  run.addSolid(std::move(model));
  run.start(1e-4);
  const double moved = run.kineticEnergy();
  run.advance(1000);
  const coupling::Totals totals = run.totals();
  EXPECT_GT(body->renewals(), 2);
  EXPECT_LE(norm(totals.residual.linear), 1e-12 * totals.turnedOver);
  EXPECT_LE(norm(totals.residual.angular), 1e-11 * totals.turnedOverAngular);
  EXPECT_LE(std::abs(run.ledger().residual()), 1e-5 * moved);
}

/// Of a contact force there borders take a share, along them as across.
TEST(PointContact, BalancesForcesNearBorders) {
  for (const auto& [kind, faces] : std::vector<std::pair<BorderKind, bool>>{{BorderKind::symmetry, false},
                                                                            {BorderKind::held, false},
                                                                            {BorderKind::symmetry, true},
                                                                            {BorderKind::held, true}}) {
    CoupledRun run;
    run.grains.laws = dem::makeContactLaws(dem::FrictionalLaw{{confined}, {0.8 * confined, 0.5}});
    dem::addParticle(run.grains.particles, {0.08, 0.62, 0.0}, {-2.0, -3.0, 0.0}, 0.1, dem::Mass{30.0});
    const GridOptions grid{.spacing = 2.0 * spacing, .borders = {{.axis = 0, .kind = kind}, {}}};
    const auto body = makePoints(block({}, {0.5, 0.5, 0.0}, spacing, true), elastic(youngs, poisson), {.grid = grid});
    auto& side = run.addSolid(std::make_unique<fem::Model>(makeModel(body)), {.name = "block"});
    if (faces) {
      const fem::SolidMesh skin = facesOfBox(grid, {{}, {0.5, 0.5, 1.0}}, 2);
      run.grains.terms.add(FaceContact(side, body, body->addMarkers(skin.X), fem::faceSet(skin, "y+"), run.grains.laws,
                                       1.0, 0, {}, "contact of points"));
    } else {
      addSpheres(run.grains, side, body, {.radius = 0.5 * spacing});
    }
    run.start(1e-4);
    const double moved = run.kineticEnergy();
    run.advance(600);
    const coupling::Totals totals = run.totals();
    double given = 0.0;
    for (const auto& channel : totals.given.channels())
      if (channel.name == "particles: contact of points") given = norm(channel.given.linear);
    EXPECT_GT(given, 0.1);
    EXPECT_LE(norm(totals.residual.linear), 1e-12 * totals.turnedOver);
    EXPECT_LE(norm(totals.residual.angular), 1e-11 * totals.turnedOverAngular);
    EXPECT_LE(std::abs(run.ledger().residual()), 1e-3 * moved);
  }
}

class Keeps final : public coupling::Connector {
public:
  using Connector::Connector;
  std::string name() const override { return "skin"; }
  std::unique_ptr<dem::Term> clone() const override { return std::make_unique<Keeps>(*this); }
};

TEST(PointContact, IsTheOnlyConnectorOfPoints) {
  const auto made = splash({});
  made->run.grains.terms.add(std::make_unique<Keeps>(made->run.solid(0)));
  EXPECT_THROW(made->run.start(1e-5), InputError);
  const auto twice = splash({.faces = true});
  addSpheres(twice->run.grains, twice->run.solid(0), twice->points, {.radius = 0.5 * spacing});
  EXPECT_THROW(twice->run.start(1e-5), InputError);
  const auto lagging = splash({});
  EXPECT_THROW(lagging->run.start(1e-5, {.lag = coupling::Lag::load}), InputError);
}

/// Implicit solids move once a macro step, explicit ones have forces of their own: both count before anything touches.
TEST(PointContact, KnowsTheStepBeforeTheImpact) {
  for (const Stepping stepping : {Stepping::explicitSteps, Stepping::implicitSteps})
    for (const int K : {1, 4})
      for (const bool faces : {false, true}) {
        const auto made = splash({.stepping = stepping, .K = K, .fraction = 0.5, .friction = 0.0, .faces = faces});
        const double before = made->run.criticalStep().dt;
        double least = before;
        for (int k = 0; k < 20; ++k) {
          made->run.advance(std::llround(0.001 / made->run.macroStep()));
          least = std::min(least, made->run.criticalStep().dt);
        }
        EXPECT_LE(before, 1.6 * least) << K << faces;
      }
}

TEST(PointContact, TellsWhoLeavesTheDomain) {
  const auto made = splash({});
  made->run.grains.domain = dem::Domain{{{-1.0, -0.3, -1.0}, {1.0, 1.0, 1.0}}, dem::EscapePolicy::remove};
  EXPECT_THROW(made->run.advance(4000), NumericalError);
}

}  // namespace
}  // namespace dovetail::mpm::test
