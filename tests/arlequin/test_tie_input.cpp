// What a tie asks of the step and of its input.
#include <gtest/gtest.h>

#include "dovetail/arlequin/critical_step.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "tie_scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

TEST(TieDemand, IsOnTheSafeSideOfTheExactStepAndNotFarFromIt) {
  for (const double width : {0.0, 0.9})
    for (const double weight : {0.0, 0.375})
      for (const double floor : {1e-3, 0.05}) {
        SceneOptions o;
        o.coupling.projection.width = width;
        o.massFraction = weight;
        o.weights.floor = floor;
        o.coupling.leastWeight = floor;
        TieRun run = tieBar(o);
        run.start();
        const double exact = criticalStep(run.grains, run.side, weight, run.tie).together;
        const double safe = run.run->criticalStep().dt;
        EXPECT_LT(safe, exact) << width << ' ' << weight << ' ' << floor;
        RecordProperty("fraction_of_exact", std::to_string(safe / exact));
        EXPECT_GT(safe, (weight == 0.0 ? 0.4 : 0.1) * exact) << width << ' ' << weight << ' ' << floor;
      }
}

/// Growth of the energy of a packing with friction in 2000 steps.
double growth(double factor) {
  SceneOptions o;
  o.across = 1;
  TieRun run = tieBar(o);
  dem::FrictionalLaw law;
  law.normal.stiffness = modulus * 0.25;
  law.normal.restitution = 1.0;
  law.tangential = {0.5, 2.0 / 7.0};
  run.grains.laws = dem::makeContactLaws(law);
  for (double& radius : run.grains.particles.radius) radius *= 1.001;
  run.start();
  std::mt19937 random(1);
  for (Vec3& v : run.grains.particles.v) v = randomVector(random, 1e-4);
  run.start();
  const double dt = factor * run.run->criticalStep().dt,
               first = dem::kineticEnergy(run.grains.particles) + run.grains.work.storedEnergy();
  run.grains.refusesUnstableSteps = false;
  try {
    for (int s = 0; s < 2000; ++s) run.step(dt);
  } catch (const NumericalError&) {  // farther than its radius in one step
    return 1e30;
  }
  return (dem::kineticEnergy(run.grains.particles) + run.solidKinetic()) / first;
}

TEST(TieDemand, HoldsWithFriction) {
  EXPECT_LT(growth(0.99), 20.0);
  EXPECT_GT(growth(4.0), 1e3);
}

/// One particle sits in an element of its own, just within the border of the particles.
TEST(TieDemand, OneParticleAloneInItsElementDoesNotShortenTheStep) {
  const auto stepWith = [](bool alone) {
    SceneOptions o;
    o.across = 1;
    TieRun run;
    run.grains.particles = lattice({-0.25, 0, -0.25}, {0.25, 2.0, 0.25}, 2);
    if (alone) dem::addParticle(run.grains.particles, {0.01, 2.03, 0.02}, {}, 0.125, dem::Mass{bulk / 64.0});
    run.grains.pairs.setSkin(0.02);
    dem::ElasticLaw law;
    law.normal.stiffness = 1e-3 * modulus;
    run.grains.laws = dem::makeContactLaws(law);
    const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {1, 6, 1}, {-0.25, 0.5, -0.25}, {0.25, 3.5, 0.25});
    const std::vector<double> weight = barWeights(mesh, o);
    run.take(fem::makeModel(mesh));
    const fem::StVenantKirchhoff law3{modulus, 0.0, bulk};
    run.solid->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(law3)), {.fraction = solidWeights(weight)}));
    run.couple(mesh, weight, {});
    run.start();
    double stiffest = 0.0;  // N/m over kg, by a probe of the forces
    for (std::size_t k = 0; k < run.tie->overlap().size(); ++k) {
      const auto i = static_cast<std::size_t>(run.tie->overlap().particle[k]);
      run.grains.particles.x[i].y += 1e-6;
      run.side->load.clear();
      dem::clearForces(run.grains.particles);
      dem::Step step;
      step.dt = 1e-100;
      step.timeless = true;
      run.tie->addForces(run.grains, step);
      stiffest = std::max(stiffest, -run.grains.particles.f[i].y / 1e-6 / run.grains.particles.mass[i]);
      run.grains.particles.x[i].y -= 1e-6;
    }
    return stiffest;
  };
  EXPECT_LT(stepWith(true), 1.5 * stepWith(false));
}

