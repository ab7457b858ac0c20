#include "model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/scene/read.hpp"
#include "texts.hpp"

namespace dovetail::wave {

int particlesPerLayer(const Settings& s) {
  const int across = static_cast<int>(std::lround(Case{}.side / s.diameter()));
  return across * across;
}

int layers(const Settings& s, double length) { return static_cast<int>(std::lround(length / s.diameter())); }

namespace {

std::vector<int> orderOf(const std::vector<Vec3>& x, double spacing) {
  std::vector<int> order(x.size());
  std::iota(order.begin(), order.end(), 0);
  const auto place = [&](int i) {
    const Vec3 at =
        1.0 / spacing * x[static_cast<std::size_t>(i)] + Vec3{0.25, 0.25, 0.25};  // between layers of centres
    return std::array{std::floor(at.y), std::floor(at.z), std::floor(at.x)};
  };
  std::sort(order.begin(), order.end(), [&](int i, int j) { return place(i) < place(j); });
  return order;
}

/// Bonds of twice the stiffness with the wall fix the point midway.
void stiffenWall(const Settings& s, dem::Model& grains) {
  const auto first = static_cast<int>(grains.particles.size()) - particlesPerLayer(s);
  const std::span<double> factors = grains.pairs.writeFactors();
  for (std::size_t p = 0; p < grains.pairs.size(); ++p) {
    const auto& pair = grains.pairs.pairs()[p];
    factors[p] = (pair[0] >= first) != (pair[1] >= first) ? 2.0 : 1.0;
  }
}

Bar barOf(const Settings& s, double penalty) {
  Bar bar;
  bar.scene = scene::sceneFromText(sceneText, "scenes/wave.json", ".", changesOfScene(s, penalty));
  bar.built = scene::build(bar.scene);
  dem::Model& grains = bar.run().grains;
  grains.sortEvery = 0;                 // layers are told by number
  grains.refusesUnstableSteps = false;  // planSteps knows the exact limit
  bar.byPlace = orderOf(grains.particles.x, s.diameter());
  if (!s.tensile()) {  // bonded ones are there
    grains.pairs.setSkin(0.1 * s.diameter());
    dem::findPairs(grains.particles, grains.pairs);
  }
  if (s.fullDem) {
    stiffenWall(s, grains);
    return bar;
  }
  bar.solid = &bar.run().solid(0);
  bar.tie = grains.terms.all<arlequin::ArlequinCoupling>().front();
  return bar;
}

double requestedStep(const Settings& s, double critical) {
  if (s.dtAuto) return 0.5 * critical;
  return s.fractionOfCritical ? *s.fractionOfCritical * critical : s.dtFactor * contactTime(s);
}

}  // namespace

arlequin::CriticalStep criticalStep(const Settings& s, const Bar& bar) {
  return arlequin::criticalStep(bar.run().grains, bar.solid, massFraction(s), bar.tie);
}

Bar makeBar(const Settings& s, double& penalty) {
  Bar bar = barOf(s, penalty);
  const bool stores = s.constraint == "penalty";
  if (s.fullDem || s.femEvery == 1 || s.penalty > 0.0 || !stores) return bar;
  const double critical = criticalStep(s, bar).together;
  const double dt = requestedStep(s, critical);
  const double most = (s.implicit() ? 0.9 : 0.45 * std::numbers::pi) * critical;
  if (s.femEvery * dt <= most) return bar;
  return barOf(s, penalty *= std::pow(most / (s.femEvery * dt), 2));
}

namespace {

void refuseExplicit(const Settings& s, double dt, const arlequin::CriticalStep& critical) {
  if (dt <= critical.together) return;
  throw InputError(
      "a step of " + formatNumber(dt) + " s is above the critical one, " + formatNumber(critical.together) +
          " s (particles " + formatNumber(critical.particles) + ", solid " + formatNumber(critical.solid) + ")",
      "--dt-factor", "give at most " + formatNumber(0.9 * critical.together / contactTime(s)) + ", or --dt auto");
}

/// With an implicit solid, contacts limit the particles' step. Nodes that move every K dt only would overshoot what a
/// stiff coupling wants.
void refuseImplicit(const Settings& s, double dt, const arlequin::CriticalStep& critical) {
  if (dt > critical.particles)
    throw InputError("a step of " + formatNumber(dt) + " s is above that of the contacts, " +
                         formatNumber(critical.particles) + " s",
                     "--dt-factor", "give at most " + formatNumber(0.9 * critical.particles / contactTime(s)));
  const bool stores = s.constraint == "penalty";
  if (stores && s.femEvery * dt > critical.together)
    throw InputError("the solid moves every " + formatNumber(s.femEvery * dt) +
                         " s, more than the critical step of the coupling, " + formatNumber(critical.together) + " s",
                     "--penalty", "give a softer one, a smaller --dt-factor or --fem-every, or leave it out");
}

}  // namespace

StepPlan planSteps(const Settings& s, const arlequin::CriticalStep& critical) {
  const double dt = requestedStep(s, critical.together), end = endTime(s);
  const bool implicit = s.implicit() && !s.fullDem;
  if (!s.beyondCritical) implicit ? refuseImplicit(s, dt, critical) : refuseExplicit(s, dt, critical);
  if (end / dt > 1e10)
    throw InputError("the run would take " + formatNumber(end / dt) + " steps", "--until and --dt-factor",
                     "give a shorter time or a longer step");
  StepPlan plan;
  plan.stepsPerMacroStep = s.fullDem ? 1 : s.femEvery;
  plan.macroSteps =
      std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(end / (plan.stepsPerMacroStep * dt) - 1e-9)));
  plan.dt = end / static_cast<double>(plan.macroSteps * plan.stepsPerMacroStep);
  return plan;
}

}  // namespace dovetail::wave
