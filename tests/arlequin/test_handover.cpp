// Particles that enter, leave and cross, gravity across the overlap, irregular packings.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"
#include "scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

/// Loose particles, which do not touch, drift through the end of a solid that stays where it is.
Model looseParticles(ConstraintKind kind, double penalty) {
  SceneOptions o;
  o.across = 1;
  o.weights = {WeightProfile::halfCosine, 0.01};
  Model model;
  model.discrete.particles = lattice({-0.25, 0, -0.25}, {0.25, 2.5, 0.25}, 2);
  for (double& radius : model.discrete.particles.radius) radius *= 0.8;
  model.discrete.pairs.setSkin(0.02);
  dem::findPairs(model.discrete.particles, model.discrete.pairs);
  dem::ElasticLaw law;
  law.normal.stiffness = modulus * 0.25;
  model.discrete.laws = dem::makeContactLaws(law);
  model.discrete.sortEvery = 0;
  const fem::SolidMesh mesh = fem::boxOf(fem::CellShape::hex8, {1, 6, 1}, {-0.25, 0.5, -0.25}, {0.25, 3.5, 0.25});
  const std::vector<double> weight = barWeights(mesh, o);
  model.solid.emplace(makeSolid(mesh, weight, o));
  CouplingOptions coupling;
  coupling.constraint = kind;
  coupling.penalty = penalty;
  model.coupling.emplace(makeCoupling(model.discrete.particles, model.discrete.pairs, *model.solid, weight, coupling));
  return model;
}

TEST(Handover, ParticlesThatEnterLoseNoMomentumUnbooked) {
  for (const ConstraintKind kind : {ConstraintKind::penalty, ConstraintKind::multiplier}) {
    Model model = looseParticles(kind, 2e4);
    for (Vec3& v : model.discrete.particles.v) v.y = 0.05;
    Profile profile;
    StepSums sums;
    const double dt = 2e-4;
    start(model, dt, profile);
    const Vec3 p0 = momentum(model);
    const std::size_t before = model.coupling->overlap.size();
    std::size_t most = before;
    for (int s = 0; s < 6000; ++s) {
      stepExplicit(model, dt, 1, sums, false, profile);
      if (s % 10 == 0) relocate(model, sums);
      most = std::max(most, model.coupling->overlap.size());
    }
    const double size = norm(p0);
    EXPECT_LT(norm(momentum(model) - p0 - sums.supportImpulse + sums.handedMomentum), 1e-10 * size);
    requireFinite(model, "the end");
  }
}

TEST(Handover, ForcesDoNotJumpWhenParticlesAreLocatedAnew) {
  Model model = looseParticles(ConstraintKind::penalty, 1e5);
  for (std::size_t i = 0; i < model.discrete.particles.size(); ++i) model.discrete.particles.v[i].y = 0.05;
  Profile profile;
  StepSums sums;
  const double dt = 1e-4;
  start(model, dt, profile);
  double largest = 0.0, jump = 0.0;
  for (int s = 0; s < 4000; ++s) {
    stepExplicit(model, dt, 1, sums, false, profile);
    const std::vector<Vec3> before = model.coupling->lambda;
    const std::vector<int> nodes = model.coupling->gap.node;
    relocate(model, sums);
    std::vector<Vec3> after(model.coupling->rows());
    model.coupling->constraint->evaluate({model.coupling->gapNow, model.coupling->increment, {}, {}, dt}, after);
    if (model.coupling->gap.node != nodes) continue;
    for (std::size_t r = 0; r < after.size(); ++r) {
      largest = std::max(largest, norm(before[r]));
      jump = std::max(jump, norm(after[r] - before[r]));
    }
  }
  EXPECT_GT(largest, 0.0);
  EXPECT_LT(jump, 1e-12 * largest);
}

TEST(Handover, BothModelsMovingTogetherChangeNothing) {
  SceneOptions o;
  o.holdEnd = false;
  Model model = makeBar(o);
  const Vec3 v{0.1, 0.5, -0.2};
  for (Vec3& each : model.discrete.particles.v) each = v;
  for (Vec3& each : model.solid->nodes().v) each = v;
  Profile profile;
  StepSums sums;
  start(model, 1e-4, profile);
  for (int s = 0; s < 100; ++s) {
    stepExplicit(model, 1e-4, 1, sums, false, profile);
    relocate(model, sums);
  }
  EXPECT_NEAR(sums.handedOver, 0.0, 1e-6 * energies(model).kineticParticles);
  EXPECT_LT(norm(sums.handedMomentum), 1e-9 * norm(momentum(model)));
  for (const Vec3& each : model.discrete.particles.v) EXPECT_LT(norm(each - v), 1e-8);
}

