// What is asked of materials, how often, and what comes out when they throw.
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <stdexcept>

#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

/// Remembers the largest F₁₁; counts the points that it is asked for.
class CountingMaterial : public PointMaterial {
public:
  std::string name() const override { return "counting"; }
  double density() const override { return 1000.0; }
  std::size_t historySize() const override { return 1; }
  void evaluate(const PointBatch& batch) const override {
    points += static_cast<int>(pointLanes * batch.groups);
    inner_->evaluate(batch);
    for (std::size_t p = 0; p < pointLanes * batch.groups; ++p) {
      batch.newHistory[p] = std::max(batch.history[p], batch.F[9 * pointLanes * (p / pointLanes) + p % pointLanes]);
      if (batch.dissipated) batch.dissipated[p] = 1.0;
    }
  }
  mutable std::atomic<int> points = 0;

private:
  std::shared_ptr<const PointMaterial> inner_ = std::make_shared<PlainNeoHookean>(1e6, 1e6);
};

TEST(TermCalls, AnExplicitStepAsksEveryPointOnce) {
  for (const Formulation formulation : {Formulation::standard, Formulation::meanDilatation, Formulation::reduced})
    for (const int energyEvery : {1, 2, 0}) {
      const SolidMesh mesh = boxOf(ElementShape::hex8, {4, 2, 1}, {}, {0.4, 0.2, 0.1});
      const auto material = std::make_shared<const CountingMaterial>();
      Model model = sceneOf(mesh, material, {.formulation = formulation}).model;
      model.add(gravity(Vec3{0, 0, -9.81}));
      model.add(massDamping(3.0));
      addMass(model);
      setRandom(model.nodes.v, 1.0, 3);
      material->points = 0;
      ExplicitIntegrator integrator(model, 1e-4, {.checkStep = false, .energyEvery = energyEvery});
      const int points = formulation == Formulation::reduced ? 8 : 64;
      EXPECT_EQ(material->points, points) << name(formulation) << energyEvery;
      material->points = 0;
      integrator.run(7);
      EXPECT_EQ(material->points, 7 * points) << name(formulation) << energyEvery;
      if (energyEvery > 0) {  // dissipation of 1 J/m³ in every step
        EXPECT_NEAR(integrator.ledger().channels().back().joules, 7 * 0.008, 1e-12);
      }
    }
}

TEST(TermCalls, ForcesAndEnergyTogetherAreThoseAlone) {
  const auto expectSame = [](Term& term, const Nodes& nodes) {
    const Instant now{0.3, 0.01};
    std::vector<Vec3> alone(nodes.u.size(), Vec3{1.0, 2.0, 3.0}), together = alone;
    term.addForces(nodes, now, alone);
    const double energy = term.hasEnergy() ? term.energy(nodes, now) : 0.0;
    EXPECT_EQ(term.addForcesAndEnergy(nodes, now, together), energy) << term.name();
    EXPECT_EQ(together, alone) << term.name();
  };
  std::vector<SolidScene> scenes;
  for (const SolidKind& kind : allSolidKinds()) scenes.push_back(solidScene(kind, true));
  const SolidMesh mesh = testSolidMesh(ElementShape::hex8, true);
  for (const Formulation formulation : brickFormulations)
    scenes.push_back(sceneOf(mesh, formulation, StVenantKirchhoff{1e6, 0.3, 1000.0}));
  scenes.push_back(sceneOf(mesh, pointMaterial(J2Plasticity{1e6, 0.3, 1000.0, linearYield(1e4)})));
  for (SolidScene& scene : scenes) {
    addMass(scene.model);
    setRandom(scene.model.nodes.u, 0.03, 5);
    SCOPED_TRACE(std::string(name(scene.solid->shape())) + name(scene.solid->formulation()));
    expectSame(*scene.solid, scene.model.nodes);
  }
  Nodes& nodes = scenes.back().model.nodes;
  setRandom(nodes.v, 1.0, 6);
  for (const auto& term : {gravity(Vec3{1, 2, 3}), massDamping(2.0), groundSprings(std::array{1, 2}, {3, 4, 5}),
                           nodalForce(std::array{0, 3}, {1, 2, 3}), followingPressure(mesh, faceSet(mesh, "skin"), 5.0),
                           deadPressure(mesh, faceSet(mesh, "x+"), [](double t) { return t; })})
    expectSame(*term, nodes);
}

struct Torn : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Tears where F₁₁ > 1.5.
class Tearing : public PlainNeoHookean {
public:
  Tearing() : PlainNeoHookean(1e6, 1e6) {}
  void evaluate(const PointBatch& batch) const override {
    for (std::size_t p = 0; p < pointLanes * batch.groups; ++p)
      if (const double stretch = batch.F[9 * pointLanes * (p / pointLanes) + p % pointLanes]; stretch > 1.5)
        throw Torn(stretch > 1.8 ? "far" : "near");
    PlainNeoHookean::evaluate(batch);
  }
};

TEST(TermCalls, WhatAMaterialThrowsComesOut) {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {16, 16, 16}, {}, {16.0, 16.0, 16.0});
  SolidScene scene = sceneOf(mesh, std::make_shared<const Tearing>());
  Nodes& nodes = scene.model.nodes;
  linalg::BlockMatrix K = zeroTangent(scene.model);
  std::vector<Vec3> f(nodes.u.size());
  const std::vector<std::function<void()>> questions = {
      [&] { scene.solid->addForces(nodes, {}, f); }, [&] { scene.solid->addForcesAndEnergy(nodes, {}, f); },
      [&] { scene.solid->energy(nodes, {}); }, [&] { scene.solid->elementEnergies(nodes, {}); },
      [&] { scene.solid->addTangent(nodes, {}, K); }};
  const std::vector<Vec3> rest = nodes.u;
  // One corner of the last element, beyond which nothing is torn, and one of an element before it that is torn less.
  nodes.u.back().x = 2.2;
  const auto middle = static_cast<std::size_t>(mesh.groups[0].node[8 * 1000 + 6]);
  for (const bool both : {false, true}) {
    if (both) nodes.u[middle].x = 1.2;
    for (const int count : {1, 2})
      for (std::size_t k = 0; k < questions.size(); ++k) {
        const auto what = onThreads(count, [&]() -> std::string {
          try {
            questions[k]();
          } catch (const Torn& torn) {
            return torn.what();
          }
          return "nothing";
        });
        if (k == questions.size() - 1 && both)  // assembly goes by colours
          EXPECT_NE(what, "nothing");
        else
          EXPECT_EQ(what, both ? "near" : "far") << count << ' ' << k;
      }
  }
  // Nothing is left behind.
  nodes.u = rest;
  std::fill(f.begin(), f.end(), Vec3{});
  for (const int count : {1, 2}) onThreads(count, [&] { return scene.solid->addForcesAndEnergy(nodes, {}, f); });
  EXPECT_EQ(flat(f).norm(), 0.0);
}

}  // namespace
}  // namespace dovetail::fem
