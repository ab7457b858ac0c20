// The limit of the step with an overlap: explicit and implicit solids, macro steps, and contacts on the same nodes.
#include <gtest/gtest.h>

#include "../dense_algebra.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "tie_scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

struct MacroSteps {
  coupling::Stepping stepping;
  int K;
  ConstraintKind constraint = ConstraintKind::penalty;

  /// Own forces resonate with fast ties in narrow bands of steps.
  bool resonates() const { return stepping == coupling::Stepping::explicitSteps && K > 1; }
};

TieRun thinBar(const MacroSteps& macroSteps) {
  SceneOptions o;
  o.across = 1;
  o.coupling.constraint = macroSteps.constraint;
  TieRun run = tieBar(o, fem::ElementShape::hex8, macroSteps.stepping);
  run.K = macroSteps.K;
  return run;
}

class TieLimits : public testing::TestWithParam<MacroSteps> {};

/// Energy of small noise after some macro steps over that at the start.
double growth(const MacroSteps& macroSteps, double weight) {
  TieRun run = thinBar(macroSteps);
  std::mt19937 random(2);
  for (Vec3& v : run.grains.particles.v) v = randomVector(random, 1e-4);
  run.start(1e-7);
  run.start(weight * run.run->criticalStep().dt);
  const double first = run.run->ledger().stored();
  try {
    run.run->advance(3000);
  } catch (const NumericalError&) {
    return 1e30;
  }
  return run.run->ledger().stored() / first;
}

TEST_P(TieLimits, HoldAndAreNotFarFromWhereMotionGrows) {
  EXPECT_LT(growth(GetParam(), 0.95), 3.0);
  double weight = 1.0 / 0.7;
  if (GetParam().resonates())
    for (weight = 1.3; weight > 1.26 && !(growth(GetParam(), weight) > 1e3);) weight -= 0.0025;
  EXPECT_GT(growth(GetParam(), weight), 1e3);
}

/// Under gravity along the bar.
struct Settled {
  std::vector<char> state;
  double limit = 0.0;
};
void load(TieRun& run) { run.grains.gravity = {0.3, -1.0, 0.1}; }

Settled settled(const MacroSteps& macroSteps) {
  TieRun run = thinBar({macroSteps.stepping, 1, macroSteps.constraint});
  load(run);
  run.start(1e-7);
  run.start(0.5 * run.run->criticalStep().dt);
  EXPECT_TRUE(relax(*run.run, {.tolerance = 1e-12}).atRest);
  run.K = macroSteps.K;
  run.start(1e-7);
  return {run.run->save(), run.run->criticalStep().dt};
}

TEST_P(TieLimits, KeepAtRestWhoIsAndRefuseLongerSteps) {
  const Settled rest = settled(GetParam());
  TieRun run = thinBar(GetParam());
  load(run);
  run.start(1e-7);
  run.run->load(rest.state);
  run.grains.refusesUnstableSteps = true;
  EXPECT_THROW(run.start(1.05 * rest.limit), InputError);
  run.start(0.95 * rest.limit);
  EXPECT_TRUE(relax(*run.run, {.tolerance = 1e-12}).atRest);  // where impulses of macro steps meet the bar
  constexpr double time = 0.5;                                // s
  run.run->advance(std::lround(time / run.run->macroStep()));
  EXPECT_FALSE(run.grains.passed);
  const auto& ledger = run.run->ledger();
  EXPECT_LT(run.run->kineticEnergy(), 1e-8 * (ledger.joules("particles: contacts") + ledger.joules("solid: elastic")));
}