TEST(TieWeights, GoOnBeyondLateralFacesWithinARadius) {
  SceneOptions o;
  o.across = 1;
  TieRun run = tieBar(o);
  const fem::SolidMesh mesh = barMesh(o);
  const std::vector<double> weight = barWeights(mesh, o);
  dem::Particles p;
  const double y = 2.1;
  dem::addParticle(p, {0.2, y, 0.0}, {}, 0.1, dem::Mass{1.0});
  dem::addParticle(p, {0.25 + 0.04, y, 0.0}, {}, 0.1, dem::Mass{1.0});
  dem::addParticle(p, {0.25 + 0.11, y, 0.0}, {}, 0.1, dem::Mass{1.0});
  dem::addParticle(p, {0.0, y, 0.25 + 0.09}, {}, 0.1, dem::Mass{1.0});
  const Overlap overlap = locateOverlap(p, mesh, nodesAt(mesh.X), weight);
  EXPECT_EQ(overlap.particle, (std::vector<int>{0, 1, 3}));
  for (const double w : overlap.weight) EXPECT_NEAR(w, overlap.weight[0], 1e-12);
  EXPECT_EQ(overlap.stray.size(), 0u);
}

TEST(TieStart, VelocitiesAreMadeToComplyWithMultipliersAndTheLossIsBooked) {
  SceneOptions o;
  o.across = 1;
  o.holdEnd = false;
  o.coupling.constraint = ConstraintKind::multiplier;
  TieRun run = tieBar(o);
  std::mt19937 random(4);
  for (Vec3& v : run.grains.particles.v) v = randomVector(random, 0.1);
  for (Vec3& v : run.solid->nodes.v) v = randomVector(random, 0.1);
  const double before =
      dem::kineticEnergy(run.grains.particles) + fem::Motion(*run.solid, o.massFraction).kineticEnergy();
  const Vec3 momentum = dem::momentum(run.grains.particles) + fem::momentum(run.solid->nodes);
  run.start();
  const double after = dem::kineticEnergy(run.grains.particles) + run.solidKinetic();
  EXPECT_NEAR(run.tie->lost(), before - after, 1e-9 * before);
  EXPECT_GT(run.tie->lost(), 0.01 * before);
  EXPECT_LT(norm(dem::momentum(run.grains.particles) + fem::momentum(run.solid->nodes) - momentum), 1e-12 * before);
  std::vector<Vec3> rate(run.tie->operators().rows());
  gapOf(run.tie->operators(), run.tie->overlap(), run.grains.particles.v, run.solid->nodes.v, rate);
  for (const Vec3& g : rate) EXPECT_LT(norm(g), 1e-8);
  for (int s = 0; s < 100; ++s) run.step(1e-4);
  for (const Vec3& g : run.tie->gap()) EXPECT_LT(norm(g), 1e-10);
}

/// Two materials and graded elements: each row has the penalty of what is about it.
TEST(TiePenalty, GoesByTheElement) {
  const fem::SolidMesh mesh = [] {
    fem::SolidMesh box = fem::boxOf(fem::ElementShape::hex8, {1, 6, 1}, {-0.25, 0.5, -0.25}, {0.25, 3.5, 0.25});
    std::vector<int> low, high;
    for (int e = 0; e < 6; ++e) (e < 2 ? low : high).push_back(e);
    box.elementSets = {{"low", low}, {"high", high}};
    return box;
  }();
  SceneOptions o;
  o.across = 1;
  const std::vector<double> weight = barWeights(mesh, o);
  const auto stiffnessAt = [&](double lower, double upper, double y) {
    TieRun run;
    run.grains.particles = lattice({-0.25, 0, -0.25}, {0.25, 2.5, 0.25}, 2);
    run.grains.laws = dem::makeContactLaws(dem::ElasticLaw{{.stiffness = 1.0}});
    run.take(fem::makeModel(mesh));
    for (const auto& [set, young] : {std::pair("low", lower), std::pair("high", upper)})
      run.solid->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(fem::StVenantKirchhoff{young, 0.0, bulk})),
                                    {.elementSet = set, .name = set, .fraction = solidWeights(weight)}));
    run.couple(mesh, weight, {});
    run.start();
    for (Vec3& x : run.grains.particles.x) x.y += 1e-6;
    run.start();
    double sum = 0.0;
    for (std::size_t r = 0; r < run.tie->lambda().size(); ++r)
      if (std::abs(mesh.X[static_cast<std::size_t>(run.tie->operators().node[r])].y - y) < 1e-9)
        sum += run.tie->lambda()[r].y / 1e-6;
    return sum;
  };
  EXPECT_NEAR(stiffnessAt(1e6, 3e6, 1.0), stiffnessAt(1e6, 1e6, 1.0), 1e-6 * stiffnessAt(1e6, 1e6, 1.0));
  EXPECT_NEAR(stiffnessAt(1e6, 3e6, 2.0), 3.0 * stiffnessAt(1e6, 1e6, 2.0), 1e-6 * stiffnessAt(1e6, 1e6, 2.0));
  EXPECT_NEAR(stiffnessAt(1e6, 3e6, 1.5), 2.0 * stiffnessAt(1e6, 1e6, 1.5), 1e-6 * stiffnessAt(1e6, 1e6, 1.5));
}

