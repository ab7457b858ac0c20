// Kernel weights on a triangulated surface: what spreads a contact load over the nodes of a solid.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "dovetail/cg/kernel.hpp"
#include "dovetail/cg/projection.hpp"
#include "dovetail/core/vec3.hpp"

namespace dovetail::cg {

enum class KernelCorrection {
  none,      ///< P_i = Σ_q w_q W ψ_i / Σ_q w_q W: non-negative, conserves force
  linear,    ///< W times (1 + β·(X_q − X_c)), so that Σ P_i X_i = X_c: conserves moments too; weights change sign
  symmetric  ///< g(x) W g(x'): uniform tractions stay uniform (see symmetric_kernel.hpp); for whole surfaces only
};

struct SurfaceKernel {
  Kernel kernel;  ///< only shape and width matter, because the quadrature normalises; width 0 is the local map
  KernelCorrection correction = KernelCorrection::none;
};

/// @throws InputError for a kernel whose rows cannot be found one by one: a width that is negative or not finite, or
///         the symmetric correction
void requireRowwise(const SurfaceKernel& kernel);

/// Appends the weights by which a point load at the centre X_c goes to the nodes (Cheng et al. 2023, Eqs. 14 and 15):
///
///     P_i = Σ_q w_q W(|X_q − X_c|) ψ_i(X_q) / Σ_q w_q W(|X_q − X_c|)
///
/// over the facets of the centre's patch. ψ_i interpolates the rows of localMap linearly over a facet. Facets that
/// meet the support are cut in four until they are smaller than width/8 (those outside are dropped on the way) and
/// carry a rule of degree 5, so the cost is bounded for every width and width → 0 tends to the local map, which is
/// returned itself for width 0 and for a support below 1e-12 of the facet, where positions are round-off.
///
/// With linear correction β solves Σ w W (1 + β·d) d = 0, d = X_q − X_c, by the least-norm solution on the directions
/// in which the support is thicker than 1e-5 of its extent (a flat patch has no normal one; on a curved patch the
/// normal moment is met too, by a kernel that changes sign).
/// It presumes that localMap reproduces the vertices from the nodes: vertices = localMap · X_nodes.
///
/// @param vertices      reference positions, m
/// @param facets        vertex numbers of each facet
/// @param patchOfFacet  the kernel reaches only facets with the patch of the centre's facet
/// @param localMap      vertices × nodes, rows sum to one
/// @param facet, barycentric  the centre: facet number and its three weights, which sum to one
/// @param column, weight      one row is appended: nodes ascending, weights that sum to one
/// @throws InputError as requireRowwise, for a facet out of range, sizes that do not match, or barycentric weights that
///         are not finite
void surfaceKernelRow(const SurfaceKernel& kernel, std::span<const Vec3> vertices,
                      std::span<const std::array<int, 3>> facets, std::span<const int> patchOfFacet,
                      const Projection& localMap, int facet, std::array<double, 3> barycentric,
                      std::vector<int>& column, std::vector<double>& weight);

/// Appends Σ_k barycentric_k (row vertex_k of localMap), nodes ascending: the limit of width → 0 (Eq. 16).
void localRow(const Projection& localMap, const std::array<int, 3>& vertex, const std::array<double, 3>& barycentric,
              std::vector<int>& column, std::vector<double>& weight);

/// The same rows, bit for bit, for many centres on one surface: keeps a sorted list of the facets of each patch and
/// its scratch arrays, so that the cost of a row grows with its support and not with the whole surface. The spans and
/// the map given must outlive it. One object per thread.
class SurfaceKernelRows {
public:
  SurfaceKernelRows(const SurfaceKernel& kernel, std::span<const Vec3> vertices,
                    std::span<const std::array<int, 3>> facets, std::span<const int> patchOfFacet,
                    const Projection& localMap);
  ~SurfaceKernelRows();
  SurfaceKernelRows(SurfaceKernelRows&&) noexcept;
  SurfaceKernelRows& operator=(SurfaceKernelRows&&) noexcept;

  void row(int facet, const std::array<double, 3>& barycentric, std::vector<int>& column, std::vector<double>& weight);
  /// The row of the sum of the kernels around the facet's point moved by each of the given offsets, m.
  void row(int facet, const std::array<double, 3>& barycentric, std::span<const Vec3> images, std::vector<int>& column,
           std::vector<double>& weight);

private:
  struct Cache;
  std::unique_ptr<Cache> cache_;
};

}  // namespace dovetail::cg
