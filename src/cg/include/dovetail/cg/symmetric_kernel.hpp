// Kernel weights on a whole surface that treat every place alike: the symmetric kernel.
#pragma once

#include <array>
#include <span>

#include "dovetail/cg/kernel.hpp"
#include "dovetail/cg/projection.hpp"
#include "dovetail/core/vec3.hpp"

namespace dovetail::cg {

/// The map vertices × nodes of the symmetric kernel
///
///     K(x, x') = g(x) W(|x − x'|) g(x'),   ∫ K(x, x') dA' = 1 for every x,
///
/// on each patch, with one positive field g. Dividing W by its integral over the patch, as KernelCorrection::none does,
/// lets rows sum to one too, but near a rim such a kernel takes more from inside than inside takes from it: evenly
/// spread loads arrive unevenly, and a section under balanced loads is bent. Because K is symmetric, an even traction
/// stays even (Σ_v A_v P_vi = ∫ ψ_i dA), weights stay non-negative, and the widest kernel is the mean over the patch.
/// First moments near a rim are not kept, as without correction.
///
/// On a patch that is a flat rectangle, W is summed over the mirror images of the centre in its sides. Then g is even
/// up to the mesh, and the second moment along one side is the same wherever one stands along the other: a
/// cylindrically bent face stays a cylinder.
///
/// g is found by the fixed point g ← √(g / ∫ W g dA') (scaling of a symmetric matrix to given row sums: Sinkhorn &
/// Knopp, Pacific J. Math. 21, 1967; as a fixed point with the root: Knight, Ruiz & Uçar, SIAM J. Matrix Anal. Appl.
/// 35, 2014). W between two vertices is the root of the product of their rows A_v P_vl and A_l P_lv without correction,
/// so the symmetry is exact on the mesh; A_v is a third of the area of the facets around v.
///
/// @param vertices      reference positions, m
/// @param facets        vertex numbers of each facet
/// @param patchOfFacet  the kernel does not leave a patch
/// @param localMap      vertices × nodes, rows sum to one; the result is K · localMap. Width 0 gives localMap itself
/// @throws InputError for a width that is negative or not finite, sizes that do not match, a vertex that belongs to no
///         facet or has no area, or to facets of several patches (such vertices must be split first)
Projection symmetricKernelMap(const Kernel& kernel, std::span<const Vec3> vertices,
                              std::span<const std::array<int, 3>> facets, std::span<const int> patchOfFacet,
                              const Projection& localMap);

}  // namespace dovetail::cg