/// A layer with periodic sides: the same contacts and ties wherever the box cuts it.
TEST(TiePeriodic, SidesMakeNoDifference) {
  const auto weights = [](double shift) {
    SceneOptions o;
    TieRun run;
    run.grains.particles = lattice({-0.5, 0, -0.5}, {0.5, 2.5, 0.5}, 2);
    for (Vec3& x : run.grains.particles.x) x.x += shift, x.z -= shift;
    run.grains.pairs.setSkin(0.02);
    run.grains.pairs.setPeriodicity({{{-0.5, -10, -0.5}, {0.5, 10, 0.5}}, {true, false, true}});
    dem::ElasticLaw law;
    law.normal.stiffness = modulus * 0.25;
    law.normal.bonded = true;
    run.grains.laws = dem::makeContactLaws(law);
    dem::findPairs(run.grains.particles, run.grains.pairs);
    const fem::SolidMesh mesh = barMesh(o);
    const std::vector<double> weight = barWeights(mesh, o);
    run.take(fem::makeModel(mesh));
    const fem::StVenantKirchhoff law3{modulus, 0.0, bulk};
    run.solid->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(law3)), {.fraction = solidWeights(weight)}));
    run.couple(mesh, weight, {});
    run.start();
    std::vector<double> sorted(run.grains.particles.weight),
        factors(run.grains.pairs.factors().begin(), run.grains.pairs.factors().end());
    std::ranges::sort(sorted);
    std::ranges::sort(factors);
    for (const Vec3& g : run.tie->gap()) EXPECT_LT(norm(g), 1e-12);
    EXPECT_EQ(run.tie->overlap().size(), 128u);
    sorted.insert(sorted.end(), factors.begin(), factors.end());
    return sorted;
  };
  const std::vector<double> plain = weights(0.0), cut = weights(0.3);
  ASSERT_EQ(plain.size(), cut.size());
  for (std::size_t k = 0; k < plain.size(); ++k) EXPECT_NEAR(plain[k], cut[k], 1e-12);
}

TEST(TieInput, WhatCannotBeIsRefused) {
  SceneOptions o;
  o.across = 1;
  const fem::SolidMesh mesh = barMesh(o);
  const std::vector<double> weight = barWeights(mesh, o);
  const auto attempt = [&](const auto& change, CouplingOptions coupling = {}) {
    TieRun run;
    run.grains.particles = lattice({-0.25, 0, -0.25}, {0.25, 2.5, 0.25}, 2);
    run.grains.laws = dem::makeContactLaws(dem::ElasticLaw{{.stiffness = 1.0}});
    run.take(fem::makeModel(mesh));
    std::vector<double> fraction = solidWeights(weight);
    change(run, fraction);
    const fem::StVenantKirchhoff law3{modulus, 0.0, bulk};
    run.solid->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(law3)), {.fraction = fraction}));
    run.couple(mesh, weight, coupling);
    dem::check(run.grains);
  };
  EXPECT_NO_THROW(attempt([](TieRun&, auto&) {}));
  EXPECT_THROW(attempt([](TieRun&, auto& changed) { changed[5] += 0.01; }), InputError) << "weights do not add up";
  EXPECT_THROW(attempt([](TieRun& run, auto&) {
                 dem::addParticle(run.grains.particles, {0.0, 2.9, 0.0}, {}, 0.1, dem::Mass{1.0});
               }),
               InputError)
      << "beyond the border of the particles";
  CouplingOptions negative;
  negative.penalty = -1.0;
  EXPECT_THROW(attempt([](TieRun&, auto&) {}, negative), InputError);
  TieRun run = tieBar(o);
  run.grains.particles.weight[static_cast<std::size_t>(run.tie->overlap().particle[3])] = 0.9;
  EXPECT_THROW(dem::check(run.grains), InputError) << "somebody else wrote the weights";
}

