// Smooth patches that turn as a whole: what keeps points carried by kernels in their place on a body that turns.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/core/quaternion.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/coupling/nodal_load.hpp"

namespace dovetail::surface {

/// How one patch has turned: the rotation R for which Σ a_i |x_i − x̄ − R (X_i − X̄)|² is least, a_i being the nodes'
/// shares of the patch's area.
struct PatchFrame {
  std::vector<int> node;
  std::vector<Vec3> arm;        ///< a D, m; D = X − Σ a X, a the node's share of the area, which sums to one
  std::array<Vec3, 3> moments;  ///< Σ a D Dᵀ by columns, m²
  std::array<Vec3, 2> axis;     ///< unit; the directions in which the patch is largest
  bool slender = false;         ///< more than twice as long as wide

  // As it was placed last.
  Quaternion turn;              ///< R
  Vec3 spin;                    ///< rad/s, of R
  std::array<Vec3, 3> inverse;  ///< rows of K⁻¹, 1/m², K = Σ a [(y·D) 1 − y Dᵀ], y = Rᵀ(x − x̄)
  bool placed = false;
};

/// A kernel without linear correction does not reproduce positions: Σ_i S_vi X_i ≠ X_v near the border of a patch, by a
/// quarter of its width and more. The offset d_v = X_v − Σ_i S_vi X_i is therefore carried along by the patch,
///   x_v = Σ_i S_vi x_i + R d_v,
/// which is exact for every motion of a rigid body. Forces are carried by the transpose of its variation, so moments
/// balance: the couple Σ_v R d_v × f_v goes to all nodes of the patch, a_i R (g × D_i) with K g = Rᵀ couple.
///
/// R is that of the whole patch and not of the kernel's own support: turned by its support a vertex follows its slope,
/// which to first order is the linear correction, with loads that arrive unevenly across a narrow face. With R of the
/// patch an even load stays even. Where a slender patch bends, the turn of the whole is not that of its parts: there
/// coarseGrain has the kernel keep places lengthwise by itself, and offsets across are left.
struct PatchTurns {
  std::vector<Vec3> offset;        ///< d per carried point, m; empty if all are zero
  std::vector<int> patch;          ///< per carried point
  std::vector<PatchFrame> frames;  ///< per patch

  bool empty() const { return offset.empty(); }
  /// Adds what a point moves beyond S u, m, and beyond S v, m/s. Its patch must have been placed.
  void carry(std::size_t point, Vec3& x, Vec3& v) const {
    const PatchFrame& frame = frames[static_cast<std::size_t>(patch[point])];
    const Vec3 turned = rotate(frame.turn, offset[point]);
    x += turned - offset[point];
    v += cross(frame.spin, turned);
  }
};

/// A frame of nodes at X (m) with shares of an area > 0, in any unit.
PatchFrame makeFrame(std::vector<int> node, std::span<const double> area, std::span<const Vec3> X);

/// Places the patches of these points. @throws NumericalError naming a patch that has shrunk to a line
void placeFrames(PatchTurns& turns, std::span<const Vec3> u, std::span<const Vec3> v, std::span<const int> points);

/// Adds to `load` what forces on carried points, N, exert beyond Sᵀ f.
void addTurningLoad(const PatchTurns& turns, const coupling::NodalLoad& onPoints, coupling::NodalLoad& load);

/// A bound on how fast the patch turns over how fast its node k moves, 1/m, as it was placed last.
double turnRate(const PatchFrame& frame, std::size_t k);
/// Bound on how far R d of any point moves over the largest displacement of its patch's nodes.
double turningGain(const PatchTurns& turns);

}  // namespace dovetail::surface
