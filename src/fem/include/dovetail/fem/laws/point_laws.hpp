// Elastic laws for points. E is Green's strain ½(FᵀF − 1), J = det F; all are objective and isotropic but AxialSprings.
#pragma once

#include <memory>

#include "dovetail/fem/laws/materials.hpp"
#include "dovetail/fem/laws/point_material.hpp"

namespace dovetail::fem {

/// W = μ/2 (J^(−2/3) F:F − 3) + κ/4 (J² − 1 − 2 ln J): volume and shape apart, for rubber and for ν → ½
/// (Simo & Hughes, Computational Inelasticity, 1998, Eq. 9.2.6).
struct NeoHookean {
  double bulkModulus;   ///< κ, Pa
  double shearModulus;  ///< μ, Pa
  double density;       ///< reference, kg/m³
};
/// With κ = E/(3(1 − 2ν)) and μ = E/(2(1 + ν)). @throws InputError unless E > 0, −1 < ν < 0.5
NeoHookean neoHookean(double youngsModulus, double poissonRatio, double density);

/// W = μ/2 (F:F − 3 − 2 ln J) + U(J): the sides of a compressed point push out with no other modulus than λ
/// (Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2008, Eq. 6.27; Wriggers, Nonlinear Finite
/// Element Methods, 2008, Eq. 3.116).
struct CoupledNeoHookean {
  enum class Volume {
    logarithm,  ///< U = λ/2 (ln J)²
    quadratic   ///< U = λ/4 (J² − 1 − 2 ln J)
  };
  double lambda, mu;  ///< Lamé's constants, Pa
  double density;     ///< reference, kg/m³
  Volume volume = Volume::logarithm;
};

/// W = μ |dev ε|² + κ/2 (tr ε)², ε = ½ ln FᵀF: straight lines between Kirchhoff stress and logarithmic strain; the
/// elastic part of the plastic laws. Good for moderate stretches; a bar has its greatest force at the stretch e.
struct Hencky {
  double youngsModulus;  ///< Pa
  double poissonRatio;   ///< −1 < ν < 0.5
  double density;        ///< reference, kg/m³
};

/// @throws InputError naming the constant that is out of range
std::shared_ptr<const PointMaterial> pointMaterial(const NeoHookean& law);
std::shared_ptr<const PointMaterial> pointMaterial(const CoupledNeoHookean& law);
std::shared_ptr<const PointMaterial> pointMaterial(const Hencky& law);
/// The laws of materials.hpp. StVenantKirchhoff refuses states past its limit point in compression
/// (PointMaterial::whyInvalid).
std::shared_ptr<const PointMaterial> pointMaterial(const Material& law);

/// The smallest eigenvalue of ∂²W/∂λ_a∂λ_b over μ, λ_a the principal stretches of F (nine numbers, row-major): what
/// is left of the stiffness of StVenantKirchhoff. ≤ 0 past the limit point, which is the stretch 1/√3 for a bar with
/// free sides; from there on the force falls as the bar is compressed, and no dead load is carried.
double stiffnessLeft(const StVenantKirchhoff& law, const double* F);

}  // namespace dovetail::fem
