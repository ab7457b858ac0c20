// Explicit runs in which the grid is renewed: books, momenta, threads.
#include <gtest/gtest.h>

#include <cmath>

#include "../threads.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "random_points.hpp"

namespace dovetail::mpm::test {
namespace {

struct Course {
  double residual = 0.0, lost = 0.0, moved = 0.0;  // J; of all that was kinetic
  Vec3 momentum, turning;
  std::int64_t renewals = 0;
  std::vector<Vec3> x;
};

struct Flight {
  std::shared_ptr<PointSolid> points;
  fem::Model model;
};

/// A block of 0.5 m that flies, turns and vibrates.
Flight flying(Transfer transfer, bool plane, Shape shape) {
  MaterialPoints points = block({}, {0.5, 0.5, 0.25}, plane ? 0.0625 : 0.125, plane);
  for (std::size_t p = 0; p < points.x.size(); ++p) {
    const Vec3& x = points.x[p];
    points.v[p] = Vec3{8.0, 3.0, 0.0} + cross({0.0, 0.0, 10.0}, x) + 2.0 * Vec3{std::cos(6.0 * x.x), 0.0, 0.0};
  }
  const GridOptions grid{.spacing = plane ? 0.125 : 0.25, .shape = shape, .plane = plane};
  Flight flight{makePoints(points, elastic(), {.grid = grid, .transfer = transfer}), {}};
  flight.model = makeModel(flight.points);
  fem::addMass(flight.model);
  return flight;
}

/// 0.06 s of it.
Course fly(Transfer transfer, double fraction, bool plane = true, Shape shape = Shape::quadratic) {
  auto [solid, model] = flying(transfer, plane, shape);
  const double dt = 0.06 / std::round(0.06 / (fraction * 0.4e-3));
  fem::ExplicitIntegrator run(model, dt);
  const Vec3 momentum = fem::momentum(model.nodes), turning = fem::angularMomentum(model.nodes);
  Course course;
  course.moved = run.kineticEnergy();
  run.run(std::lround(0.06 / dt));
  course.residual = run.ledger().residual();
  for (const auto& channel : run.ledger().channels())
    if (channel.name == "renewals of points") course.lost = channel.joules;
  course.momentum = fem::momentum(model.nodes) - momentum;
  course.turning = fem::angularMomentum(model.nodes) - turning;
  course.renewals = solid->renewals();
  course.x = solid->places(model.nodes);
  return course;
}

TEST(Renewals, KeepTheBooksToSecondOrder) {
  for (const Transfer transfer : {Transfer::flip, Transfer::apic}) {
    std::vector<Course> all;
    for (const double fraction : {1.0, 0.5, 0.25, 0.125}) all.push_back(fly(transfer, fraction));
    for (const Course& one : all) {
      EXPECT_GT(one.renewals, 5);
      EXPECT_GT(one.lost, 0.0);
    }
    for (std::size_t k = 0; k < 3; ++k) EXPECT_GT(std::log2(all[k].residual / all[k + 1].residual), 1.8) << k;
    EXPECT_LT(std::abs(all.back().residual), 1e-6 * all.back().moved);
    EXPECT_NEAR(all.back().lost, all[0].lost, 0.03 * all[0].lost);  // as the grid travels, not as steps pass
  }
}

TEST(Renewals, KeepMomenta) {
  for (const bool plane : {true, false})
    for (const Shape shape : {Shape::quadratic, Shape::cubic}) {
      const Course course = fly(Transfer::apic, 1.0, plane, shape);
      EXPECT_LE(norm(course.momentum), 1e-11 * course.moved);
      EXPECT_LE(norm(course.turning), 1e-11 * course.moved);
    }
}

/// In steps of several times the explicit limit.
TEST(Renewals, KeepTheBooksOfImplicitSteps) {
  const Course explicitly = fly(Transfer::apic, 1.0);
  for (const fem::Scheme& scheme : {fem::newmark(), fem::energyMomentum(), fem::generalisedAlpha(0.8)}) {
    auto [solid, model] = flying(Transfer::apic, true, Shape::quadratic);
    fem::ImplicitIntegrator run(model, 0.6e-3, {.scheme = scheme, .massFraction = 0.0});
    const Vec3 momentum = fem::momentum(model.nodes), turning = fem::angularMomentum(model.nodes);
    run.run(100);
    EXPECT_NEAR(static_cast<double>(solid->renewals()), static_cast<double>(explicitly.renewals), 1.0);
    EXPECT_LE(std::abs(run.ledger().residual()), 1e-3 * explicitly.moved) << scheme.name;
    EXPECT_NEAR(run.ledger().find("renewals of points", EnergyLedger::Kind::booked)->joules, explicitly.lost,
                0.1 * explicitly.lost);
    EXPECT_LE(norm(fem::momentum(model.nodes) - momentum), 1e-7 * norm(momentum));
    EXPECT_LE(norm(fem::angularMomentum(model.nodes) - turning), 1e-3 * norm(turning));
  }
}

TEST(Renewals, RefuseConstraintsOfNodesThatGo) {
  auto [solid, model] = flying(Transfer::flip, true, Shape::quadratic);
  model.constraints.hold(std::vector<int>{0});
  fem::ExplicitIntegrator run(model, 0.2e-3);
  EXPECT_THROW(run.run(300), InputError);
}

TEST(Renewals, GoOnFromAStateWithOtherNodes) {
  const auto started = [] { return flying(Transfer::flip, true, Shape::quadratic); };
  Flight whole = started(), broken = started(), again = started();
  const double dt = 0.4e-3;
  fem::ExplicitIntegrator first(whole.model, dt), second(broken.model, dt), third(again.model, dt);
  first.run(150);
  second.run(75);
  ByteWriter state;
  second.save(state);
  third.run(3);  // on another grid
  EXPECT_NE(again.model.nodes.u.size(), broken.model.nodes.u.size());
  ByteReader archive(state.bytes());
  third.load(archive);
  third.run(75);
  EXPECT_EQ(again.points->renewals(), whole.points->renewals());
  EXPECT_TRUE(again.points->places(again.model.nodes) == whole.points->places(whole.model.nodes));
  EXPECT_EQ(third.ledger().residual(), first.ledger().residual());

  std::vector<char> damaged = state.bytes();
  damaged.resize(damaged.size() / 2);
  ByteReader cut(damaged);
  const std::vector<Vec3> before = again.points->places(again.model.nodes);
  EXPECT_THROW(third.load(cut), InputError);
  EXPECT_TRUE(again.points->places(again.model.nodes) == before);
}

TEST(Renewals, HaveTheSameDigitsForAnyThreads) {
  const std::vector<Vec3> one = onThreads(1, [] { return fly(Transfer::apic, 1.0).x; });
  EXPECT_TRUE(onThreads(2, [] { return fly(Transfer::apic, 1.0).x; }) == one);
}

}  // namespace
}  // namespace dovetail::mpm::test
