// What a mesh is worth before it is computed with: the shape of its elements and how they hang together.
#pragma once

#include <array>
#include <iosfwd>
#include <utility>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::fem {

struct ElementQuality {
  /// Least value over the nodes, 1 for cubes and regular tetrahedra, 0 for flat elements, < 0 for inverted ones.
  /// Bricks and plane cells: det J over the product of the lengths of its columns. Tetrahedra: √2 det J over the
  /// largest product of the lengths of the three edges at a corner of the local affine image (Knupp 2003).
  double scaledJacobian = 0.0;
  /// Bricks and plane cells: longest edge over shortest. Tetrahedra: longest edge over the radius of the inscribed
  /// ball, over 2√6; 1 for cubes and regular tetrahedra. Of the corners alone.
  double aspect = 0.0;
  double volume = 0.0;  ///< ∫ det J dξ, of plane cells times the thickness, m³
};

/// Elements of one shape together.
struct ShapeQuality {
  ElementShape shape{};
  std::size_t elements = 0;
  double volume = 0.0;  ///< m³
  double worstJacobian = 0.0, meanJacobian = 0.0;
  double worstAspect = 0.0, meanAspect = 0.0;
  std::array<std::size_t, 11> histogram{};  ///< of the scaled Jacobian: ≤ 0, then tenths up to 1
};

struct MeshQuality {
  std::vector<ElementQuality> element;
  std::vector<ShapeQuality> shapes;  ///< those that occur
  std::vector<int> worst;            ///< the elements of least scaled Jacobian, worst first
};

/// @param worst  how many elements to name
/// @throws InputError if an element names a node that does not exist
MeshQuality measureQuality(const SolidMesh& mesh, std::size_t worst = 5);
/// A table with one line per shape, histograms, and the worst elements.
void print(std::ostream& out, const MeshQuality& quality);

/// How elements hang together; faces are told apart by their corners.
struct MeshTopology {
  std::vector<int> piece;                       ///< of each element: elements that share a face are of one piece
  std::vector<int> firstElement;                ///< of each piece
  std::vector<std::pair<int, int>> duplicates;  ///< elements with the same nodes: the first one and a later one
  std::vector<Face> crowdedFaces;               ///< faces of three or more elements
  std::vector<Face> mismatchedFaces;            ///< faces of two elements that have other mid nodes
  std::vector<int> unusedNodes;
};
MeshTopology analyseTopology(const SolidMesh& mesh);

/// @throws InputError naming an element of each piece (up to ten) if there is more than one
void requireConnected(const SolidMesh& mesh);
/// @throws InputError if elements are duplicates of others, faces belong to three or more elements, neighbours have
/// different mid nodes, or a node belongs to no element, naming up to ten of the first kind found
void requireConforming(const SolidMesh& mesh);

}  // namespace dovetail::fem