constexpr auto explicitly = coupling::Stepping::explicitSteps, implicitly = coupling::Stepping::implicitSteps;
INSTANTIATE_TEST_SUITE_P(MacroSteps, TieLimits,
                         testing::Values(MacroSteps{explicitly, 1}, MacroSteps{explicitly, 4},
                                         MacroSteps{implicitly, 1}, MacroSteps{implicitly, 4},
                                         MacroSteps{implicitly, 16},
                                         MacroSteps{explicitly, 1, ConstraintKind::multiplier},
                                         MacroSteps{explicitly, 4, ConstraintKind::multiplier},
                                         MacroSteps{implicitly, 1, ConstraintKind::multiplier},
                                         MacroSteps{implicitly, 4, ConstraintKind::multiplier}),
                         [](const auto& c) {
                           return std::string(c.param.constraint == ConstraintKind::penalty ? "" : "multipliers") +
                                  (c.param.stepping == explicitly ? "explicit" : "implicit") +
                                  std::to_string(c.param.K);
                         });

/// 2/ω of the fastest motion, by differences of the forces.
double exactLimit(TieRun& run) {
  constexpr double step = 1e-7;  // m
  dem::Particles& p = run.grains.particles;
  fem::Nodes& nodes = run.solid->nodes;
  std::vector<std::pair<double*, double>> free;  // places and masses
  std::vector<const double*> forces;
  for (std::size_t i = 0; i < p.size(); ++i)
    for (int c = 0; c < 3; ++c) free.emplace_back(&p.x[i][c], p.weightOf(i) * p.mass[i]), forces.push_back(&p.f[i][c]);
  for (std::size_t n = 0; n < nodes.X.size(); ++n)
    for (int c = 0; c < 3; ++c)
      if ((nodes.fixed[n] >> c & 1) == 0)
        free.emplace_back(&nodes.u[n][c], nodes.mass[n]), forces.push_back(&nodes.f[n][c]);
  const auto size = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd rates(size, size);
  for (Eigen::Index j = 0; j < size; ++j)
    for (const double sign : {1.0, -1.0}) {
      double& place = *free[static_cast<std::size_t>(j)].first;
      const double before = place;
      place += sign * step;
      dem::findForces(run.grains);
      place = before;
      for (Eigen::Index i = 0; i < size; ++i) {
        const double now = *forces[static_cast<std::size_t>(i)];
        rates(i, j) = sign > 0.0 ? now : (rates(i, j) - now) / (-2.0 * step);
      }
    }
  for (Eigen::Index j = 0; j < size; ++j)
    for (Eigen::Index i = 0; i < size; ++i)
      rates(i, j) /= std::sqrt(free[static_cast<std::size_t>(i)].second * free[static_cast<std::size_t>(j)].second);
  rates = (0.5 * (rates + rates.transpose())).eval();
  return 2.0 / std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(rates).eigenvalues().maxCoeff());
}

/// A heavy grain against the side of the bar, within the overlap or beyond it.
TEST(TieDemand, SharesTheNodesWithContactsOnThem) {
  SceneOptions o;
  o.across = 1;
  const double inside = particleEnd(o) - 0.5 * edge, beyond = particleEnd(o) + 0.5 * edge;
  const auto limitsWith = [&](double place, double stiffness) {
    TieRun run = thinBar({explicitly, 1});
    dem::addParticle(run.grains.particles, {0.5 * edge + 0.0999, place, 0.0}, {}, 0.1, dem::Mass{1e4});
    const fem::SolidMesh mesh = barMesh(o);
    run.grains.terms.add(
        surface::SurfaceContact(*run.side, surface::SurfaceCoupler(surface::makeSkin(mesh.X, mesh.faceSets.at("x+"))),
                                dem::makeContactLaws(dem::ElasticLaw{{stiffness}})));
    run.start(1e-9);
    return std::array{run.run->criticalStep().dt, exactLimit(run)};
  };
  const auto alone = limitsWith(beyond, 1.0);
  for (const double place : {inside, beyond})
    for (const double stiffness : {1e6, 1e7, 1e8}) {
      const auto [bound, exact] = limitsWith(place, stiffness);
      EXPECT_LE(bound, (1.0 + 1e-6) * exact) << place << ' ' << stiffness;
      EXPECT_GE(bound, 0.7 * exact) << place << ' ' << stiffness;
      if (place == inside) {
        EXPECT_LT(bound, 0.999 * alone[0]) << stiffness;
      }
    }
}

}  // namespace
}  // namespace dovetail::arlequin
