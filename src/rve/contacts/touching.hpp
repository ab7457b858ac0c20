// Contacts that touch, one by one, for what is done now and then.
#pragma once

#include <cmath>

#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "dovetail/rve/rve.hpp"
#include "sweep.hpp"

namespace dovetail::rve {

struct Touch {
  std::size_t contact;  ///< in Contacts
  std::size_t i, j;
  Vec3 branch, normal;  ///< b, m, and b/|b|
  double distance;      ///< |b|, m
  double overlap;       ///< m
  double stiffness;     ///< k_n, N/m
  double normalForce;   ///< normal force, N
  Vec3 stretch;         ///< of the tangential spring, m
  double roll;          ///< rad
};

/// Calls visit(touch) for each contact with an overlap that is not bonded, in the order of the list.
template <class Visit>
void forEachTouch(const Rve& cell, const Visit& visit) {
  const CellState& s = cell.state;
  const Contacts& contacts = s.contacts;
  const bool disc = cell.shape == Shape::disc;
  const std::array<Vec3, 27> shift = imageShifts(s.lattice);
  const auto centre = [&](std::size_t i) { return Vec3{s.x[0][i], s.x[1][i], disc ? 0.0 : s.x[2][i]}; };
  for (std::size_t i = 0; i < cell.size(); ++i)
    for (int c = contacts.first[i]; c < contacts.first[i + 1]; ++c) {
      const auto at = static_cast<std::size_t>(c);
      if (!contacts.bond.empty() && contacts.bond[at].length > 0.0) continue;
      const auto j = static_cast<std::size_t>(contacts.other[at]);
      const Vec3 b = centre(j) + shift[contacts.image[at]] - centre(i);
      const double reach = cell.radius[i] + cell.radius[j];
      if (squaredNorm(b) >= reach * reach) continue;
      const double d = norm(b);
      const Vec3 n = b / d;
      const Vec3 u = disc ? contacts.stretch[0][at] * Vec3{-n.y, n.x, 0.0}
                          : Vec3{contacts.stretch[0][at], contacts.stretch[1][at], contacts.stretch[2][at]};
      const double overlap = reach - d, k = slopeAt(cell.springs, contacts.stiffness[at], overlap);
      const double normalForce = (cell.springs.elasticSpheres() ? dem::hertzForce : 1.0) * k * overlap;
      visit(Touch{at, i, j, b, n, d, overlap, k, normalForce, u, contacts.roll.empty() ? 0.0 : contacts.roll[at]});
    }
}

/// Where the tangential spring slips, m.
inline double slipLimit(const Springs& springs, const Touch& touch) {
  return springs.slides() ? springs.friction * touch.normalForce / (springs.tangential * touch.stiffness) : 0.0;
}

/// Whether it is at the limit of friction.
inline bool isSliding(const Springs& springs, const Touch& touch) {
  return springs.slides() && norm(touch.stretch) >= (1.0 - 1e-9) * slipLimit(springs, touch);
}

/// k_r, N m.
inline double rollingStiffness(const Rve& cell, const Touch& touch) {
  return cell.springs.rolls() ? cell.springs.rolling * cell.springs.tangential * touch.stiffness *
                                    cell.radius[touch.i] * cell.radius[touch.j]
                              : 0.0;
}

/// Force on i, N.
inline Vec3 contactForce(const Rve& cell, const Touch& touch) {
  const double tangentialForce = cell.springs.slides() ? cell.springs.tangential * touch.stiffness : 0.0;
  return -touch.normalForce * touch.normal + tangentialForce * touch.stretch;
}

}  // namespace dovetail::rve
