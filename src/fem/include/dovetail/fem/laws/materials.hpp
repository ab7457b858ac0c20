// Elastic laws at finite strain. E is Green's strain ½(FᵀF − 1), S the second Piola–Kirchhoff stress, F = ∂x/∂X.
#pragma once

#include <variant>

namespace dovetail::fem {

/// S = λ tr(E) 1 + 2μ E, with the energy ½ S:E per reference volume.
struct StVenantKirchhoff {
  double youngsModulus;  ///< Pa
  double poissonRatio;   ///< −1 < ν < 0.5
  double density;        ///< reference, kg/m³
};

/// Hooke's law on the deformed metric (Cheng et al. 2023, Eq. 34):
/// S = λ tr(C⁻¹E) C⁻¹ + 2μ C⁻¹ E C⁻¹ with C = FᵀF.
///
/// It agrees with StVenantKirchhoff to first order in the strain. It derives from no potential unless ν = 0, so work
/// around a closed path is not zero in general; the energy that is reported, ½ S:E, is right to second order in the
/// strain only.
struct DeformedMetricHooke {
  double youngsModulus;  ///< Pa
  double poissonRatio;   ///< −1 < ν < 0.5
  double density;        ///< reference, kg/m³
};

/// Linear springs along the reference axes, with shear: W = ½ E Σ_i (|F e_i| − 1)² + 2μ Σ_{i<j} E_ij², μ = E/2.
///
/// What a cubic lattice of linear springs does when it is stretched along its axes, P = E (λ − 1): a continuum that is
/// to go with such particles takes it in place of StVenantKirchhoff, with which it agrees to first order for ν = 0, and
/// whose P = E λ (λ² − 1)/2 is 3/2 ε² off. Objective; derives from its potential.
struct AxialSprings {
  double youngsModulus;  ///< E, Pa
  double density;        ///< reference, kg/m³
  static constexpr double poissonRatio = 0.0;
};

using Material = std::variant<StVenantKirchhoff, DeformedMetricHooke, AxialSprings>;

/// λ and μ, Pa.
struct LameConstants {
  double lambda, mu;
};
LameConstants lameConstants(double youngsModulus, double poissonRatio);

double density(const Material& material);
double youngsModulus(const Material& material);
double poissonRatio(const Material& material);

/// @throws InputError unless E > 0, −1 < ν < 0.5 and ρ > 0
void validate(const Material& material);

}  // namespace dovetail::fem
