// Ties of meshes that do not match, and of opposite faces of a periodic cell.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/fem/model/constraints.hpp"

namespace dovetail::fem {

/// Macroscopic deformation gradient as a function of time, row-major.
using GradientFunction = std::function<std::array<double, 9>(double)>;

struct PeriodicTies {
  std::vector<Tie> ties;
  /// Node in the lower corner of the cell, a master: hold it, since periodicity leaves the translations free.
  int corner = -1;
  double volume = 0.0;  ///< of the box, m³
};

/// u(X + L) − u(X) = (F(t) − 1) L for the nodes of opposite faces of a box along the axes; every node on an upper face
/// is tied to its image on the lower faces (nodes on edges and corners to the one on all of them). In plane strain
/// along x and y only, by these components of F.
/// @param axes       which pairs of faces
/// @param tolerance  how far a node may lie from the face and from the place of its image, over the longest side of the
///                   box, > 0
/// @throws InputError naming a node without image
PeriodicTies periodicTies(const SolidMesh& mesh, const GradientFunction& F,
                          std::array<bool, 3> axes = {true, true, true}, double tolerance = 1e-6);

/// Volume average of the first Piola–Kirchhoff stress of a cell in equilibrium, row-major, Pa: −Σ f ⊗ X / V; without
/// P_33 in plane strain, which no node feels.
/// @param f       forces by the solid on its nodes, N (evaluateForces of a model without loads)
/// @param volume  m³
std::array<double, 9> averageFirstStress(const Nodes& nodes, std::span<const Vec3> f, double volume);

/// Ties every slave node to the nearest master face: u = Σ N_a(ξ) u_a there. Forces go the same way back, so no force
/// is lost; no moment either if the slaves lie on the faces. Linear displacements pass without error. A uniform stress
/// is in equilibrium exactly if the slave faces divide the master faces (then N_a of the masters is a function of the
/// slave mesh too); otherwise forces on master nodes are off by the
/// error of the slaves' quadrature of N_a: up to 13 % of stress times face area for bricks of 2 : 3, 2.4 % for 2 : 7.
/// Let the finer side be the slave.
/// @param slaves     node numbers; none may be a node of the faces
/// @param tolerance  largest distance of a slave from the faces, m, > 0
/// @throws InputError naming a slave that lies farther away or belongs to a master face; NumericalError naming a node
///         whose position is not finite
std::vector<Tie> tieInterface(const SolidMesh& mesh, std::span<const int> slaves, std::span<const Face> masters,
                              double tolerance);

}  // namespace dovetail::fem
