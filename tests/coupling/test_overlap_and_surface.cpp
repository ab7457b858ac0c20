// An overlap, and contacts on the surface, of one solid.
#include <gtest/gtest.h>

#include <algorithm>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/error.hpp"
#include "full_scene.hpp"

namespace dovetail::coupling {
namespace {

/// A bar along y of 1 × 1 m, grains up to y = 2.5, a solid from y = 0.5 to 3.5, in common 2 m.
struct Bar {
  std::unique_ptr<CoupledRun> run = std::make_unique<CoupledRun>();
  fem::SolidMesh mesh;
  SolidSide* side = nullptr;
  arlequin::ArlequinCoupling* tie = nullptr;
};

constexpr double stiffness = 2.5e5;

std::shared_ptr<const dem::ContactLaws> laws(bool bonded) {
  dem::ElasticLaw law;
  law.normal.stiffness = stiffness;
  law.normal.bonded = bonded;
  return dem::makeContactLaws(law);
}

Bar makeBar(Stepping stepping, bool bonded, double shift = 0.0) {
  Bar bar;
  dem::Model& grains = bar.run->grains;
  constexpr double d = 0.25;
  for (int j = 0; j < 10; ++j)
    for (int k = 0; k < 4; ++k)
      for (int i = 0; i < 4; ++i)
        dem::addParticle(grains.particles, {-0.5 + d * (i + 0.5), d * (j + 0.5), -0.5 + d * (k + 0.5)}, {}, 0.5 * d,
                         dem::Mass{15.0});
  grains.laws = laws(bonded);
  grains.pairs.setSkin(0.025);
  grains.sortEvery = 0;
  dem::findPairs(grains.particles, grains.pairs);
  for (Vec3& x : grains.particles.x) x.x += shift;
  bar.mesh = fem::boxOf(fem::ElementShape::hex8, {2, 6, 2}, {-0.5, 0.5, -0.5}, {0.5, 3.5, 0.5});
  std::vector<double> place;
  for (const Vec3& X : bar.mesh.X)
    place.push_back(X.y > 2.5 + 1e-9 ? arlequin::beyondOverlap : std::clamp(0.5 * (X.y - 0.5), 0.0, 1.0));
  const std::vector<double> weight = arlequin::nodalWeights(place, {});
  auto model = std::make_unique<fem::Model>(fem::makeModel(bar.mesh));
  fem::fix(model->nodes, fem::nodeSet(bar.mesh, "y+"));
  model->add(fem::makeSolid(bar.mesh, fem::pointMaterial(fem::Material(fem::StVenantKirchhoff{1e6, 0.0, 1000.0})),
                            {.fraction = arlequin::solidWeights(weight)}));
  bar.side = &bar.run->addSolid(std::move(model), {.name = "bar", .stepping = stepping});
  bar.tie = &grains.terms.add(arlequin::makeArlequinCoupling(grains, bar.mesh, weight, *bar.side));
  return bar;
}

/// The skin, in two parts.
void coupleSkin(Bar& bar) {
  std::vector<fem::Face> sides, ends;
  for (const char* side : {"x-", "x+", "z-", "z+"})
    for (const fem::Face& face : bar.mesh.faceSets.at(side)) sides.push_back(face);
  for (const char* end : {"y-", "y+"})
    for (const fem::Face& face : bar.mesh.faceSets.at(end)) ends.push_back(face);
  for (const auto& faces : {sides, ends})
    bar.run->grains.terms.add(surface::SurfaceContact(
        *bar.side, surface::SurfaceCoupler(surface::makeSkin(bar.mesh.X, faces)), laws(false), "skin"));
}

class OverlapAndSurface : public testing::TestWithParam<Case> {};

/// Grains that are tied to the solid are within it by right.
TEST_P(OverlapAndSurface, TiedGrainsDoNotMeetTheSkin) {
  Bar alone = makeBar(GetParam().stepping, true, 0.005), both = makeBar(GetParam().stepping, true, 0.005);
  coupleSkin(both);
  for (Bar* bar : {&alone, &both}) {
    bar->run->grains.particles.v[3] = {0.01, 0.0, 0.02};
    bar->run->start(5e-5, {.stepsPerMacroStep = GetParam().K});
  }
  EXPECT_EQ(dem::energies(both.run->grains).contacts, dem::energies(alone.run->grains).contacts);
  alone.run->advance(400 / GetParam().K);
  both.run->advance(400 / GetParam().K);
  const auto& x = alone.run->grains.particles.x;
  double moved = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    moved = std::max(moved, norm(both.run->grains.particles.x[i] - x[i]));
  }
  // Beyond the solid's end the skin acts with a thousandth of its stiffness.
  EXPECT_LT(moved, 1e-7);
  EXPECT_NEAR(both.run->ledger().residual(), alone.run->ledger().residual(), 1e-7);
}

/// Weight pulls at the bar, which is held at both ends, and so are two balls that press on its side, above grains that
/// are tied and beyond them.
Bar pressed(const Case& macroSteps, bool wholeSkin) {
  Bar bar = makeBar(macroSteps.stepping, true);
  fem::fix(bar.side->nodes(), bar.mesh.nodeSets.at("z-"), fem::componentZ);
  if (wholeSkin)
    coupleSkin(bar);
  else
    for (const char* side : {"x+", "z+"})
      bar.run->grains.terms.add(surface::SurfaceContact(
          *bar.side, surface::SurfaceCoupler(surface::makeSkin(bar.mesh.X, bar.mesh.faceSets.at(side))), laws(false),
          side));
  constexpr double radius = 0.125, overlap = 5e-5;
  std::vector<std::int64_t> held;
  for (const std::int64_t id : bar.run->grains.particles.id)
    if (bar.run->grains.particles.x[static_cast<std::size_t>(id)].y < 0.5) held.push_back(id);
  for (const double y : {1.25, 2.75}) {
    held.push_back(bar.run->grains.particles.nextId);
    dem::addParticle(bar.run->grains.particles, {0.0, y, 0.5 + radius - overlap}, {}, radius, dem::Mass{15.0});
  }
  const auto still = [](double) { return Vec3{}; };
  bar.run->grains.terms.add(dem::DriveTerm(held, still, still));
  bar.run->grains.gravity = {0.0, 1.0, 0.0};
  return bar;
}

class SettledOverlapAndSurface : public testing::TestWithParam<std::tuple<Case, bool>> {};

TEST_P(SettledOverlapAndSurface, StaysAndKeepsItsBooksNearTheLimit) {
  const auto& [macroSteps, wholeSkin] = GetParam();
  const Bar bar = pressed(macroSteps, wholeSkin);
  CoupledRun& run = *bar.run;
  run.start(1e-7);
  run.start(0.5 * run.criticalStep().dt);
  ASSERT_TRUE(relax(run, {.tolerance = 1e-11}).atRest);
  const RunOptions options{.stepsPerMacroStep = macroSteps.K};
  run.start(1e-7, options);
  const double limit = run.criticalStep().dt;
  EXPECT_THROW(run.start(1.05 * limit, options), InputError);
  run.start(0.95 * limit, options);
  const auto elastic = [&] { return run.ledger().joules("particles: contacts") + run.ledger().joules("bar: elastic"); };
  const double residual = run.ledger().residual();
  run.advance(std::lround(0.3 / run.macroStep()));
  EXPECT_FALSE(run.grains.passed);
  // Own forces that act once in several steps keep the bar oscillating by the fourth power of the step.
  const double weight = macroSteps.stepping == Stepping::explicitSteps && macroSteps.K > 1 ? 1e-4 : 1e-8;
  EXPECT_LT(run.kineticEnergy(), weight * elastic());
  EXPECT_LT(std::abs(run.ledger().residual() - residual), weight * elastic());
  std::size_t pressed = 0;
  for (const auto* contact : run.grains.terms.all<surface::SurfaceContact>())
    pressed += contact->coupling().load().touched.size();
  EXPECT_EQ(pressed, 4U);
}

constexpr Case explicit1{"explicit1", Stepping::explicitSteps, 1}, explicit4{"explicit4", Stepping::explicitSteps, 4},
    implicit1{"implicit1", Stepping::implicitSteps, 1}, implicit4{"implicit4", Stepping::implicitSteps, 4},
    implicit16{"implicit16", Stepping::implicitSteps, 16};
INSTANTIATE_TEST_SUITE_P(MacroSteps, OverlapAndSurface,
                         testing::Values(explicit1, explicit4, implicit1, implicit4, implicit16),
                         [](const auto& c) { return std::string(c.param.name); });
INSTANTIATE_TEST_SUITE_P(MacroSteps, SettledOverlapAndSurface,
                         testing::Combine(testing::Values(explicit1, explicit4, implicit1, implicit4, implicit16),
                                          testing::Bool()),
                         [](const auto& c) {
                           return std::string(std::get<0>(c.param).name) + (std::get<1>(c.param) ? "skin" : "sides");
                         });

/// One that was there when the tie was made is tied, with its weight; one that comes later meets the skin first.
TEST(OverlapAndSurface, ABallAtTheSideIsPushedOnce) {
  for (const double y : {0.875, 1.375, 1.875, 2.125}) {
    Bar bar = makeBar(Stepping::explicitSteps, false);
    coupleSkin(bar);
    constexpr double overlap = 0.002;
    const int ball =
        dem::addParticle(bar.run->grains.particles, {0.625 - overlap, y, 0.125}, {}, 0.125, dem::Mass{15.0});
    bar.run->grains.refusesUnstableSteps = false;
    bar.run->start(1e-7);
    const auto b = static_cast<std::size_t>(ball);
    EXPECT_LE(bar.run->grains.particles.f[b].x, 1.001 * stiffness * overlap) << y;
    EXPECT_GE(bar.run->grains.particles.f[b].x, 0.9 * bar.run->grains.particles.weightOf(b) * stiffness * overlap) << y;
  }
}

TEST(OverlapAndSurface, ABallThatIsTiedAsItHitsTheSideIsBooked) {
  double residuals[2];
  for (int k = 0; k < 2; ++k) {
    Bar bar = makeBar(Stepping::explicitSteps, false);
    coupleSkin(bar);
    dem::addParticle(bar.run->grains.particles, {0.64, 1.4, 0.1}, {-2.0, 0.7, 0.0}, 0.125, dem::Mass{15.0});
    const double step = k == 0 ? 1e-4 : 5e-5;
    bar.run->start(step);
    bar.run->advance(static_cast<std::int64_t>(std::lround(0.05 / step)));
    residuals[k] = std::abs(bar.run->ledger().residual());
  }
  EXPECT_LT(residuals[0], 1e-3 * 30.0);
  EXPECT_LT(residuals[1], 0.4 * residuals[0]);
}

}  // namespace
}  // namespace dovetail::coupling