TEST(TieInput, KernelsAreNarrowWhereThereAreManyRows) {
  SceneOptions o;
  o.across = 30;
  o.particlesPerEdge = 1;
  const auto attempt = [&](ConstraintKind kind, double width) {
    o.coupling.constraint = kind;
    o.coupling.projection.width = width * edge;
    tieBar(o);
  };
  EXPECT_NO_THROW(attempt(ConstraintKind::penalty, 2.5));
  EXPECT_NO_THROW(attempt(ConstraintKind::multiplier, 2.5));
  EXPECT_THROW(attempt(ConstraintKind::penalty, 2.6), InputError);
  EXPECT_THROW(attempt(ConstraintKind::multiplier, 2.6), InputError);
  o.across = 2;
  EXPECT_NO_THROW(attempt(ConstraintKind::penalty, 2.6));
}

TEST(TieInput, ParticlesBeyondTheBorderAreListed) {
  SceneOptions o;
  o.across = 1;
  TieRun run = tieBar(o);
  const fem::SolidMesh mesh = barMesh(o);
  const int number = dem::addParticle(run.grains.particles, {0.0, 2.9, 0.0}, {}, 0.1, dem::Mass{1.0});
  EXPECT_EQ(particlesBeyond(run.grains, mesh, run.solid->nodes, barWeights(mesh, o)), std::vector<int>{number});
}

TEST(TieInput, ParticlesBeyondTheBorderAreListedThroughAPeriod) {
  SceneOptions o;
  o.across = 1;
  TieRun run = tieBar(o);
  const fem::SolidMesh mesh = barMesh(o);
  const auto [least, most] = std::ranges::minmax(mesh.X, {}, [](const Vec3& X) { return X.x; });
  run.grains.pairs.setPeriodicity({{{least.x, -10.0, -10.0}, {most.x, 10.0, 10.0}}, {true, false, false}});
  const Vec3 image{most.x - least.x, 2.9, 0.0};  // of the place of the test above
  const int number = dem::addParticle(run.grains.particles, image, {}, 0.1, dem::Mass{1.0});
  EXPECT_EQ(particlesBeyond(run.grains, mesh, run.solid->nodes, barWeights(mesh, o)), std::vector<int>{number});
}

TEST(TieWalls, PushLightParticlesAsTheirShareAsks) {
  SceneOptions o;
  o.across = 1;
  TieRun run = tieBar(o);
  dem::addWall(run.grains, dem::makePlane({0.0, 0.0, -0.25 + 1e-4}, {0, 0, 1}));
  run.start();
  const dem::Particles& p = run.grains.particles;
  const double full = p.f[0].z;  // the first layer lies outside of the overlap
  EXPECT_GT(full, 0.0);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double expected = p.x[i].z < 0.0 ? p.weightOf(i) * full : 0.0;
    EXPECT_NEAR(p.f[i].z, expected, 1e-9 * full);
  }
}

TEST(TieFactors, MutesStayMutedAndSharesAreKeptThroughUpdates) {
  SceneOptions o;
  o.across = 1;
  TieRun run = tieBar(o);
  run.start();
  const std::vector<double> before(run.grains.pairs.factors().begin(), run.grains.pairs.factors().end());
  run.grains.pairs.writeFactors()[7] = 0.0;
  run.tie->neighbourListUpdated(run.grains);
  EXPECT_EQ(run.grains.pairs.factors()[7], 0.0);
  for (std::size_t k = 0; k < before.size(); ++k) {
    EXPECT_EQ(run.grains.pairs.factors()[k], k == 7 ? 0.0 : before[k]);
  }
}

}  // namespace
}  // namespace dovetail::arlequin
