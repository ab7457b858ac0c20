// Static cases of finite strain with known answers, for any element.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "dovetail/fem/solid.hpp"
#include "dovetail/fem/statics.hpp"

namespace dovetail::verification {

struct ElementKind {
  fem::CellShape shape;
  fem::Formulation formulation = fem::Formulation::standard;
  std::string label() const;
};
/// hex8 in its four formulations, hex20, hex27, tet4, tet10.
const std::vector<ElementKind>& allKinds();

/// The elastic beam behind a cylinder under its own weight, 2 m/s² (Turek & Hron 2006, CSM1: μ = 0.5 MPa, CSM2:
/// 2 MPa; ν = 0.4, ρ = 1000 kg/m³, St Venant–Kirchhoff, plane strain by one layer of elements that cannot move in z).
/// @param cells  along the beam and across it; an even number across puts a node at the tip's middle
/// @return displacement of the middle of the free end, m
Vec3 beamBehindCylinder(const ElementKind& kind, std::array<int, 2> cells, double shearModulus);

struct Membrane {
  double tip = 0.0;     ///< u_y of the upper corner of the loaded edge, m
  double volume = 0.0;  ///< reference, m³
  /// Means over the elements of the pressure −tr σ/3 and the reference place, in the order of the elements.
  std::vector<double> pressure;
  std::vector<Vec3> place;
};
/// Cook's membrane, 1 mm thick, plane strain, μ = 422.5 kPa, W = μ/2 (J^(−2/3) F:F − 3) + κ/4 (J² − 1 − 2 ln J), an
/// even traction of 1 N in all along y on its right edge.
/// @param perEdge  elements along each edge
Membrane cooksMembrane(const ElementKind& kind, int perEdge, double poissonRatio);
/// Largest difference of the mean pressures of elements that share a face, over the range of all, leaving out elements
/// within `away` (m) of the corner at (0, 44) mm, where the pressure has no bound.
double pressureJump(const Membrane& result, int perEdge, bool tetrahedra, double away);

struct TipOfBeam {
  double w, u;  ///< deflection and shortening over the length
};
/// A cantilever of length 1 and height 1/slenderness, ν = 0, under the dead tip load P = α E I / L², by elements.
/// @param cells  along the beam and across its height
TipOfBeam bentCantilever(const ElementKind& kind, std::array<int, 2> cells, double alpha, double slenderness = 100.0);
/// The same of the inextensible, shear-rigid beam (the elastica): θ'' = −α cos θ, θ(0) = 0, θ'(1) = 0, by shooting.
TipOfBeam elastica(double alpha);

}  // namespace dovetail::verification
