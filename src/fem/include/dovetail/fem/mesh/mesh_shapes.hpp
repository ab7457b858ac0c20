// Structured meshes of bodies that verification cases and first models ask for.
//
// All of them are boxes of cells under a map of the nodes: nodes of second order lie where the map puts them, so that
// curved sides are curved. Element shapes are any unless said otherwise; plane cells make one layer without sets "z-"
// and "z+", and what is given as length along z is their thickness. Lengths in m, angles in rad. Sets are both node and
// face sets.
#pragma once

#include <functional>
#include <span>

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::fem {

/// boxOf with every node moved to map(X); the thickness of plane cells stays.
/// @throws InputError as boxOf and, if the map turns an element inside out or flattens it, as validate
SolidMesh mappedBox(ElementShape shape, std::array<int, 3> cells, Vec3 lower, Vec3 upper,
                    const std::function<Vec3(const Vec3&)>& map);

/// One mesh of several: nodes within `tolerance` of each other become one (the first of them keeps its place), sets of
/// the same name are united, and faces that lie inside afterwards leave their sets. Elements are numbered part after
/// part; consecutive groups of one shape are one group.
/// @throws InputError if the tolerance is not > 0, an element loses a node by it, or parts differ in thickness
SolidMesh joinMeshes(std::span<const SolidMesh> parts, double tolerance);

/// The mesh without the elements whose centre (mean of their corners) lies in a place, and without nodes that have no
/// element then. What is left keeps its order; sets lose what is gone, and are left out if nothing stays. Faces that
/// are bared are the set "hole", with their nodes, and belong to "skin" if there is one.
/// @throws InputError if no element or all of them lie there, or there is a set "hole"
SolidMesh withHole(const SolidMesh& mesh, const std::function<bool(const Vec3& X)>& place);

/// The same mesh of second order with straight edges: tet4 becomes tet10, quad4 quad8, hex8 hex20, or hex27 if
/// `fullBricks`.
/// Elements and corner nodes keep their numbers. Faces of sets get their nodes. A node set gets the nodes between its
/// members: on an edge if both ends belong to it, in a face or brick if all corners do; between nodes of the skin only
/// where the edge or face lies on the skin itself.
/// @throws InputError as validate, and for elements of second order
SolidMesh secondOrder(const SolidMesh& mesh, bool fullBricks = false);

/// A sector of a hollow cylinder about z, from the x axis by `angle` ≤ 2π towards y; a full ring closes on itself.
/// Sets: "inner", "outer", "start" (θ = 0) and "end" (not for a full ring), "z-", "z+", "skin".
/// @param cells  along r, θ and z; the full ring takes 3 or more along θ
/// @throws InputError unless 0 < inner < outer radius, 0 < angle ≤ 2π and length > 0
SolidMesh cylinderSector(ElementShape shape, std::array<int, 3> cells, double innerRadius, double outerRadius,
                         double angle, double length);

/// A round bar along z from z = 0, by a core of n × n cells and four blocks of n × m cells around it (O-grid).
/// Sets: "side", "z-", "z+", "skin".
/// @param cells  n, m and the number along z
/// @throws InputError for tetrahedra (their diagonals do not meet between the blocks), counts < 1, sizes ≤ 0
SolidMesh roundBar(ElementShape shape, std::array<int, 3> cells, double radius, double length);

/// Cook's membrane (Cook 1974), m: corners (0, 0), (0.048, 0.044), (0.048, 0.060), (0, 0.044), of one layer of cells
/// in z. Sets: "clamped" (x = 0), "loaded" (x = 0.048), "y-", "y+", "z-", "z+", "skin"; node set "tip": the upper
/// corner of the loaded edge, in all layers of nodes.
/// @param cells  along x and y
SolidMesh cookMembrane(ElementShape shape, std::array<int, 2> cells, double thickness = 0.001);

/// A beam whose root is the arc of a cylinder (Turek & Hron 2006): the bar of the benchmark by default. Sets:
/// "clamped" (the arc), "x+", "y-", "y+", "z-", "z+", "skin"; node set "tip": the middle of the free end, all layers
/// (empty and left out if there is no node).
struct ArcBeam {
  Vec3 centre = {0.2, 0.2, 0.0};  ///< of the cylinder, m
  double radius = 0.05;           ///< of the cylinder, m
  double height = 0.02;           ///< of the beam, m; its middle line is at the height of the centre
  double end = 0.6;               ///< x of the free end, m
  double thickness = 0.01;        ///< along z, m
  /// ≥ 1: cells grow geometrically along the beam, by this factor from the root to the end.
  double grading = 1.0;
  /// 0 to 0.9: fraction of cosine spacing across, which makes cells smaller at the upper and lower side.
  double sideGrading = 0.0;
};
/// @param cells  along the beam, across it, and along z
/// @throws InputError if the beam is not thinner than the cylinder or ends inside it, or a grading is out of range
SolidMesh arcClampedBeam(ElementShape shape, std::array<int, 3> cells, const ArcBeam& beam = {});

}  // namespace dovetail::fem
