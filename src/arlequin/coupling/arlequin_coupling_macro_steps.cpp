// What overlap ties do at the ends of macro steps.
#include <utility>

#include "arlequin_coupling_impl.hpp"

namespace dovetail::arlequin {

/// Rate of the gap that impulses of the rows, N s, take away, m/s.
std::vector<Vec3> ArlequinCoupling::Impl::answered(const dem::Model& m, std::span<const Vec3> impulses) const {
  const std::vector<double> mass = yieldingMasses(m);
  std::vector<Vec3> onParticles(m.particles.size()), onNodes(nodes().v.size()), rate(parts.gap.rows());
  pullParticles(parts.gap, overlap, impulses, onParticles);
  pullNodes(parts.gap, impulses, onNodes);
  side.mass->solve(onNodes);
  for (std::size_t i = 0; i < onParticles.size(); ++i) onParticles[i] *= 1.0 / mass[i];
  gapOf(parts.gap, overlap, onParticles, onNodes, rate);
  for (Vec3& value : rate) value = -value;
  return rate;
}

/// Multipliers at the first start: those that answer all forces there.
void ArlequinCoupling::Impl::answerForces(const dem::Model& m) {
  const std::vector<Vec3> before = side.model->nodes.f, none(now.size());
  fem::evaluateForces(*side.model, {.t = side.model->t, .mass = side.mass});
  std::vector<Vec3> onNodes = std::exchange(side.model->nodes.f, before);
  for (const int node : side.load.touched)
    onNodes[static_cast<std::size_t>(node)] += side.load.force[static_cast<std::size_t>(node)];
  parts.constraint->evaluate({now, none, none, accelerationUnder(m, std::move(onNodes)), 1.0}, lambda);
}

/// Multipliers at the ends of macro steps of length h. Other forces change the rate of the gap by c within a macro
/// step, λ by −h A λ in the two kicks about its end. λ' after which rates comply between these kicks holds c/(h A) as a
/// mean, but what it is off changes its sign from macro step to macro step for ever. Of λ = ¼ λ_before + ¾ λ' it falls
/// by half in each, and λ takes h²/12 of Δ(λ·A λ), a function of the state, and of Δλ·A Δλ, which is never negative. At
/// a start the second kick is the only one, and half of the c that λ before tells is yet to come.
void ArlequinCoupling::Impl::answerMacroStep(const GapRates& rates, bool ends) {
  constexpr double old = 0.25;
  const std::vector<Vec3> before = lambda;
  parts.constraint->evaluate(rates, lambda);
  if (!parts.constraint->needsRates()) return;
  for (std::size_t r = 0; r < lambda.size(); ++r)
    lambda[r] = ends ? (1.0 - old) * lambda[r] + old * before[r] : lambda[r] + before[r];
}

/// λ at the end of a macro step, which acts in both half macro steps about it: what it takes is the work of these two
/// kicks against the means of the rates before and after each. At a start there is the second one only.
void ArlequinCoupling::Impl::evaluateMacroStep(const dem::Model& m, double half) {
  std::vector<Vec3> rate(now.size()), change(now.size()), damped(now.size());
  const std::vector<Vec3> none(now.size());
  const bool lags = setting.options.dashpotLags;
  for (std::size_t r = 0; r < now.size(); ++r) {
    change[r] = now[r] - atMacroStep[r];
    damped[r] = lags ? 0.5 * (change[r] + macroIncrement[r]) : change[r];
  }
  gapOf(parts.gap, overlap, m.particles.v, nodes().v, rate);
  const bool ends = macroTime && m.time > *macroTime;
  if (!macroTime && parts.constraint->needsRates()) answerForces(m);
  answerMacroStep({now, damped, rate, none, half}, ends);
  std::vector<Vec3> impulses = lambda;
  for (Vec3& impulse : impulses) impulse *= half;
  const double against = sumOfProducts(impulses, rate), own = sumOfProducts(impulses, answered(m, impulses));
  if (ends) lost += openingWork + against - 0.5 * own;
  openingWork = against - (ends ? 1.5 : 0.5) * own;
  macroTime = m.time;
  atMacroStep = now;
  macroIncrement = std::move(change);
}

void ArlequinCoupling::constrainMacroStep(const dem::Model& m, std::span<const Vec3> ownForce, double half,
                                          std::span<Vec3> onParticles, coupling::NodalLoad& load) const {
  if (!constrains()) return;
  Impl& s = *impl_;
  s.ready(m);
  std::vector<Vec3> lambda(s.parts.gap.rows());
  if (s.actsInMacroSteps()) {
    s.evaluateMacroStep(m, half);
    lambda = s.lambda;
  } else {
    const std::vector<Vec3> still(s.overlap.size()), none(lambda.size());
    std::vector<Vec3> ofNodes(ownForce.begin(), ownForce.end()), acceleration(lambda.size());
    side().mass->solve(ofNodes);
    gapOfMembers(s.parts.gap, still, ofNodes, acceleration);
    s.parts.constraint->evaluate({s.now, none, none, acceleration, half}, lambda);
  }
  pullParticles(s.parts.gap, s.overlap, lambda, onParticles);
  s.loadNodes(lambda, load);
}

}  // namespace dovetail::arlequin
