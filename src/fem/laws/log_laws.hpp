// Elastic and plastic laws for logarithmic strain.
#pragma once

#include "dovetail/fem/history_law.hpp"
#include "dovetail/fem/plasticity.hpp"
#include "log_strain.hpp"

namespace dovetail::fem::detail {

struct HenckyLaw {
  static constexpr bool branches = true;
  HenckyElasticity elasticity;

  double respond(const Tensor<double>& F, Tensor<double>& P, const TangentOut<double>* tangent) const {
    const LogStrain log(F, {1, 0, 0, 0, 1, 0, 0, 0, 1});
    const Six strain = log.strain(), stress = elasticity.stress(strain);
    P = log.firstStress(stress);
    if (tangent) log.writeTangent(stress, isotropicStiffness(elasticity.kappa, 2.0 * elasticity.mu), *tangent);
    return elasticity.energy(strain);
  }
};

/// What a flow rule makes of the trial strain, all in its principal frame.
struct FlowAnswer {
  bool flows = false;
  Six elasticStrain{}, stress{};
  SixBySix stiffness{};  ///< ∂stress/∂trial strain; only if asked for
  double stored = 0.0, dissipated = 0.0;
};

/// History: Fₚ⁻¹, then what the flow rule remembers. Flow has
///   std::size_t variables() const;  bool isSymmetric() const;
///   FlowAnswer advance(const LogStrain& trial, span history, span newHistory, bool withStiffness) const
template <class Flow>
struct LogPlasticLaw {
  Flow flow;

  std::size_t historySize() const { return 9 + flow.variables(); }
  bool isSymmetric() const { return flow.isSymmetric(); }
  void start(std::span<double> history) const {
    std::fill(history.begin(), history.end(), 0.0);
    history[0] = history[4] = history[8] = 1.0;
  }

  void step(PointStep<double>& step, const TangentOut<double>* tangent) const {
    const LogStrain trial(step.F, asTensor(step.history.data()));
    const FlowAnswer answer =
        flow.advance(trial, step.history.subspan(9), step.newHistory.subspan(9), tangent != nullptr);
    if (answer.flows) {
      const Tensor<double> inverse = trial.plasticInverse(answer.elasticStrain);
      std::copy(inverse.begin(), inverse.end(), step.newHistory.begin());
    } else {
      std::copy_n(step.history.begin(), 9, step.newHistory.begin());
    }
    step.P = trial.firstStress(answer.stress);
    if (tangent) trial.writeTangent(answer.stress, answer.stiffness, *tangent);
    step.energy = answer.stored;
    step.dissipated = answer.dissipated;
  }
};

struct J2Flow {
  HenckyElasticity elasticity;
  YieldCurve yield;
  double kinematic, recovery;

  std::size_t variables() const { return kinematic > 0.0 ? 7 : 1; }
  bool isSymmetric() const { return !(recovery > 0.0); }
  FlowAnswer advance(const LogStrain& trial, std::span<const double> history, std::span<double> newHistory,
                     bool withStiffness) const;
};

struct DruckerPragerFlow {
  HenckyElasticity elasticity;
  ConeConstants cone;

  std::size_t variables() const { return 1; }
  bool isSymmetric() const { return cone.friction == cone.dilatancy; }
  FlowAnswer advance(const LogStrain& trial, std::span<const double> history, std::span<double> newHistory,
                     bool withStiffness) const;

private:
  /// ∂stress/∂strain on the cone: shear stress along `direction`, of which the return left the share `left`.
  SixBySix coneStiffness(const Six& direction, double left, double gain) const;
};

}  // namespace dovetail::fem::detail
