// Constant stress through the overlap, and holding it.
#include <gtest/gtest.h>

#include "dovetail/dem/model/loads.hpp"
#include "tie_scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

constexpr double stress = -1e3;  // Pa: strain −1e-3 at most

/// The stretch of the lattice whose springs carry the stress; the bricks' St Venant-Kirchhoff law differs by 3/2 ε².
void strain(dem::Particles& particles, fem::Nodes& nodes) {
  for (Vec3& x : particles.x) x.y *= 1.0 + stress / modulus;
  for (std::size_t n = 0; n < nodes.X.size(); ++n) nodes.u[n].y = stress / modulus * nodes.X[n].y;
}

/// A bar under the stress, uniformly strained, no motion; particles pressed at y = 0 by the force that the removed part
/// of the bar would give, the solid held at its end.
Bar strainedBar(SceneOptions o) {
  Bar model = makeBar(o);
  strain(model.particles, model.nodes());
  return model;
}

/// Forces without the coupling, the outer load on the first layer included.
void innerForces(Bar& model, int particlesPerEdge) {
  dem::clearForces(model.particles);
  model.run.grains.laws->pairs(model.particles, model.run.grains.pairs, 1.0, dem::Booking::on);
  const double d = edge / particlesPerEdge;
  for (std::size_t i = 0; i < model.particles.size(); ++i)
    if (model.particles.x[i].y < 0.9 * d) model.particles.f[i].y -= stress * d * d;
  model.motion->forces(0.0);
}

double worstForce(const Bar& model) {
  double worst = 0.0;
  for (const Vec3& f : model.particles.f) worst = std::max(worst, norm(f));
  for (std::size_t n = 0; n < model.nodes().f.size(); ++n)
    if (!model.nodes().fixed[n]) worst = std::max(worst, norm(model.nodes().f[n]));
  return worst;
}

class LinearWeights : public ::testing::TestWithParam<int> {};

SceneOptions linearOptions(int n) {
  SceneOptions o;
  o.particlesPerEdge = n;
  o.weights = {WeightProfile::linear, 0.0};
  return o;
}

TEST_P(LinearWeights, MultipliersCarryTheStressToRoundOff) {
  SceneOptions o = linearOptions(GetParam());
  o.coupling.constraint = ConstraintKind::multiplier;
  Bar model = strainedBar(o);
  innerForces(model, o.particlesPerEdge);
  const double before = worstForce(model);
  Bar& c = model;
  std::vector<Vec3> a(model.particles.size()), b(model.nodes().X.size()), gap(c.rows()), none(c.rows()),
      lambda(c.rows());
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = (1.0 / model.particles.mass[i]) * model.particles.f[i];
  for (std::size_t n = 0; n < b.size(); ++n)
    if (!model.nodes().fixed[n]) b[n] = (1.0 / model.nodes().mass[n]) * model.nodes().f[n];
  gapOf(c.gap, c.overlap, a, b, gap);
  c.constraint->evaluate({none, none, none, gap, 1.0}, lambda);
  pullParticles(c.gap, c.overlap, lambda, model.particles.f);
  pullNodes(c.gap, lambda, model.nodes().f);
  // What is left is the difference of the materials, 3/2 ε² E.
  EXPECT_LT(worstForce(model), 3.0 * 1.5e-3 * before);
}

TEST_P(LinearWeights, APenaltyCarriesItByAUniformGap) {
  SceneOptions o = linearOptions(GetParam());
  const double p = 8.0 * modulus / (edge * edge);
  o.coupling.penalty = p;
  Bar model = strainedBar(o);
  innerForces(model, o.particlesPerEdge);
  const double before = worstForce(model);
  Bar& c = model;
  const double length = o.overlapElements * edge;
  std::vector<Vec3> gap(c.rows(), Vec3{0.0, -stress / (p * length), 0.0}), lambda(c.rows());
  c.constraint->evaluate({gap, {}, {}, {}, 1.0}, lambda);
  pullParticles(c.gap, c.overlap, lambda, model.particles.f);
  pullNodes(c.gap, lambda, model.nodes().f);
  EXPECT_LT(worstForce(model), 3.0 * 1.5e-3 * before);
}

