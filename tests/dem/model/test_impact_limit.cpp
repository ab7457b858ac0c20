// The step that first contacts ask for, before there are any; and a run that looks at its state.
#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/dem/laws/materials.hpp"
#include "dovetail/dem/model/impact.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/streams.hpp"

namespace dovetail::dem {
namespace {

constexpr double k = 1e5, mass = 0.01, radius = 0.01;                                                // N/m, kg, m
const double limitOfTwo = 2.0 * std::sqrt(0.5 * mass / k), limitOnWall = 2.0 * std::sqrt(mass / k);  // s

Model twoThatMeetLater(const auto& law) {
  Model m;
  m.laws = makeContactLaws(law);
  addParticle(m.particles, {0, 0, 0}, {1, 0, 0}, radius, Mass{mass});
  addParticle(m.particles, {0.05, 0, 0}, {-1, 0, 0}, radius, Mass{mass});
  return m;
}

double limitOf(const Model& m) { return impactLimit(m, demandOf(m)).dt; }

TEST(ImpactLimit, OfTwoThatMeetLaterIsThatOfTheirContact) {
  Model m = twoThatMeetLater(ElasticLaw{{k}});
  EXPECT_NEAR(limitOf(m), limitOfTwo, 1e-9 * limitOfTwo);
  Model beyond = m;
  EXPECT_THROW(run(beyond, 1.01 * limitOfTwo, 1), InputError);
  run(m, 0.99 * limitOfTwo, 400);
  EXPECT_LT(m.particles.v[0].x, 0.0);
  EXPECT_FALSE(m.passed);
}

TEST(ImpactLimit, CountsWallsAndNewcomersAndLeavesDrivenOnesOut) {
  Model m;
  m.laws = makeContactLaws(ElasticLaw{{k}});
  EXPECT_EQ(limitOf(m), std::numeric_limits<double>::infinity());
  const InsertionOptions settings{.region = {{0, 0, 1}, {1, 1, 2}},
                                  .sizes = UniformSizes{radius, 2.0 * radius},
                                  .density = {2500.0},
                                  .numberPerSecond = 1.0};
  addParticle(m.particles, {}, {}, radius, Mass{mass});
  EXPECT_EQ(limitOf(m), std::numeric_limits<double>::infinity());
  addWall(m, makePlane({0, 0, -0.5}, {0, 0, 1}));
  EXPECT_NEAR(limitOf(m), limitOnWall, 1e-9 * limitOnWall);
  m.terms.add(DriveTerm(
      {0}, [](double) { return Vec3{}; }, [](double) { return Vec3{}; }));
  EXPECT_EQ(limitOf(m), std::numeric_limits<double>::infinity());
  addInsertion(m, settings);
  const double smallest = 2500.0 * 4.0 / 3.0 * M_PI * radius * radius * radius;
  EXPECT_NEAR(limitOf(m), 2.0 * std::sqrt(0.5 * smallest / k), 1e-9 * limitOnWall);
  EXPECT_EQ(impactLimit(m, demandOf(m)).owner, "an impact of inserted grains with inserted grains");
}

TEST(ImpactLimit, KnowsDashpotsAcrossTheContact) {
  const FrictionalLaw law{{k, 0.3}, {2.0 / 7.0 * k, 1.0, 20.0}, {}, {}};
  Model m = twoThatMeetLater(law);
  switchOnRotation(m.particles);
  const double limit = limitOf(m);
  m.particles.x[1].x = 1.999 * radius;
  findForces(m);
  EXPECT_NEAR(limit, criticalStep(m).dt, 1e-6 * limit);
  EXPECT_LT(limit, 0.1 * limitOfTwo);
}

/// ½ m v² = 2/5 K δ^(5/2), dF/dδ = 3/2 K √δ.
TEST(ImpactLimit, StiffensWithTheSpeedUnderHertzsLaw) {
  const Material soft{1e7, 0.3, 2500.0};
  const HertzMindlinLaw law = hertzMindlin(soft, soft, {});
  for (const double speed : {0.1, 1.0, 100.0}) {
    Model m = twoThatMeetLater(law);
    m.particles.v[0].x = speed, m.particles.v[1].x = 0.0;
    const double K = 4.0 / 3.0 * effectiveModulus(soft, soft) * std::sqrt(0.5 * radius);
    const double depth = std::pow(0.25 * 0.5 * mass * speed * speed * 5.0 / K, 0.4);
    const double limit = 2.0 / std::sqrt(1.5 * K * std::sqrt(depth) / (0.5 * mass));
    EXPECT_NEAR(impactLimit(m, demandOf(m)).overlap, std::min(2.0, depth / radius), 1e-5 * depth / radius) << speed;
    if (depth < radius) {
      EXPECT_NEAR(limitOf(m), limit, 1e-5 * limit) << speed;
    }
  }
}

TEST(ImpactLimit, CountsWhatGravityAdds) {
  Model m;
  m.laws = makeContactLaws(ElasticLaw{{k}});
  m.gravity = {0, 0, -9.81};
  addParticle(m.particles, {0, 0, 2.0}, {}, radius, Mass{mass});
  addWall(m, makePlane({}, {0, 0, 1}));
  const double speed = std::sqrt(2.0 * 9.81 * 2.0);
  EXPECT_NEAR(impactLimit(m, demandOf(m)).overlap, speed * std::sqrt(mass / k) / radius, 1e-6);
}

/// Six that come together on one: more contacts than an impact has.
Model sixOnOne() {
  Model m;
  m.laws = makeContactLaws(ElasticLaw{{k}});
  addParticle(m.particles, {}, {}, radius, Mass{mass});
  for (const Vec3 from : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}})
    addParticle(m.particles, 0.021 * from, -0.1 * from, radius, Mass{1e5 * mass});
  return m;
}

