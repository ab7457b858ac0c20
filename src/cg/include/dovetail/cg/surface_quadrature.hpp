// The load of Cheng et al. 2023: the kernel is evaluated only at the quadrature points on the surface of the solid.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "dovetail/cg/projection.hpp"
#include "dovetail/cg/surface_kernel.hpp"

namespace dovetail::cg {

/// Quadrature points of a surface.
struct SurfacePoints {
  std::vector<Vec3> X;         ///< reference positions, m
  std::vector<double> weight;  ///< quadrature weight times area, m², > 0
  std::vector<int> patch;      ///< smooth patch of each point
  Projection shape;            ///< points × nodes: shape functions ψ_i(X_q), rows sum to one
};

/// 2 × 2 Gauss points on bilinear quadrilaterals, as a solid's boundary loads are usually integrated.
/// @param X            reference positions of all nodes, m
/// @param quads        four nodes in order around each face
/// @param patchOfQuad  smooth patch of each face
/// @throws InputError for a node out of range or lengths that do not match
SurfacePoints gaussPointsOnQuads(std::span<const Vec3> X, std::span<const std::array<int, 4>> quads,
                                 std::span<const int> patchOfQuad);

/// Fixed quadrature: P_i = Σ_q w_q W ψ_i(X_q) / Σ_q w_q W over the given points (Cheng et al. 2023, sec. 5.1).
/// Cheap enough for every contact in every step; coarser than surfaceKernelRow, so weights jump when a point enters
/// the support of a narrow kernel. **If no point of the patch lies within the width, the local row is used instead**
/// (which makes width → 0 the local map), and row() says so.
class SurfaceKernelQuadrature {
public:
  /// @throws InputError as requireRowwise, or for points whose arrays do not match
  SurfaceKernelQuadrature(const SurfaceKernel& kernel, SurfacePoints points);
  ~SurfaceKernelQuadrature();
  SurfaceKernelQuadrature(SurfaceKernelQuadrature&&) noexcept;
  SurfaceKernelQuadrature& operator=(SurfaceKernelQuadrature&&) noexcept;

  /// Appends one row, nodes ascending, that sums to one.
  /// @param centre  reference position of the contact, m
  /// @param patch   only points of this patch count
  /// @param localColumn, localWeight  the row of the local map at the centre, nodes ascending (see localRow)
  /// @return false if the local row was used because no point lies within the width
  bool row(const Vec3& centre, int patch, std::span<const int> localColumn, std::span<const double> localWeight,
           std::vector<int>& column, std::vector<double>& weight);

  const SurfacePoints& points() const { return points_; }

private:
  struct Scratch;
  SurfaceKernel kernel_;
  SurfacePoints points_;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace dovetail::cg
