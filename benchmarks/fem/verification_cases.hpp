// Static cases of finite strain with known answers, for any element.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/solve/statics.hpp"

namespace dovetail::verification {

struct ElementKind {
  fem::ElementShape shape;
  fem::Formulation formulation = fem::Formulation::standard;
  std::string label() const;
};
/// hex8 in the formulations that take every law, hex20, hex27, tet4, tet10.
const std::vector<ElementKind>& allKinds();
/// quad4 and quad8, for the cases of plane strain.
const std::vector<ElementKind>& planeKinds();

/// The elastic beam behind a cylinder under its own weight, 2 m/s² (Turek & Hron 2006, CSM1: μ = 0.5 MPa, CSM2:
/// 2 MPa; ν = 0.4, ρ = 1000 kg/m³, St Venant–Kirchhoff, plane strain by one layer of elements that cannot move in z).
/// Cells are 15 times longer at the free end than at the root.
/// @param cells  along the beam and across it; an even number across puts a node at the tip's middle
/// @return displacement of the middle of the free end, m
Vec3 beamBehindCylinder(const ElementKind& kind, std::array<int, 2> cells, double shearModulus);

enum class Sides {
  held,  ///< no motion in z: plane strain
  free   ///< free to move in z but at the clamp
};
enum class MembraneLaw {
  neoHookean,         ///< W = μ/2 (J^(−2/3) F:F − 3) + κ/4 (J² − 1 − 2 ln J)
  stVenantKirchhoff,  ///< of the same E and ν
};
struct Membrane {
  double tip = 0.0;              ///< u_y of the upper corner of the loaded edge, m
  int perEdge = 0;               ///< cells along each edge
  std::vector<double> pressure;  ///< mean of −tr σ/3 over each cell, x first, Pa
  std::vector<Vec3> place;       ///< middle of each cell, m
};
/// Cook's membrane, 1 mm thick, μ = 422.5 kPa, an even traction along y on its right edge.
/// @param force  of the traction in all, N
Membrane cooksMembrane(const ElementKind& kind, int perEdge, double poissonRatio, Sides sides = Sides::held,
                       MembraneLaw law = MembraneLaw::neoHookean, double force = 1.0);

struct PressureSteps {
  double range;         ///< of the cell means, Pa
  double largest;       ///< difference of cells side by side, over the range
  double checkerboard;  ///< largest alternating part of 3 × 3 cells, over the range
};
/// Of the cells farther than `away` (m) from both corners of the clamp.
PressureSteps pressureSteps(const Membrane& membrane, double away);

struct TipOfBeam {
  double w, u;  ///< deflection and shortening over the length
};
/// A cantilever of length 1 and height 1/slenderness, ν = 0, under the dead tip load P = α E I / L², by elements.
/// @param cells  along the beam and across its height
TipOfBeam bentCantilever(const ElementKind& kind, std::array<int, 2> cells, double alpha, double slenderness = 100.0);
/// The same of the inextensible, shear-rigid beam (the elastica): θ'' = −α cos θ, θ(0) = 0, θ'(1) = 0, by shooting.
TipOfBeam elastica(double alpha);

}  // namespace dovetail::verification