INSTANTIATE_TEST_SUITE_P(ParticlesPerEdge, LinearWeights, ::testing::Values(1, 2, 3));

/// λ/volume of a half-cosine against −σ w′ at the coarse nodes, largest error relative to the largest value.
double profileError(int elements) {
  SceneOptions o;
  o.across = 1;
  o.particlesPerEdge = 1;
  o.particleElements = elements + 1;
  o.overlapElements = elements;
  o.solidElements = elements + 2;
  o.weights = {WeightProfile::halfCosine, 0.0};
  o.coupling.constraint = ConstraintKind::multiplier;
  Bar model = strainedBar(o);
  innerForces(model, 1);
  // The particles' imbalance is what λ must carry: force on each layer over its volume is −σ w′ at the layer.
  const double length = elements * edge;
  double error = 0.0, largest = 0.0;
  for (const int i : model.overlap.particle) {
    const auto k = static_cast<std::size_t>(i);
    const double s = (model.particles.x[k].y / (1.0 + stress / modulus) - solidStart(o)) / length;
    if (s < 1.0 / elements || s > 1.0 - 1.0 / elements) continue;
    const double density = -stress * profileSlope(WeightProfile::halfCosine, s) / length;
    const double carried = -model.particles.f[k].y / (edge * edge * edge);
    error = std::max(error, std::abs(carried - density));
    largest = std::max(largest, std::abs(density));
  }
  return error / largest;
}

TEST(HalfCosine, TheLoadConvergesToMinusStressTimesSlopeAtSecondOrder) {
  const double coarse = profileError(6), fine = profileError(12);
  EXPECT_LT(fine, 0.03);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.35);
}

/// Gap after pulling with the stress for some steps, twice.
struct Hold {
  double early, late;
};

Hold hold(ConstraintKind kind, int steps, double epsilon, double dt) {
  SceneOptions o;
  o.across = 1;
  o.particlesPerEdge = 1;
  o.weights = {WeightProfile::linear, 1e-3};
  o.coupling.constraint = kind;
  o.coupling.penalty = epsilon;
  TieRun run = tieBar(o);
  strain(run.grains.particles, run.solid->nodes);
  const auto nothing = [](double) { return Vec3{}; };  // the first layer stays where the strain has put it
  run.grains.terms.add(dem::DriveTerm({0}, nothing, nothing));
  run.start(dt);
  const auto gap = [&] { return norm(run.tie->gap()[run.tie->gap().size() / 2]); };
  Hold result{};
  run.run->advance(steps / 2);
  result.early = gap();
  run.run->advance(steps - steps / 2);
  result.late = gap();
  return result;
}

TEST(StaticHold, MultipliersDoNotDriftIn100000Steps) {
  const double dt = 2e-4;
  const Hold h = hold(ConstraintKind::multiplier, 100000, 0.0, dt);
  EXPECT_LT(h.late, 1e-12);
}

TEST(StaticHold, APenaltyOscillatesAboutItsGapAndDoesNotCreep) {
  const double dt = 2e-4, p = 8.0 * modulus / (edge * edge);
  const Hold h = hold(ConstraintKind::penalty, 100000, p, dt);
  const double expected = std::abs(stress) / (p * 4 * edge);
  EXPECT_LT(h.late, 3.0 * expected);
  EXPECT_LT(h.early, 3.0 * expected);
}

TEST(StaticHold, AnIncrementPenaltyCreepsAtTheStatedRate) {
  const double dt = 2e-4, epsilon = 2e9;
  const int steps = 800;
  const Hold h = hold(ConstraintKind::dashpot, steps, epsilon, dt);
  // Strain is let go as the models slip, so the rate is looked at while little of it has gone.
  const double rate = std::abs(stress) / (epsilon * dt * 4 * edge);
  EXPECT_NEAR((h.late - h.early) / (0.5 * steps * dt), rate, 0.1 * rate);
}

}  // namespace
}  // namespace dovetail::arlequin
