// Elastic and plastic laws for logarithmic strain.
#pragma once

#include <span>

#include "dovetail/fem/laws/plasticity.hpp"
#include "log_strain.hpp"

namespace dovetail::fem::detail {

struct HenckyLaw {
  HenckyElasticity elasticity;

  template <class T>
  T respond(const Tensor<T>& F, Tensor<T>& P, const TangentOut<T>* tangent) const {
    const LogStrain<T> log(F, {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
    const std::array<T, 3> e = log.strain();
    const SixOf<T> strain = {e[0], e[1], e[2], 0.0, 0.0, 0.0}, stress = elasticity.stress(strain);
    P = log.firstStress(stress);
    if (tangent) log.writeTangent(stress, isotropicStiffness<T>(elasticity.kappa, 2.0 * elasticity.mu), true, *tangent);
    return elasticity.energy(strain);
  }
};

/// Trial strain of one point, in its principal frame.
struct TrialStrain {
  Six strain;              ///< without shear
  Tensor<double> vectors;  ///< columns: the axes of the frame

  /// A symmetric tensor of the intermediate configuration in the frame, and back.
  Six toFrame(const Six& a) const { return sixOf(product(transposed(vectors), product(tensorOf(a), vectors))); }
  Six fromFrame(const Six& a) const { return sixOf(product(vectors, product(tensorOf(a), transposed(vectors)))); }
};

/// What a flow rule makes of the trial strain, all in its frame. Flow rules also write ∂stress/∂(trial strain) unless
/// the pointer to it is null.
struct FlowAnswer {
  bool flows = false;
  Six elasticStrain{}, stress{};
  double stored = 0.0, dissipated = 0.0;
};

struct J2Flow {
  HenckyElasticity elasticity;
  YieldCurve yield;
  double kinematic, recovery;

  const char* name() const { return "J2 plasticity"; }
  std::size_t variables() const { return kinematic > 0.0 ? 7 : 1; }
  bool isSymmetric() const { return !(recovery > 0.0); }
  /// Whether the stress has the axes of the trial strain.
  bool isCoaxial() const { return !(kinematic > 0.0); }
  FlowAnswer advance(const TrialStrain& trial, std::span<const double> history, std::span<double> newHistory,
                     SixBySix* stiffness) const;
};

struct DruckerPragerFlow {
  HenckyElasticity elasticity;
  ConeConstants cone;
  YieldCurve cohesion;
  bool hardens;

  const char* name() const { return "Drucker-Prager"; }
  /// Accumulated plastic strain and the elastic strain of volume, which tells the pressure at the start of a step.
  std::size_t variables() const { return 2; }
  bool isSymmetric() const { return cone.friction == cone.dilatancy && !hardens; }
  bool isCoaxial() const { return true; }
  /// What the yield function falls by per multiplier of flow: by the elastic stress, by dc/da, and by both.
  double elasticGain() const { return elasticity.mu + elasticity.kappa * cone.friction * cone.dilatancy; }
  double hardeningFraction() const { return cone.cohesive / std::numbers::sqrt3; }
  double resistance(double a) const { return elasticGain() + hardeningFraction() * cohesion.slope(a); }
  FlowAnswer advance(const TrialStrain& trial, std::span<const double> history, std::span<double> newHistory,
                     SixBySix* stiffness) const;

private:
  /// The multiplier of flow that brings the trial stress to the cone.
  double multiplier(double excess, double accumulated) const;
  /// ∂stress/∂strain on the cone: shear stress along `direction`, of which the return left the fraction `left`.
  SixBySix coneStiffness(const Six& direction, double left, double gain) const;
  /// The same at the apex, which moves with the cohesion.
  SixBySix apexStiffness(const Six& direction, double accumulated) const;
};

std::shared_ptr<const PointMaterial> plasticMaterial(double density, J2Flow flow);
std::shared_ptr<const PointMaterial> plasticMaterial(double density, DruckerPragerFlow flow);

}  // namespace dovetail::fem::detail