/// (1 − w) σ at the centre of an element of a one-element-wide bar along y, Pa.
double stressOfElement(const Solid& solid, std::size_t element) {
  double strain = 0.0, share = 0.0;
  for (std::size_t a = 0; a < 8; ++a) {
    const auto n = static_cast<std::size_t>(cellOf(solid.mesh, static_cast<int>(element)).node[a]);
    strain += (a == 2 || a == 3 || a == 6 || a == 7 ? 0.25 : -0.25) * solid.nodes().u[n].y / edge;
    share += 0.125 * fem::requireBrickSolid(solid.model(), "test").share()[n];
  }
  return share * modulus * (strain + 1.5 * strain * strain);
}

TEST(Handover, RowsPerElementAreNotRenewed) {
  SceneOptions o;
  o.coupling.projection.perElement = true;
  Model model = makeBar(o);
  StepSums sums;
  EXPECT_THROW(relocate(model, sums), InputError);
}

TEST(Gravity, StressIsContinuousAcrossTheOverlapOfAColumn) {
  SceneOptions o;
  o.across = 1;
  o.particlesPerEdge = 2;
  o.particleElements = 14;
  o.overlapElements = 10;
  o.solidElements = 14;
  Model model = makeBar(o);  // hangs from the solid's held end
  model.discrete.gravity = {0.0, -2.0, 0.0};
  const double dt = 2e-4;
  Profile profile;
  StepSums sums;
  start(model, dt, profile);
  for (int s = 0; s < 20000; ++s) {
    stepExplicit(model, dt, 1, sums, false, profile);
    if (s % 10) continue;  // let it come to rest
    for (Vec3& v : model.discrete.particles.v) v *= 0.99;
    for (Vec3& v : model.solid->nodes().v) v *= 0.99;
  }
  // The stress that the models carry together, w σ_DE + (1 − w) σ_FE, at the elements' centres, against the weight
  // below.
  const dem::ContactSample contacts = model.discrete.laws->sample(model.discrete.particles, model.discrete.pairs);
  double worst = 0.0;
  for (int e = 0; e + 1 < o.particleElements - o.overlapElements + o.solidElements; ++e) {
    const double y = (e + 0.5) * edge;
    double stress = 0.0;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const Vec3 &a = contacts.from[c], &b = contacts.to[c];
      if ((a.y - y) * (b.y - y) < 0.0) stress += (a.y < y ? 1.0 : -1.0) * contacts.force[c].y / (edge * edge);
    }
    if (y > solidStart(o))
      stress += stressOfElement(*model.solid, static_cast<std::size_t>((y - solidStart(o)) / edge));
    worst = std::max(worst, std::abs(stress / (bulk * 2.0 * y) - 1.0));
  }
  EXPECT_LT(worst, 0.01);
}

TEST(Packing, RandomPlacesOfTheSameDensityAreCoupledWithoutLoss) {
  for (const ConstraintKind kind : {ConstraintKind::penalty, ConstraintKind::multiplier}) {
    SceneOptions o;
    o.coupling.constraint = kind;
    Model model = makeBar(o);
    std::mt19937 random(17);
    // Disorder the bonds' ends, take the distances as they are then for rest lengths, and couple anew.
    dem::Particles particles = model.discrete.particles;
    particles.mass = model.coupling->fullMass;
    for (Vec3& x : particles.x) x += randomVector(random, 0.02);
    Model rough;
    rough.discrete = model.discrete;
    rough.discrete.particles = particles;
    rough.discrete.pairs.clearFactors();
    rough.solid.emplace(makeSolid(barMesh(o), model.coupling->overlap.nodalWeight, o));
    rough.coupling.emplace(makeCoupling(rough.discrete.particles, rough.discrete.pairs, *rough.solid,
                                        model.coupling->overlap.nodalWeight, o.coupling));
    Profile profile;
    StepSums sums;
    start(rough, 5e-5, profile);
    const double before = energies(rough).total();
    const Vec3 p0 = momentum(rough);
    double scale = 0.0;
    for (int s = 0; s < 400; ++s) {
      stepExplicit(rough, 5e-5, 1, sums, true, profile);
      double speed = 0.0;
      for (std::size_t i = 0; i < rough.discrete.particles.size(); ++i)
        speed += rough.discrete.particles.mass[i] * norm(rough.discrete.particles.v[i]);
      scale = std::max(scale, speed);
    }
    EXPECT_NEAR(energies(rough).total(), before, 1e-3 * before);
    EXPECT_LT(std::abs(sums.couplingWork + rough.coupling->storedEnergy()), 1e-9 * before);
    EXPECT_LT(norm(momentum(rough) - p0 - sums.supportImpulse), 1e-11 * scale);
  }
}

}  // namespace
}  // namespace dovetail::arlequin