TEST(RunsThatLook, TellOnceThatTheStateHasPassedTheLimit) {
  Model m = sixOnOne();
  const double dt = 0.95 * impactLimit(m, demandOf(m)).dt;
  run(m, dt, 20);
  EXPECT_FALSE(m.passed);
  run(m, dt, 500);
  ASSERT_TRUE(m.passed);
  EXPECT_EQ(m.passed->dt, dt);
  EXPECT_LT(m.passed->limit.dt, dt);
  EXPECT_NE(m.passed->limit.owner.find("particle 0"), std::string::npos);
  const double time = m.passed->time;
  run(m, dt, 2000);
  EXPECT_EQ(m.passed->time, time);
}

/// Long before the first look, as it breaks down at once.
TEST(RunsThatLook, TellThatTheStepWasTooLongWhereTheyBreakDown) {
  Model m;
  m.laws = makeContactLaws(ElasticLaw{{k}});
  for (const double x : {0.0, 0.9999, 1.9998, 2.9997})
    addParticle(m.particles, {2.0 * radius * x, 0, 0}, {}, radius, Mass{mass});
  addWall(m, makePlane({-radius, 0, 0}, {1, 0, 0}));
  const double limit = std::min(impactLimit(m, demandOf(m)).dt, criticalStep(m).dt);
  m.refusesUnstableSteps = false;
  run(m, 4.0 * limit, 1);
  m.refusesUnstableSteps = true;
  try {
    run(m, 4.0 * limit, 30);
    FAIL() << "it went on";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("exceeds the critical step"), std::string::npos) << error.what();
  }
}

TEST(RunsThatLook, GoOnWhenTermsAreAdded) {
  Model m = sixOnOne();
  const double dt = 0.95 * impactLimit(m, demandOf(m)).dt;
  run(m, dt, 130);
  ASSERT_GT(dt, criticalStep(m).dt);
  addOutlet(m, geometry::Box{{1, 1, 1}, {2, 2, 2}});
  EXPECT_NO_THROW(run(m, dt, 1));
  EXPECT_TRUE(m.passed);
  EXPECT_THROW(run(m, 1.001 * dt, 1), InputError) << "another step is chosen anew";
}

}  // namespace
}  // namespace dovetail::dem
