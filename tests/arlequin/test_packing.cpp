// Gravity across the overlap, irregular packings.
#include <gtest/gtest.h>

#include "dovetail/dem/pairs/contact_sample.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "tie_scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

/// (1 − w) σ at the centre of an element of a one-element-wide bar along y, Pa.
double stressOfElement(const fem::SolidMesh& mesh, const fem::Model& solid, std::size_t element) {
  double strain = 0.0, weight = 0.0;
  for (std::size_t a = 0; a < 8; ++a) {
    const auto n = static_cast<std::size_t>(cellOf(mesh, static_cast<int>(element)).node[a]);
    strain += (a == 2 || a == 3 || a == 6 || a == 7 ? 0.25 : -0.25) * solid.nodes.u[n].y / edge;
    weight += 0.125 * dynamic_cast<const fem::Solid&>(*solid.terms.front()).fraction()[n];
  }
  return weight * modulus * (strain + 1.5 * strain * strain);
}

TEST(Gravity, StressIsContinuousAcrossTheOverlapOfAColumn) {
  SceneOptions o;
  o.across = 1;
  o.particlesPerEdge = 2;
  o.particleElements = 14;
  o.overlapElements = 10;
  o.solidElements = 14;
  TieRun run = tieBar(o);  // hangs from the solid's held end
  run.grains.gravity = {0.0, -2.0, 0.0};
  run.solid->add(fem::gravity({0.0, -2.0, 0.0}));
  run.start(2e-4);
  for (int s = 0; s < 2000; ++s) {
    run.run->advance(10);
    for (Vec3& v : run.grains.particles.v) v *= 0.99;  // let it come to rest
    for (Vec3& v : run.solid->nodes.v) v *= 0.99;
  }
  // The stress that the models carry together, w σ_DE + (1 − w) σ_FE, at the elements' centres, against the weight
  // below.
  const dem::ContactSample contacts = run.grains.laws->sample(run.grains.particles, run.grains.pairs);
  const fem::SolidMesh mesh = barMesh(o);
  double worst = 0.0;
  for (int e = 0; e + 1 < o.particleElements - o.overlapElements + o.solidElements; ++e) {
    const double y = (e + 0.5) * edge;
    double stress = 0.0;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const Vec3 &a = contacts.from[c], &b = contacts.to[c];
      if ((a.y - y) * (b.y - y) < 0.0) stress += (a.y < y ? 1.0 : -1.0) * contacts.force[c].y / (edge * edge);
    }
    if (y > solidStart(o))
      stress += stressOfElement(mesh, *run.solid, static_cast<std::size_t>((y - solidStart(o)) / edge));
    worst = std::max(worst, std::abs(stress / (bulk * 2.0 * y) - 1.0));
  }
  EXPECT_LT(worst, 0.01);
}

TEST(Packing, RandomPlacesOfTheSameDensityAreCoupledWithoutLoss) {
  for (const ConstraintKind kind : {ConstraintKind::penalty, ConstraintKind::multiplier}) {
    SceneOptions o;
    o.coupling.constraint = kind;
    std::mt19937 random(17);
    TieRun run = tieBar(o, fem::ElementShape::hex8, coupling::Stepping::explicitSteps,
                        [&](Vec3& x) { x += randomVector(random, 0.001); });  // no particle is located anew
    run.start(5e-5);
    const double before = run.energy();
    const Vec3 p0 = run.momentum();
    double scale = 0.0;
    for (int s = 0; s < 400; ++s) {
      run.step(5e-5);
      double speed = 0.0;
      for (std::size_t i = 0; i < run.grains.particles.size(); ++i)
        speed += run.grains.particles.weightOf(i) * run.grains.particles.mass[i] * norm(run.grains.particles.v[i]);
      scale = std::max(scale, speed);
    }
    EXPECT_NEAR(run.energy(), before, 1e-3 * before);
    EXPECT_LT(std::abs(run.tie->lost()), 1e-9 * before);
    EXPECT_LT(norm(run.momentum() - p0), 1e-11 * scale);
  }
}

}  // namespace
}  // namespace dovetail::arlequin
