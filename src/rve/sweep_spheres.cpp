#include <cmath>

#include "sweep.hpp"

namespace dovetail::rve {

namespace {

Vec3 at(const Components& field, std::size_t i) { return {field[0][i], field[1][i], field[2][i]}; }
void add(Components& field, std::size_t i, const Vec3& value) {
  field[0][i] += value.x;
  field[1][i] += value.y;
  field[2][i] += value.z;
}

/// The motion of the last step that all grains share.
struct Shared {
  Vec3 rateX, rateY, rateZ;  // rows of sym(L)
  Vec3 spin;                 // of L
  explicit Shared(const Eigen::Matrix3d& L)
      : rateX{L(0, 0), 0.5 * (L(0, 1) + L(1, 0)), 0.5 * (L(0, 2) + L(2, 0))},
        rateY{rateX.y, L(1, 1), 0.5 * (L(1, 2) + L(2, 1))},
        rateZ{rateX.z, rateY.z, L(2, 2)},
        spin{0.5 * (L(2, 1) - L(1, 2)), 0.5 * (L(0, 2) - L(2, 0)), 0.5 * (L(1, 0) - L(0, 1))} {}
  Vec3 strained(const Vec3& b) const { return {dot(rateX, b), dot(rateY, b), dot(rateZ, b)}; }
};

}  // namespace

template <bool slides>
void sweepSpheres(Cell& cell, double dt, const Eigen::Matrix3d& L) {
  CellState& s = cell.state;
  const std::array<Vec3, 27> shift = imageShifts(s.lattice);
  const Shared shared(L);
  const double ratio = cell.springs.tangential, slipShare = slides ? cell.springs.friction / ratio : 0.0;
  const double* const radius = cell.radius.data();
  Contacts& contacts = s.contacts;
  double* const u0 = contacts.stretch[0].data();
  double* const u1 = contacts.stretch[1].data();
  double* const u2 = contacts.stretch[2].data();
  Vec3 dyadX, dyadY, dyadZ;
  double slipped = 0.0;
  const std::size_t n = cell.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 xi = at(s.x, i), vi = at(s.v, i), spinI = at(s.spin, i);
    const double ri = radius[i];
    Vec3 forceI, torqueI;
    for (auto c = static_cast<std::size_t>(contacts.first[i]); c < static_cast<std::size_t>(contacts.first[i + 1]);
         ++c) {
      const auto j = static_cast<std::size_t>(contacts.other[c]);
      const Vec3 b = at(s.x, j) + shift[contacts.image[c]] - xi;
      const double rj = radius[j], reach = ri + rj, squared = squaredNorm(b);
      if (squared >= reach * reach) {
        if constexpr (slides) u0[c] = u1[c] = u2[c] = 0.0;
        continue;
      }
      const double d = std::sqrt(squared), overlap = reach - d, k = contacts.stiffness[c];
      const Vec3 normal = (1.0 / d) * b;
      Vec3 force = (-k * overlap) * normal;
      if constexpr (slides) {
        const double armI = 0.5 * (d + ri - rj), armJ = d - armI;
        const Vec3 spinJ = at(s.spin, j);
        const Vec3 moved = at(s.v, j) - vi + shared.strained(b) - cross(armI * spinI + armJ * spinJ, normal);
        Vec3 u{u0[c], u1[c], u2[c]};
        // The spring turns about the normal with the mean spin of both, and tilts with the normal.
        const double twist = dot(0.5 * (spinI + spinJ) + shared.spin, normal) * dt;
        u += twist * cross(normal, u) + dt * moved;
        u -= dot(u, normal) * normal;
        const double most = slipShare * overlap, length2 = squaredNorm(u);
        if (length2 > most * most) {
          const double length = std::sqrt(length2);
          slipped += ratio * k * most * (length - most);
          u *= most / length;
        }
        u0[c] = u.x;
        u1[c] = u.y;
        u2[c] = u.z;
        const Vec3 hold = (ratio * k) * u, couple = cross(normal, hold);
        force += hold;
        torqueI += armI * couple;
        add(s.torque, j, armJ * couple);
      }
      forceI += force;
      add(s.force, j, -force);
      dyadX += force.x * b;
      dyadY += force.y * b;
      dyadZ += force.z * b;
    }
    add(s.force, i, forceI);
    add(s.torque, i, torqueI);
  }
  s.dyad << dyadX.x, dyadX.y, dyadX.z, dyadY.x, dyadY.y, dyadY.z, dyadZ.x, dyadZ.y, dyadZ.z;
  s.book.friction += slipped;
}

template void sweepSpheres<false>(Cell&, double, const Eigen::Matrix3d&);
template void sweepSpheres<true>(Cell&, double, const Eigen::Matrix3d&);

}  // namespace dovetail::rve
