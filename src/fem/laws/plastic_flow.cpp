#include <cmath>
#include <numbers>

#include "log_laws.hpp"

namespace dovetail::fem::detail {
namespace {

const double rootThreeHalves = std::sqrt(1.5);
/// Distance from the yield surface, inside it, up to which the stiffness is that of flow: a fraction of the yield
/// stress, and what round-off of F does. A point that has just flowed lies there by chance on either side; the first
/// guess of the next step needs the stiffness of going on.
double nearSurface(const HenckyElasticity& elasticity, double yieldStress) {
  return 1e-9 * yieldStress + 1e-14 * (elasticity.kappa + elasticity.mu);
}

/// The zero of a function that is positive at 0 and negative at `upper`: Newton's method kept inside the bracket.
/// function(x) gives value and slope.
template <class Function>
double solveBracketed(double upper, Function&& function) {
  double lower = 0.0, x = 0.0;
  for (int iteration = 0; iteration < 200; ++iteration) {
    const auto [value, slope] = function(x);
    (value > 0.0 ? lower : upper) = x;
    double next = x - value / slope;
    if (!(next > lower && next < upper)) next = 0.5 * (lower + upper);
    if (value == 0.0 || std::abs(next - x) <= 1e-15 * std::abs(next)) return x;
    x = next;
  }
  return x;
}

Six plus(const Six& a, double s, const Six& b) {
  Six c;
  for (std::size_t i = 0; i < 6; ++i) c[i] = a[i] + s * b[i];
  return c;
}
Six times(double s, Six a) {
  for (double& entry : a) entry *= s;
  return a;
}

FlowAnswer elasticAnswer(const HenckyElasticity& elasticity, const Six& strain, SixBySix* stiffness) {
  FlowAnswer answer;
  answer.elasticStrain = strain;
  answer.stress = elasticity.stress(strain);
  answer.stored = elasticity.energy(strain);
  if (stiffness) *stiffness = isotropicStiffness(elasticity.kappa, 2.0 * elasticity.mu);
  return answer;
}

/// Plastic flow brought the elastic strain to `strain`.
void relax(FlowAnswer& answer, const HenckyElasticity& elasticity, const Six& strain) {
  answer.flows = true;
  answer.elasticStrain = strain;
  answer.stress = elasticity.stress(strain);
  answer.stored = elasticity.energy(strain);
}

/// State of the radial return of J2Flow for an increment of the accumulated plastic strain.
struct Return {
  double increment, fade;  ///< Δa and ρ = 1/(1 + γ Δa)
  Six relative;            ///< dev T_trial − ρ X_n
  double size;             ///< its norm
  double residual, slope;
};

class J2Step {
public:
  /// @param trial  dev T
  /// @param back   X at the start
  J2Step(const J2Flow& law, const Six& trial, const Six& back, double accumulated)
      : flow_(law), trial_(trial), back_(back), relative_(plus(trial, -1.0, back)), accumulated_(accumulated) {
    size_ = std::sqrt(dot(relative_, relative_));
  }

  Return at(double increment) const {
    Return state{increment, 1.0, relative_, size_, 0.0, 0.0};
    double turning = 0.0;  // of the direction, with the fading back stress
    if (flow_.recovery > 0.0) {
      state.fade = 1.0 / (1.0 + flow_.recovery * increment);
      state.relative = plus(trial_, -state.fade, back_);
      state.size = std::sqrt(dot(state.relative, state.relative));
      turning = flow_.recovery * state.fade * state.fade * dot(state.relative, back_) / state.size;
    }
    const double a = accumulated_ + increment, shear = 3.0 * flow_.elasticity.mu;
    state.residual =
        rootThreeHalves * state.size - (shear + flow_.kinematic * state.fade) * increment - flow_.yield.stress(a);
    state.slope = rootThreeHalves * turning - shear - flow_.kinematic * state.fade * state.fade - flow_.yield.slope(a);
    return state;
  }
  Return solve() const {
    const double largest = std::sqrt(dot(trial_, trial_)) + std::sqrt(dot(back_, back_));
    return at(solveBracketed(rootThreeHalves * largest / (3.0 * flow_.elasticity.mu), [&](double increment) {
      const Return state = at(increment);
      return std::pair(state.residual, state.slope);
    }));
  }

