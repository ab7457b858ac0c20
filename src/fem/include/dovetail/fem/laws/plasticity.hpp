// Plastic laws at finite strain: F = Fₑ Fₚ, logarithmic elastic strain ε = ½ ln FₑᵀFₑ, Kirchhoff stress linear in it.
//
// The flow rule acts on ε and its conjugate stress T, which is the Kirchhoff stress turned back by the elastic
// rotation: small-strain return mappings hold as they are (Simo 1992, Comput. Methods Appl. Mech. Engng 99; de Souza
// Neto, Perić & Owen, Computational Methods for Plasticity, 2008, ch. 14). At constant F the elastic strain relaxes by
// dε = −N dγ without elastic rotation; where N and ε have the same axes, which is always so without kinematic
// hardening, this is the exponential map Fₚ ← e^(γN) Fₚ. Dissipation is booked with the means over the step of what
// resists the flow: yield stress, pressure, back stress. It is never negative, and work, which steps in time do with
// the mean of the forces at both ends, stored energy and dissipation balance to second order in the step.
//
// History: Fₚ⁻¹ row-major (9), accumulated plastic strain (1); for kinematic hardening the back strain, a symmetric
// tensor in the intermediate configuration, 11, 22, 33, √2·12, √2·23, √2·31 (6); for DruckerPrager the elastic strain
// of volume, tr ε (1).
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "dovetail/fem/laws/point_material.hpp"

namespace dovetail::fem {

/// Yield stress as a function of the accumulated plastic strain a.
struct YieldCurve {
  std::function<double(double)> stress;  ///< σ_y, Pa; > 0
  std::function<double(double)> slope;   ///< dσ_y/da, Pa
  std::function<double(double)> stored;  ///< ∫₀ᵃ (σ_y − σ_y(0)) da, J/m³: what hardening stores
};
/// σ_y = σ₀ + H a + (σ_∞ − σ₀)(1 − e^(−δ a)).
/// @throws InputError unless σ₀ > 0, σ_∞ > 0, H ≥ 0 and δ ≥ 0
YieldCurve saturatingYield(double initial, double linear, double saturation, double exponent);
/// σ_y = σ₀ + H a. @throws InputError unless σ₀ > 0 and H ≥ 0
YieldCurve linearYield(double initial, double linear = 0.0);
/// Straight between points (a, σ_y), level behind the last.
/// @throws InputError unless the first a is 0, a ascends and every σ_y is positive
YieldCurve tabulatedYield(const std::vector<std::pair<double, double>>& points);

/// Von Mises: √(3/2) |dev T − X| ≤ σ_y(a). The back stress is X = ⅔ C α; the back strain α follows plastic flow,
/// α̇ = D_p − (3γ/2C) X ȧ (Prager for γ = 0, Armstrong & Frederick 1966 otherwise; X then saturates at √(3/2)|X| =
/// C/γ). Stored: elastic, ∫(σ_y − σ_y(0)) da and ⅓ C α:α; dissipated: σ_y(0) Δa and (3γ/2C)|X|² Δa. The tangent is
/// symmetric for γ = 0.
struct J2Plasticity {
  double youngsModulus;  ///< Pa
  double poissonRatio;   ///< −1 < ν < 0.5
  double density;        ///< reference, kg/m³
  YieldCurve yield;
  double kinematicModulus = 0.0;  ///< C, Pa
  double recovery = 0.0;          ///< γ
};

/// Which Drucker–Prager cone stands for Mohr and Coulomb's cohesion and friction angle (de Souza Neto et al. 2008,
/// Eqs. 6.121–6.124).
enum class ConeMatch {
  compression,  ///< outer edges: triaxial compression
  extension,    ///< inner edges: triaxial extension
  planeStrain   ///< collapse in plane strain with associated flow
};

/// √(½ s:s) + η p ≤ ξ c with s = dev T, p = tr T/3, tension positive; flow along √(½ s:s) + η̄ p. η and ξ come from the
/// friction angle, η̄ from the dilatancy angle. At the apex p = ξ c/η, s = 0 whatever the strain. Stresses are
/// Kirchhoff's. What the history accumulates is a = Σ √(⅔ Δe_p:Δe_p) of the plastic shape change e_p; the cohesion may
/// grow or fall with it. Plastic work is dissipated, all of it. The tangent is symmetric for equal angles and constant
/// cohesion only.
struct DruckerPrager {
  double youngsModulus;   ///< Pa
  double poissonRatio;    ///< −1 < ν < 0.5
  double density;         ///< reference, kg/m³
  double cohesion;        ///< c ≥ 0, Pa; 0 with a cohesionCurve
  double frictionAngle;   ///< 0 ≤ φ < π/2, rad
  double dilatancyAngle;  ///< 0 ≤ ψ ≤ φ, rad
  ConeMatch match = ConeMatch::compression;
  /// c(a) ≥ 0 and dc/da in place of a constant cohesion; `stored` is not asked for. Where c falls, results depend on
  /// the size of the elements, and the slope must stay above −√3 (μ + κ η η̄)/ξ.
  YieldCurve cohesionCurve = {};
};

/// η, η̄, ξ and ξ c of a point that has never flowed.
struct ConeConstants {
  double friction, dilatancy;
  double cohesive;
  double strength;  ///< Pa
};
/// @throws InputError for angles or a cohesion out of range, or no strength at all
ConeConstants coneConstants(const DruckerPrager& law);

/// @throws InputError naming the constant that is out of range
std::shared_ptr<const PointMaterial> pointMaterial(const J2Plasticity& law);
std::shared_ptr<const PointMaterial> pointMaterial(const DruckerPrager& law);

/// What hardening has stored (part of the energy a point reports), J/m³. `history` is that of one point.
double hardeningEnergy(const J2Plasticity& law, std::span<const double> history);
/// Accumulated plastic strain of a point's history, for both laws.
double plasticStrain(std::span<const double> history);
/// det Fₚ: 1 for J2Plasticity, what dilatancy has made of the volume for DruckerPrager.
double plasticVolume(std::span<const double> history);

}  // namespace dovetail::fem
