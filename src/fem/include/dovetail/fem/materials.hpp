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

using Material = std::variant<StVenantKirchhoff, DeformedMetricHooke>;

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
