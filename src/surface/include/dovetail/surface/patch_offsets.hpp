// Smooth patches that turn and stretch as a whole: what keeps points carried by kernels in their place on a body that
// deforms.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/coupling/nodal_load.hpp"

namespace dovetail::surface {

/// The mean gradient F of one patch: that for which Σ a_i |x_i − x̄ − F (X_i − X̄)|² is least, a_i being the nodes'
/// fractions of the patch's area. Across a patch that is flat it is not defined, and not needed.
struct PatchFrame {
  std::vector<int> node;
  std::vector<Vec3> arm;      ///< a M^(−½) D, D = X − Σ a X, M = Σ a D Dᵀ; sums to zero
  std::array<Vec3, 3> scale;  ///< M^(−½) by columns, 1/m; nothing across a flat patch
  Vec3 longest;               ///< unit; the direction in which the patch is largest
  bool slender = false;       ///< more than twice as long as wide

  // As it was placed last.
  std::array<Vec3, 3> gradient, rate;  ///< Σ u armᵀ = (F − 1) M^½, m, and its rate, m/s, by columns
  bool placed = false;

  /// M^(−½) d of a length, m: in any direction it counts in sizes of the patch.
  Vec3 scaled(const Vec3& d) const { return d.x * scale[0] + d.y * scale[1] + d.z * scale[2]; }
};

/// A kernel without linear correction does not reproduce positions: Σ_i S_vi X_i ≠ X_v near the border of a patch, by a
/// quarter of its width and more. The offset d_v = X_v − Σ_i S_vi X_i is therefore carried along by the patch,
///   x_v = Σ_i S_vi x_i + F d_v,
/// which is linear in the nodes' motion and exact for every homogeneous F, turns among them. Forces are carried by the
/// transpose, so moments balance: Σ_v f_v d_vᵀ goes to all nodes of the patch, as Σ_v f_v (armᵢ · M^(−½) d_v).
///
/// F is that of the whole patch and not of the kernel's own support: carried by its support a vertex follows its slope,
/// which is the linear correction, with loads that arrive unevenly across a narrow face. With F of the patch an even
/// load stays even. Where a slender patch bends, F of the whole is not that of its parts: there coarseGrain has the
/// kernel keep places lengthwise by itself, and offsets across are left.
struct PatchOffsets {
  std::vector<Vec3> offset;        ///< M^(−½) d per carried point; empty if all are zero
  std::vector<int> patch;          ///< per carried point
  std::vector<PatchFrame> frames;  ///< per patch

  bool empty() const { return offset.empty(); }
  /// Adds what a point moves beyond S u, m, and beyond S v, m/s. Its patch must have been placed.
  void carry(std::size_t point, Vec3& x, Vec3& v) const {
    const PatchFrame& frame = frames[static_cast<std::size_t>(patch[point])];
    const Vec3& d = offset[point];
    x += d.x * frame.gradient[0] + d.y * frame.gradient[1] + d.z * frame.gradient[2];
    v += d.x * frame.rate[0] + d.y * frame.rate[1] + d.z * frame.rate[2];
  }
};

/// A frame of nodes at X (m) with fractions of an area > 0, in any unit.
PatchFrame makeFrame(std::vector<int> node, std::span<const double> area, std::span<const Vec3> X);

/// Places the patches of these points.
void placeFrames(PatchOffsets& offsets, std::span<const Vec3> u, std::span<const Vec3> v, std::span<const int> points);

/// Adds to `load` what forces on carried points, N, exert beyond Sᵀ f.
void addOffsetLoad(const PatchOffsets& offsets, const coupling::NodalLoad& onPoints, coupling::NodalLoad& load);

/// How far the patch's node k moves a point whose offset is as large as the patch, over how far it moves itself.
double armLength(const PatchFrame& frame, std::size_t k);
/// Bound on how far (F − 1) d of any point moves over the largest displacement of its patch's nodes.
double offsetGain(const PatchOffsets& offsets);

}  // namespace dovetail::surface
