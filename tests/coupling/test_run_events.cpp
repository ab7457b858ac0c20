// Particles that are sorted, come and go, and copies of the particles' model, while solids are there.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/coupling/rest.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/relax.hpp"
#include "spring_scene.hpp"

namespace dovetail::coupling {
namespace {

TEST(RunEvents, RemovedParticlesTakeTheirEnergyAlong) {
  const auto run = springRun({.held = true});
  dem::addParticle(run->grains.particles, {0.1, 0.1, 1.0}, {0.0, 0.0, 1.0}, 0.03, dem::Mass{0.3});
  run->start(1e-4);
  run->advance(10);
  dem::removeParticles(run->grains, std::vector<int>{4});
  run->advance(10);
  EXPECT_LT(std::abs(run->ledger().residual()), 1e-3 * run->ledger().storedAtOpening());
}

TEST(RunEvents, ACopyOfTheParticlesLoadsNobody) {
  const auto run = springRun({});
  run->start(1e-4);
  run->advance(5);
  const std::vector<Vec3> before = run->solid(0).load.force;
  dem::Model copy = run->grains;
  dem::run(copy, 1e-4, 5);
  EXPECT_EQ(before, run->solid(0).load.force);
  run->advance(5);
}

TEST(RunEvents, SettlesAndBooksWhatThatTook) {
  for (const Stepping stepping : {Stepping::explicitSteps, Stepping::implicitSteps}) {
    const auto run = springRun({.stepping = stepping, .held = true});
    run->grains.gravity = {0.0, 0.0, -9.81};
    run->start(2e-4);
    const RestReport report = relax(*run);
    EXPECT_TRUE(report.atRest) << report.residual;
    const dem::Particles& p = run->grains.particles;
    for (std::size_t i = 0; i < p.size(); ++i) EXPECT_LT(norm(p.f[i]), 2e-3 * 9.81 * p.mass[i]);
    const double booked = run->ledger().joules("kinetic damping");
    EXPECT_GT(booked, 0.0);
    EXPECT_LT(std::abs(run->ledger().residual()), 1e-2 * booked);
  }
  const auto run = springRun({});
  run->start(1e-4);
  EXPECT_THROW(relax(*run, {.tolerance = 0.0}), InputError);
  EXPECT_FALSE(relax(*run, {.tolerance = 1e-8, .steps = 1}).atRest);
}

/// Relaxation, steps and removals of walls, with and without a solid in the run: the ledger begin at the first start.
TEST(RunEvents, GrainsMayComeToRestAloneBeforeTheRunStarts) {
  for (const bool withSolid : {false, true}) {
    const auto run = withSolid ? springRun({.held = true}) : std::make_unique<CoupledRun>();
    dem::Model& grains = run->grains;
    if (!withSolid) {
      grains.laws = dem::makeContactLaws(dem::ElasticLaw{{.stiffness = 2e4}});
      for (int i = 0; i < 3; ++i)
        dem::addParticle(grains.particles, {0.03 * i, 0.0, 0.0099}, {}, 0.01, dem::Density{2500});
    }
    grains.gravity = {0.0, 0.0, -9.81};
    dem::addWall(grains, dem::makePlane({}, {0.0, 0.0, 1.0}));
    dem::addWall(grains, dem::makePlane({-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}));
    dem::relax(grains, {.tolerance = 1e-3, .steps = 2000});
    dem::removeWall(grains, dem::primitiveWall(grains, 0));
    run->start(1e-4);
    run->advance(20);
    const Totals totals = run->totals();
    EXPECT_LT(norm(totals.residual.linear), 1e-12 * totals.turnedOver) << withSolid;
    EXPECT_EQ(totals.given.channels()[0].name, "particles: gravity");
  }
}

TEST(RunEvents, SettlesInPartsAsInOne) {
  const auto made = [] {
    auto run = springRun({.held = true});
    run->grains.gravity = {0.0, 0.0, -9.81};
    run->start(2e-4);
    return run;
  };
  const auto whole = made(), parts = made();
  const RestCriterion rest{.tolerance = 1e-6};
  const RestReport report = relax(*whole, rest);
  ASSERT_TRUE(report.atRest);
  RestProgress progress;
  int calls = 1;
  for (; !relaxOn(*parts, rest, progress, 7); ++calls) parts->load(parts->save());
  EXPECT_EQ(calls, (report.steps + 6) / 7);
  EXPECT_EQ(progress.report.steps, report.steps);
  EXPECT_EQ(progress.report.residual, report.residual);
  EXPECT_EQ(parts->grains.particles.x, whole->grains.particles.x);
  EXPECT_EQ(parts->solid(0).nodes().u, whole->solid(0).nodes().u);
}

/// The fastest node that connectors see.
class Watch final : public Connector {
public:
  using Connector::Connector;
  std::string name() const override { return "watch"; }
  std::unique_ptr<dem::Term> clone() const override { return std::make_unique<Watch>(*this); }
  void addForces(dem::Model&, const dem::Step&) override {
    for (const Vec3& v : side().nodes().v) fastest = std::max(fastest, norm(v));
  }
  double fastest = 0.0;
};

TEST(RunEvents, ConnectorsSeeImplicitSolidsRestWhereTheyRest) {
  const auto run = springRun({.stepping = Stepping::implicitSteps, .held = true});
  run->grains.gravity = {0.0, 0.0, -9.81};
  run->grains.terms.add(Watch(run->solid(0)));
  run->start(1e-3);
  EXPECT_TRUE(relax(*run, {.tolerance = 1e-18}).atRest);
  // Between own forces, which act at once, and what connectors do all the time, nodes rush by this speed.
  const fem::Nodes& nodes = run->solid(0).nodes();
  double rush = 0.0;
  for (std::size_t n = 0; n < nodes.X.size(); ++n)
    rush = std::max(rush, run->dt() * norm(run->solid(0).load.force[n]) / nodes.mass[n]);
  EXPECT_GT(rush, 1e-2);
  for (const int K : {1, 2, 3, 4, 7}) {
    run->start(1e-3 / K, {.stepsPerMacroStep = K});
    run->advance(2);
    Watch& watch = *run->grains.terms.all<Watch>().front();
    watch.fastest = 0.0;
    run->advance(3);
    EXPECT_LT(watch.fastest, 1e-4 * rush) << K;
  }
}

/// Pulls at one particle in both half macro steps around their ends.
class Pull final : public Connector {
public:
  Pull(SolidSide& side, std::int64_t id, const Vec3& force) : Connector(side), id_(id), force_(force) {}
  std::string name() const override { return "pull"; }
  std::unique_ptr<dem::Term> clone() const override { return std::make_unique<Pull>(*this); }
  Order order() const override { return Order::constraints; }
  void constrainMacroStep(const dem::Model& m, std::span<const Vec3>, double, std::span<Vec3> onParticles,
                          NodalLoad& load) const override {
    onParticles[static_cast<std::size_t>(dem::find(m.particles, id_))] += force_;
    load.add(0, -force_);
  }

private:
  std::int64_t id_;
  Vec3 force_;
};

TEST(RunEvents, WhatConstraintsDoToWindowsGoesWithItsParticle) {
  CoupledRun run;
  for (int k = 0; k < 4; ++k) dem::addParticle(run.grains.particles, {0.2 * k, 0.0, 1.0}, {}, 0.03, dem::Mass{0.5});
  dem::ElasticLaw law;
  law.normal.stiffness = 1e4;
  run.grains.laws = dem::makeContactLaws(law);
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {1, 1, 1}, {}, {0.2, 0.2, 0.2});
  SolidSide& side = run.addSolid(block(mesh, false));
  const Vec3 force{3.0, 0.0, 0.0};
  run.grains.terms.add(Pull(side, 2, force));
  run.start(1e-4, {.stepsPerMacroStep = 2});
  run.advance(5);
  dem::removeParticles(run.grains, std::vector<int>{0});
  dem::addParticle(run.grains.particles, {0.0, 0.5, 1.0}, {}, 0.03, dem::Mass{0.5});
  run.advance(5);
  const dem::Particles& p = run.grains.particles;
  for (std::size_t i = 0; i < p.size(); ++i)
    EXPECT_LT(norm(p.v[i] - (p.id[i] == 2 ? run.time() / 0.5 * force : Vec3{})), 1e-14) << p.id[i];
  EXPECT_LT(norm(run.totals().momentum), 1e-14);
}

TEST(RunEvents, SortingChangesNothingButTheOrder) {
  const auto sorted = springRun({}), plain = springRun({});
  sorted->grains.sortEvery = 1;
  plain->grains.sortEvery = 0;
  for (CoupledRun* run : {sorted.get(), plain.get()}) {
    run->grains.pairs.setSkin(1e-4);
    run->start(1e-4);
    run->advance(300);
  }
  for (std::int64_t id = 0; id < 4; ++id) {
    const auto i = static_cast<std::size_t>(dem::find(sorted->grains.particles, id));
    const auto j = static_cast<std::size_t>(dem::find(plain->grains.particles, id));
    EXPECT_LT(norm(sorted->grains.particles.x[i] - plain->grains.particles.x[j]), 1e-13);
  }
}

}  // namespace
}  // namespace dovetail::coupling
