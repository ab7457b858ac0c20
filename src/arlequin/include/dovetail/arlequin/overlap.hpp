// The overlap: which particles lie in which element, and with what weight.
#pragma once

#include <span>
#include <vector>

#include "dovetail/arlequin/cells.hpp"
#include "dovetail/cg/projection.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/dem/pairs/pairs.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/fem/mesh/element_locator.hpp"
#include "dovetail/fem/model/nodes.hpp"

namespace dovetail::arlequin {

/// Particles within the mesh or nearer to it than their radius, and those farther outside that kernels reach. Row k of
/// every array is particle `particle[k]`.
struct Overlap {
  std::vector<int> particle;  ///< ascending
  /// Host element (−1: out of its reach), parent coordinates (beyond the parent cell for a centre outside of the mesh),
  /// shape functions.
  std::vector<fem::CellPlace> place;
  std::vector<Vec3> x;              ///< centre when it was found, m; of particles in periodic space the image there
  std::vector<double> weight;       ///< w at the centre; beyond a face of the mesh it keeps its value on the face
  std::vector<int> elements;        ///< that host a particle in the overlap proper (w > 0 somewhere), ascending
  std::vector<double> nodalWeight;  ///< w at every node of the mesh
  /// Particles, ascending, that no element holds or is near, but the box around the elements with w > 0: beyond a free
  /// face that is not along the axes, in a notch, or where the mesh was meant to be. They have full weight and are not
  /// tied.
  std::vector<int> stray;

  std::size_t size() const { return particle.size(); }
};

/// w at a place of the mesh, by the vertex shape functions of the corners. @param nodalWeight  w per node
double weightAt(const fem::SolidMesh& mesh, const fem::CellPlace& place, std::span<const double> nodalWeight);

/// Finds the particles that lie within the mesh as it is now (X + u), or outside and nearer to it than their radius.
/// @param nodalWeight  w per node, 0 … 1
/// @param reach  m: particles outside are taken in up to this distance from the box around the elements with w > 0
/// @param space  whose images of particles count too
/// @throws InputError if no particle lies in an element with w > 0 somewhere, if no element has one, or if weights are
///         not one per node or not within 0 … 1; NumericalError naming a particle whose position is not finite
Overlap locateOverlap(const dem::Particles& particles, const fem::SolidMesh& mesh, const fem::Nodes& nodes,
                      std::span<const double> nodalWeight, double reach = 0.0, const geometry::Periodicity& space = {});

/// @throws InputError unless the weights fall from largest to smallest over more than one of the elements with
/// particles
void requireWidth(const Overlap& overlap, const fem::SolidMesh& mesh);

/// 1 − w per node, for fem::SolidOptions::fraction.
std::vector<double> solidWeights(std::span<const double> nodalWeight);

/// Φ: velocities of the nodes → of the solid at the centres of the overlap's particles. Rows sum to one.
/// @throws InputError for a particle out of the reach of the mesh
cg::Projection interpolationAtParticles(const Overlap& overlap, const fem::SolidMesh& mesh);

}  // namespace dovetail::arlequin