  /// ∂T/∂ε of the return.
  SixBySix stiffness(const Return& state, const Six& direction) const {
    const double mu = flow_.elasticity.mu, turn = 2.0 * rootThreeHalves * mu * state.increment / state.size;
    const double gain = -2.0 * rootThreeHalves * mu / state.slope;  // ∂Δa/∂ε = gain N
    SixBySix D = isotropicStiffness(flow_.elasticity.kappa, 2.0 * mu * (1.0 - turn));
    const double across = flow_.recovery * state.fade * state.fade;
    const Six sideways = plus(back_, -dot(back_, direction), direction);
    const Six normal =
        plus(times(2.0 * mu * (turn - rootThreeHalves * gain), direction), -turn * across * gain, sideways);
    addOuterProduct(D, normal, direction);
    return D;
  }

private:
  const J2Flow& flow_;
  Six trial_, back_, relative_;
  double accumulated_, size_;
};

}  // namespace

FlowAnswer J2Flow::advance(const TrialStrain& frame, std::span<const double> history, std::span<double> newHistory,
                           SixBySix* stiffness) const {
  const Six& strain = frame.strain;
  FlowAnswer answer = elasticAnswer(elasticity, strain, stiffness);
  std::copy(history.begin(), history.end(), newHistory.begin());
  Six backStrain{};
  if (kinematic > 0.0) {
    std::copy(history.begin() + 1, history.end(), backStrain.begin());
    backStrain = frame.toFrame(backStrain);
  }
  const Six backBefore = backStrain;
  const double modulus = 2.0 / 3.0 * kinematic;
  const J2Step step(*this, deviator(answer.stress), times(modulus, backStrain), history[0]);
  const Return start = step.at(0.0);
  if (stiffness && start.residual > -nearSurface(elasticity, yield.stress(history[0])))
    *stiffness = step.stiffness(start, times(1.0 / start.size, start.relative));
  if (start.residual > 0.0) {
    const Return state = step.solve();
    const Six direction = times(1.0 / state.size, state.relative);
    const Six flow = times(rootThreeHalves * state.increment, direction);
    relax(answer, elasticity, plus(strain, -1.0, flow));
    if (stiffness) *stiffness = step.stiffness(state, direction);
    backStrain = times(state.fade, plus(backStrain, 1.0, flow));
    newHistory[0] += state.increment;
    if (kinematic > 0.0) {
      const Six turned = frame.fromFrame(backStrain);
      std::copy(turned.begin(), turned.end(), newHistory.begin() + 1);
    }
    // What recovery takes of the back strain, γ α Δa with α at the end, it takes against the mean back stress.
    const double recovered = 0.5 * (dot(backBefore, backStrain) + dot(backStrain, backStrain));
    answer.dissipated = std::max(0.0, yield.stress(0.0) + recovery * modulus * recovered) * state.increment;
  }
  answer.stored += yield.stored(newHistory[0]) + 0.5 * modulus * dot(backStrain, backStrain);
  return answer;
}

double DruckerPragerFlow::multiplier(double excess, double accumulated) const {
  const double strength = cone.cohesive * cohesion.stress(accumulated);
  return solveBracketed((excess + strength) / elasticGain(), [&](double multiplier) {
    const double a = accumulated + multiplier / std::numbers::sqrt3;
    const double grown = cone.cohesive * cohesion.stress(a) - strength;
    return std::pair(excess - elasticGain() * multiplier - grown, -resistance(a));
  });
}

FlowAnswer DruckerPragerFlow::advance(const TrialStrain& frame, std::span<const double> history,
                                      std::span<double> newHistory, SixBySix* stiffness) const {
  const Six& strain = frame.strain;
  FlowAnswer answer = elasticAnswer(elasticity, strain, stiffness);
  newHistory[0] = history[0];
  newHistory[1] = trace(strain);
  const double mu = elasticity.mu, kappa = elasticity.kappa, strength = cone.cohesive * cohesion.stress(history[0]);
  const Six s = deviator(answer.stress);
  const double norm = std::sqrt(dot(s, s)), root = norm / std::numbers::sqrt2, p = trace(answer.stress) / 3.0;
  const double excess = root + cone.friction * p - strength;
  // Near the apex only rounding tells the direction of what shear is left.
  const double near = nearSurface(elasticity, root + strength), shearless = 100.0 * near;
  if (!(excess > 0.0)) {
    // Soil without cohesion begins at its apex and could not carry the first load with the stiffness there.
    if (stiffness && excess > -near && (root > shearless || strength > 0.0))
      *stiffness =
          root > shearless ? coneStiffness(times(1.0 / norm, s), 1.0, 1.0 / resistance(history[0])) : SixBySix{};
    return answer;
  }
  const double gamma = multiplier(excess, history[0]), left = 1.0 - mu * gamma / root;
  const bool onCone = left >= 0.0;
  newHistory[0] += (onCone ? gamma : root / mu) / std::numbers::sqrt3;
  const double pressure =
      onCone ? p - kappa * cone.dilatancy * gamma : cone.cohesive * cohesion.stress(newHistory[0]) / cone.friction;
  Six elastic = times(onCone ? left / (2.0 * mu) : 0.0, s);
  for (std::size_t i = 0; i < 3; ++i) elastic[i] += pressure / (3.0 * kappa);
  relax(answer, elasticity, elastic);
  newHistory[1] = pressure / kappa;
  const double meanStrength = 0.5 * (strength + cone.cohesive * cohesion.stress(newHistory[0]));
  const double meanPressure = 0.5 * (kappa * history[1] + pressure);
  answer.dissipated = onCone ? gamma * std::max(0.0, meanStrength - (cone.friction - cone.dilatancy) * meanPressure)
                             : meanStrength / cone.friction * (p - pressure) / kappa;
  if (!stiffness) return answer;
  const Six direction = norm > 0.0 ? times(1.0 / norm, s) : Six{};
  *stiffness = left * root > shearless || cone.friction == 0.0
                   ? coneStiffness(direction, left, 1.0 / resistance(newHistory[0]))
                   : apexStiffness(direction, newHistory[0]);
  return answer;
}

SixBySix DruckerPragerFlow::coneStiffness(const Six& direction, double left, double gain) const {
  const double mu = elasticity.mu, kappa = elasticity.kappa;
  constexpr double root2 = std::numbers::sqrt2;
  const Six unit = {1, 1, 1, 0, 0, 0};
  SixBySix D = isotropicStiffness(kappa, 2.0 * mu * left);
  // ∂γ/∂ε, and T changes by −(√2 μ N + κ η̄ 1) ∂γ and by what keeps N's fraction of the shear
  const Six byStrain = times(gain, plus(times(root2 * mu, direction), kappa * cone.friction, unit));
  addOuterProduct(D, times(-1.0, plus(times(root2 * mu, direction), kappa * cone.dilatancy, unit)), byStrain);
  addOuterProduct(D, times(2.0 * mu * (1.0 - left), direction), direction);
  return D;
}

SixBySix DruckerPragerFlow::apexStiffness(const Six& direction, double accumulated) const {
  SixBySix D{};
  if (!hardens) return D;
  const double gain = cone.cohesive / cone.friction * cohesion.slope(accumulated) / rootThreeHalves;
  addOuterProduct(D, {gain, gain, gain, 0.0, 0.0, 0.0}, direction);
  return D;
}

}  // namespace dovetail::fem::detail
