// The skin: the boundary of a mesh as a moving triangulated wall that particles can touch.
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "dovetail/cg/projection.hpp"
#include "dovetail/cg/surface_kernel.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/dem/walls/wall.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"
#include "dovetail/surface/patch_offsets.hpp"

namespace dovetail::surface {

/// Edges whose facet normals differ by more than this are sharp: no kernel crosses them.
inline constexpr double defaultSharpAngle = std::numbers::pi / 3.0;

/// How a face of four nodes becomes triangles: two, or four that meet at the mean of its corners (paper, sec. 5.1).
/// Faces of three nodes are one, those of six are four between corners and mid-edge nodes, those of eight and nine are
/// eight around their middle.
enum class QuadSplit { two, four };

/// The triangulated boundary of a mesh and the linear map that ties it to the mesh nodes.
///
/// Every vertex v moves as x_v = X_v + Σ_i S_vi u_i, where the rows of S (`carrier`) sum to one; where a kernel does
/// not reproduce positions, what it is off by goes with the patch (PatchOffsets). The transpose carries vertex forces
/// to nodes: f_i = Σ_v S_vi f_v. Because one map serves both ways, the pair is adjoint: the power that the particles
/// spend on the skin is the power the nodes receive, for any kernel width, and moments balance at any turn. The skin of
/// a closed face set is a closed wall, pushes outwards only, and stays one: where kernels of two smooth patches meet at
/// a sharp edge, each patch has its own vertices there (splitAtSharpEdges), because each has its own weights, and
/// wall.corner says which of them are one corner.
struct Skin {
  dem::TriangulatedWall wall;     ///< present positions, m, and velocities, m/s; facets counter-clockwise from outside
  std::vector<Vec3> X;            ///< reference position per vertex, m
  std::vector<fem::Face> faces;   ///< by skin vertex
  std::vector<int> patchOfFacet;  ///< smooth patch per facet
  std::vector<int> facetFace;     ///< face from which a facet was cut
  cg::Projection localMap;        ///< vertices × nodes: interpolation on the face
  cg::Projection carrier;         ///< vertices × nodes: the map in use (localMap unless coarse-grained)
  PatchOffsets offsets;           ///< of the vertices; empty where the carrier reproduces positions
};

/// Cuts boundary faces of a mesh, of any shape, into triangles. Rows of `localMap` are the shape functions of the face
/// at the vertex: of one node, or of several in the middle of faces of four and eight nodes. Contacts with curved faces
/// are contacts with these triangles.
/// @param X      reference positions of all mesh nodes, m
/// @param faces  node numbers, counter-clockwise seen from outside; entries beyond those of the shape are ignored
/// @throws InputError for no faces, a node number out of range, a face without area or with a repeated node, or a line
///         of a plane mesh (named), or a sharp angle outside of (0, π]
Skin makeSkin(std::span<const Vec3> X, std::span<const fem::Face> faces, QuadSplit split = QuadSplit::four,
              double sharpAngle = defaultSharpAngle);

/// Lines of a plane mesh as strips of its thickness, in equal parts on both sides of its plane, that do not move along
/// z: particles in that plane touch them as they do a skin, which lines all around a solid close. Two strips for a line
/// of three nodes.
/// @param lines      run around the solid counter-clockwise seen from +z  @param thickness  m
/// @throws InputError as makeSkin does, for other faces than lines, or a thickness that is not positive
Skin makeStrips(std::span<const Vec3> X, std::span<const fem::Face> lines, double thickness,
                double sharpAngle = defaultSharpAngle);

/// Gives every smooth patch its own copies of the vertices on sharp edges.
void splitAtSharpEdges(Skin& skin);

/// The faces from number `first` to before `end` of a skin, as they are carried there: parts of a surface with one
/// kernel. An open sheet.
Skin partOf(const Skin& skin, std::size_t first, std::size_t end);

/// Several skins on the same nodes as one, facets behind one another: vertices that move alike are one, and where
/// kernels of different skins end at an edge that they share, wall.corner says so. Closed if all are, or all together.
/// @throws InputError naming two that have a face in common
Skin joined(std::span<const Skin* const> skins);

/// Replaces the carrier by kernel weights: S_vi = Σ_q w_q W(|X_q − X_v|) ψ_i(X_q) / Σ_q w_q W (paper, Eqs. 14 and 15,
/// with the kernel at the skin's vertices on the reference surface), after splitAtSharpEdges. Width 0 gives the local
/// map and splits nothing. Rows sum to one; with linear correction Σ_i S_vi X_i = X_v as well, so that no offset need
/// go with the patch, and with the symmetric one even tractions stay even (cg/symmetric_kernel.hpp). On patches that
/// are more than twice as long as wide, rows without linear correction get the factor 1 + β_v (s_i − s̄_v) of the
/// lengthwise coordinate s that restores their first moment along it; their fractions across stay what they were.
/// @throws InputError for a width that is negative or not finite, before the skin is changed
void coarseGrain(Skin& skin, const cg::SurfaceKernel& kernel);

/// The kernel for contact laws that include the compliance of a half-space (such as Hertz's) on a body that bends. With
/// forces on single nodes (width 0) the mesh adds a local compliance that grows with refinement, so impacts on slender
/// bodies get softer with every refinement. The width is twice the body's volume over its surface: the height of a
/// plate, half the height of a square bar, a third of a cube's edge; the remaining compliance is that of the section,
/// which a half-space lacks, and does not depend on the mesh. Lucy's shape, symmetric.
/// @throws InputError if the mesh has no boundary, or no volume
cg::SurfaceKernel advisedKernel(const fem::SolidMesh& mesh);

/// Whether a skin is as long as a period along its axis: it continues across the periodic boundary, where kernels end.
bool meetsPeriod(const Skin& skin, const geometry::Periodicity& periodicity);
/// Whether it has another map than the local one.
bool hasKernel(const Skin& skin);

/// Moves the given vertices: wall.x = X + S u, wall.v = S v, and what goes with the patch.
void place(Skin& skin, std::span<const Vec3> u, std::span<const Vec3> v, std::span<const int> vertices);
/// Moves all vertices.
void place(Skin& skin, std::span<const Vec3> u, std::span<const Vec3> v);

/// Largest row sum of |S|, and what offsets that go with patches add: no carried point moves faster than this times the
/// fastest node.
double carrierGain(const cg::Projection& carrier, const PatchOffsets& offsets);

}  // namespace dovetail::surface
