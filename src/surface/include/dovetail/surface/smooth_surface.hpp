// A smooth stand-in for the flat facets of a skin: one biquadratic B-spline patch per face.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/cg/projection.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/surface/skin.hpp"

namespace dovetail::surface {

/// Uniform biquadratic B-spline surface whose control points are the corners of the skin's faces; the tangent plane is
/// continuous within a smooth patch. It touches the bilinear faces in their middles, where loads therefore go to the
/// nodes by the face's own shape functions. At the rim of a patch the control net is continued linearly, so that the
/// surface ends on the rim and linear fields are reproduced exactly. It approximates: a node of curvature κ on faces of
/// size h lies off the surface by κ h²/8.
///
/// Positions are linear in the node displacements (x_c = X_c + Σ_i S_ci u_i), so a contact at the closest point
/// s(ξ*) = Σ_c B_c(ξ*) x_c with the energy ½ k ⟨R − |x − s(ξ*)|⟩² has nodal forces Sᵀ (B_c(ξ*) f): one potential.
struct SmoothSurface {
  std::vector<std::array<int, 16>> control;  ///< per face: control point (i, j) at index i + 4 j, i and j = −1 … 2
  std::vector<std::array<int, 4>> across;    ///< per face and edge: the face across it in the same patch, or −1
  cg::Projection carrier;                    ///< control points × nodes
  PatchOffsets offsets;                      ///< of the control points, as those of a skin
  std::vector<Vec3> X, x, v;                 ///< control points: reference and present position, m; velocity, m/s
  bool oneSided = false;                     ///< as dem::TriangulatedWall::oneSided
  int material = 0;                          ///< row of a LawTable
};

/// Smooth patches end at sharp edges, whether or not the skin was split there.
/// @throws InputError naming the face if it has other than four nodes, or if a vertex inside a smooth patch has other
/// than
///         four faces: such meshes need the flat surface; or if two faces have an edge the same way round.
SmoothSurface makeSmoothSurface(const Skin& skin);

/// Moves the given control points: x = X + S u, v = S v, and what goes with their patches.
void place(SmoothSurface& surface, std::span<const Vec3> u, std::span<const Vec3> v, std::span<const int> controls);

/// The point of one face's patch closest to p; parameters in [0, 1]².
struct PatchPoint {
  std::array<double, 2> parameter{};
  std::array<double, 16> weight{};  ///< B-spline weights of the face's control points; sum to one
  Vec3 point;
  std::array<Vec3, 2> tangent;  ///< ∂point/∂parameter, m
  int edge = -1;                ///< edge of the face on which the point lies (0 … 3), −1 inside
  double squaredDistance = 0.0;
  bool found = true;  ///< false: the search has not come to rest

  /// Unit, outward for faces counter-clockwise from outside.
  Vec3 normal() const { return normalized(cross(tangent[0], tangent[1])); }
};
PatchPoint pointOnPatch(const SmoothSurface& surface, int face, std::array<double, 2> parameter);
/// By Newton's method, in steps that never go away from p. Of several closest points the one that lies downhill of
/// `start`.
PatchPoint closestPointOnPatch(const SmoothSurface& surface, int face, const Vec3& p, std::array<double, 2> start);

/// Of a grid of points on the patch the parameters of the one closest to p: where a search may start.
std::array<double, 2> roughlyClosest(const SmoothSurface& surface, int face, const Vec3& p);

/// Whether the distance to p still falls when the foot leaves the face through the edge it lies on.
bool leavesThrough(const PatchPoint& foot, const Vec3& p);

/// An upper bound of Σ_i S_i² / m_i over the surface, 1/kg, where S_i are the weights of a point's nodes: what the mass
/// of the solid contributes to the stiffest contact, ω² = k (1/m_particle + Σ S_i²/m_i). It is the largest value at the
/// Bézier points of the patches (the sum is convex), and so exact at the corners of a rim.
/// @param inverseMass  per node, 1/kg; 0 for a held node
double largestMobility(const SmoothSurface& surface, std::span<const double> inverseMass);

/// Weights of the 16 control points at (ξ, η).
std::array<double, 16> patchWeights(double xi, double eta);

}  // namespace dovetail::surface
