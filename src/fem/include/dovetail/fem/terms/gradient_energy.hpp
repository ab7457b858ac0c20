// Energy of the gradient of F: gives bands of softening solids a width of their own.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/fem/model/term.hpp"

namespace dovetail::fem {

struct GradientOptions {
  double modulus = 0.0;                ///< D, N, > 0
  std::string name = "gradient of F";  ///< its channel in the ledger
  std::vector<double> fraction{};      ///< as that of the elements, SolidOptions::fraction
};

/// W = ∫ ½ D |∇(ΠF)|² + ½ κ |F − ΠF|² dV, beside the elements of a mesh and whatever their law. ΠF is linear (bilinear,
/// trilinear) between corners, where it is the mean (ΠF)_a = Σ_p V_p N_a F_p / Σ_p V_p N_a of the points around. Second
/// gradients as those of Desrues, Argilaga, Caillerie, Combe, Nguyen, Richefeu & Dal Pont (2019, J. Mech. Phys.
/// Solids), without unknowns. κ = 4 D/h² on the mean of F in each element of quad4 and hex8, 8 D/h² at the 2 × 2 points
/// of quad8: a wave k of F on a regular mesh then has the stiffness 4 D sin²(kh/2)/h², and none is free. h is the
/// length of the element, of plane cells the geometric mean of both, of bricks the middle one of three.
///
/// The force is linear in u, by one symmetric matrix for all components, which couples a node with two rings of
/// elements: 49 (quad4), 120 (quad8), 343 (hex8) nodes. It is objective; uniform F has none. At free surfaces ΠF is
/// one-sided: a linear F in n layers of quad4 stores 1 − 1/n of what it should.
///
/// A shear layer whose stress falls by H per shear strain, with the modulus G outside, gets a band of the width
/// bandWidth(D, H, G).
/// @throws InputError for a modulus that is not positive, another shape of elements than quad4, quad8 and hex8, several
/// shapes, an invalid mesh, fractions as in makeSolid
std::shared_ptr<Term> gradientEnergy(const SolidMesh& mesh, const GradientOptions& options);

/// 2 √(D/H) (π − arctan √(H/G)), m. @param modulus  D, N @param softening  H > 0, Pa @param shear  G, Pa
double bandWidth(double modulus, double softening, double shear);

}  // namespace dovetail::fem
