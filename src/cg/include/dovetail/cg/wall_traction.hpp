// Tractions of particles on walls: contact forces spread over a surface by a kernel.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/cg/fields.hpp"
#include "dovetail/cg/surface_kernel.hpp"

namespace dovetail::cg {

/// Traction on a flat boundary, N/m²: t(x) = Σ −f W(x − x_c) with a kernel normalised on the surface (Cheng et al.
/// 2023, Eqs. 13 and 14): what the particles do to the wall. Its integral over the plane is Σ −f exactly. Near an edge
/// use wallTraction, which normalises on what is there.
/// @param kernel  dimension 2   @param points  points on the boundary, m
/// @param contacts  contact points on the boundary and forces on the particles   @param space  as of sample
/// @throws InputError if the kernel is invalid or not 2-D, spans do not match, or a value is not finite
std::vector<Vec3> surfaceTraction(const Kernel& kernel, std::span<const Vec3> points, const WallForceView& contacts,
                                  const geometry::Periodicity& space = {});

/// Contacts with the facets of a wall (the arrays of dem::WallContacts); the spans have the same length.
struct FacetForceView {
  std::span<const int> facet;
  std::span<const std::array<double, 3>> barycentric;  ///< of the contact point in its facet
  std::span<const Vec3> force;                         ///< of the wall on the particle, N
};

struct VertexTraction {
  std::vector<Vec3> traction;  ///< per vertex, N/m²: what the particles do to the wall; zero where there is no area
  std::vector<double> area;    ///< per vertex, m²: a third of each of its facets
};

/// Traction on a triangulated wall: each contact goes to the vertices with the weights of its kernel
/// (SurfaceKernelRows), and load over area is traction, so Σ area × traction = Σ −f to round-off for every kernel. The
/// moment of these loads is that of the contact forces to round-off for width 0 and with linear correction. Couples
/// that contacts exert beyond their forces are not in it. No traction crosses from patch to patch, but a vertex that
/// patches share has the mean of theirs.
/// @param vertices present positions, m   @param patchOfFacet  see geometry::smoothPatches; one number for all: one
/// patch
/// @throws InputError as surfaceKernelRow, or naming a contact whose force is not finite
VertexTraction wallTraction(const SurfaceKernel& kernel, std::span<const Vec3> vertices,
                            std::span<const std::array<int, 3>> facets, std::span<const int> patchOfFacet,
                            const FacetForceView& contacts);

}  // namespace dovetail::cg
