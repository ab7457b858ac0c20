// The paper's way to put a contact force on nodes: the kernel at the contact point, seen by the solid's own quadrature.
#pragma once

#include <array>
#include <vector>

#include "dovetail/cg/surface_quadrature.hpp"
#include "dovetail/coupling/nodal_load.hpp"
#include "dovetail/surface/skin.hpp"

namespace dovetail::surface {

/// f_i = ∫ t ψ_i dA with the traction t(x) = −f W(x − x_c) (Cheng et al. 2023, Eqs. 14 and 15), 2 × 2 Gauss points a
/// face and the kernel normalised by them; f_i = −f ψ_i(x_c) (Eq. 16) where no point lies within the width.
class SpreadLoad {
public:
  /// @param X      reference positions of all nodes, m
  /// @param skin   before splitAtSharpEdges
  /// @param faces  the faces the skin was made from, of four nodes
  /// @throws InputError for a width that is negative or not finite, or a face of another shape
  SpreadLoad(const cg::SurfaceKernel& kernel, std::span<const Vec3> X, const Skin& skin,
             std::span<const fem::Face> faces);

  /// Adds the reaction to a force `onParticle` (N) whose contact point has the given weights in a facet of the skin.
  void add(const Skin& skin, int facet, const std::array<double, 3>& weight, const Vec3& onParticle,
           coupling::NodalLoad& load);

private:
  cg::SurfaceKernelQuadrature quadrature_;
  std::vector<int> localColumn_, column_;
  std::vector<double> localWeight_, weight_;
};

}  // namespace dovetail::surface
