// Frames of disc cells, and what is asked of the fluctuations along them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/lattice.hpp"

namespace dovetail::rve {

struct Rve;

/// Spaces of fluctuations w along a frame, x = F X + w, each within the next: none; the same on opposite sides; none on
/// the mean, Σ w_q ⊗ A_q = 0. Turns of frame grains: none, the same, free. Reactions are the multipliers: any; opposite
/// on opposite sides; a constant tensor times A_q. Liu, thesis TU Eindhoven 2018, eqs 2.17–2.22.
enum class Condition { displacement, periodic, traction };

/// What a side asks of fluctuations along F e_x and across that. Turns obey what leaves more.
struct SideCondition {
  Condition along, across;
  constexpr SideCondition(Condition both) : along(both), across(both) {}  // NOLINT: one condition is a condition
  constexpr SideCondition(Condition x, Condition y) : along(x), across(y) {}
};

/// Conditions on the sides of a frame. Grains at a corner obey, component by component, `displacement` if one of the
/// two sides that meet there has it, else `traction` if one has it. Copies of one grain on opposite sides that are
/// `periodic` move alike, at corners too, whatever else they obey. The layer of Liu 2018, eq. 2.43, is {.bottom =
/// displacement, .top = {displacement, traction}, .cornersHeld = true}.
struct Conditions {
  SideCondition bottom = Condition::periodic, right = Condition::periodic, top = Condition::periodic,
                left = Condition::periodic;
  bool cornersHeld = false;  ///< grains at the corners follow F, and turn as their sides let them
};
constexpr Conditions everywhere(SideCondition c) { return {c, c, c, c}; }

/// What conditions leave of one component of the fluctuations: places in Frame::grain.
struct Freedom {
  std::vector<int> held;                   ///< w = 0
  std::vector<std::vector<int>> together;  ///< the same w, of two or more that are not held
  std::vector<std::vector<int>> balanced;  ///< Σ w A = 0 over them; those with the same w are one item
};

/// Grains that hold a framed cell, counter-clockwise; empty where a cell repeats.
struct Frame {
  std::vector<int> grain;
  std::vector<Vec3> place;  ///< X_q at F = 1, m
  std::vector<Vec3> area;   ///< A_q, outward, m²: Σ A_q = 0, Σ X_q ⊗ A_q = V 1 in the plane (Liu 2018, eq. 2.2)
  /// Of fluctuations along F e_x, across that, and of turns.
  std::array<Freedom, 3> freedom;
  bool byComponent = false;  ///< whether along and across differ: the direction of F e_x matters
  /// Places in `grain` of those that are one grain in the cell that repeats.
  std::vector<std::vector<int>> alike;
  /// Of every grain of the cell: which it was where the cell repeats, and which image.
  std::vector<int> original;
  std::vector<geometry::Image> image;

  bool empty() const { return grain.empty(); }
};

/// A disc cell that repeats, cut open: grains that lie on the border are copied to the opposite side (thrice for the
/// one at the corner) and are its frame; the corner is the largest grain for which the frame is a simple polygon. A
/// contact that lies here in several places has its fraction of the stiffness in each, so that V P̄ is that of the cell
/// that repeats. Springs keep their stretch, the state is the new F = 1, fluctuations stop. Conditions are on the rates
/// of fluctuations: what has come to be of them deforms with the cell.
/// @throws InputError for spheres, framed cells, `periodic` on one of two opposite sides alone, or if no corner will do
Rve framed(const Rve& cell, const Conditions& conditions);

/// Reactions on the frame grains, N: the multipliers of the conditions, −f at rest.
std::vector<Vec3> reactions(const Rve& cell);

/// P̄ = (1/V) Σ a_q ⊗ F⁻¹ x_q, Pa, of a framed cell (Liu 2018, eq. 2.23; F⁻¹ x_q is X_q but for fluctuations, which do
/// nothing where along and across are alike), with P̄ Fᵀ made symmetric: the skew part is what the couples do that hold
/// the turns of the frame's grains.
Eigen::Matrix3d stressOfReactions(const Rve& cell);

}  // namespace dovetail::rve
