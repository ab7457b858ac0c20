#include <algorithm>
#include <cmath>

#include "sweep.hpp"

namespace dovetail::rve {

template <bool slides, bool rolls>
void sweepDiscs(Cell& cell, double dt, const Eigen::Matrix3d& L) {
  CellState& s = cell.state;
  const std::array<Vec3, 27> shift = imageShifts(s.lattice);
  const double Dxx = L(0, 0), Dyy = L(1, 1), Dxy = 0.5 * (L(0, 1) + L(1, 0));
  const double ratio = cell.springs.tangential;
  // Springs slip where stretched beyond these shares of the overlap (and of the lesser radius).
  const double slipShare = slides ? cell.springs.friction / ratio : 0.0;
  const double rollShare = rolls ? cell.springs.rollingLimit / (ratio * cell.springs.rolling) : 0.0;
  const double* const x = s.x[0].data();
  const double* const y = s.x[1].data();
  const double* const vx = s.v[0].data();
  const double* const vy = s.v[1].data();
  const double* const spin = s.spin[2].data();
  const double* const radius = cell.radius.data();
  double* const fx = s.force[0].data();
  double* const fy = s.force[1].data();
  double* const torque = s.torque[2].data();
  Contacts& contacts = s.contacts;
  const int* const other = contacts.other.data();
  const std::uint8_t* const image = contacts.image.data();
  const double* const stiffness = contacts.stiffness.data();
  double* const stretch = contacts.stretch[0].data();
  double* const roll = rolls ? contacts.roll.data() : nullptr;
  double xx = 0.0, xy = 0.0, yx = 0.0, yy = 0.0, slipped = 0.0;
  const std::size_t n = cell.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double xi = x[i], yi = y[i], ri = radius[i], vxi = vx[i], vyi = vy[i], spinI = spin[i];
    double fxi = 0.0, fyi = 0.0, torqueI = 0.0;
    for (int c = contacts.first[i]; c < contacts.first[i + 1]; ++c) {
      const int j = other[c];
      const Vec3& away = shift[image[c]];
      const double bx = x[j] + away.x - xi, by = y[j] + away.y - yi;
      const double rj = radius[j], reach = ri + rj, squared = bx * bx + by * by;
      if (squared >= reach * reach) {
        if constexpr (slides) stretch[c] = 0.0;
        if constexpr (rolls) roll[c] = 0.0;
        continue;
      }
      const double d = std::sqrt(squared), nx = bx / d, ny = by / d, overlap = reach - d, k = stiffness[c];
      const double press = k * overlap;
      double forceX = -press * nx, forceY = -press * ny;
      if constexpr (slides) {
        const double armI = 0.5 * (d + ri - rj), armJ = d - armI;
        const double wx = vx[j] - vxi + Dxx * bx + Dxy * by, wy = vy[j] - vyi + Dxy * bx + Dyy * by;
        const double tried = stretch[c] + (wy * nx - wx * ny - armI * spinI - armJ * spin[j]) * dt;
        const double most = slipShare * overlap, u = std::clamp(tried, -most, most);
        const double hold = ratio * k * u;
        slipped += hold * (tried - u);
        stretch[c] = u;
        forceX -= hold * ny;
        forceY += hold * nx;
        torqueI += armI * hold;
        torque[j] += armJ * hold;
      }
      if constexpr (rolls) {
        const double stiff = cell.springs.rolling * ratio * k * ri * rj;
        const double tried = roll[c] + (spinI - spin[j]) * dt;
        const double most = rollShare * overlap * std::min(ri, rj) / (ri * rj), turn = std::clamp(tried, -most, most);
        const double moment = stiff * turn;
        slipped += moment * (tried - turn);
        roll[c] = turn;
        torqueI -= moment;
        torque[j] += moment;
      }
      fxi += forceX;
      fyi += forceY;
      fx[j] -= forceX;
      fy[j] -= forceY;
      xx += forceX * bx;
      xy += forceX * by;
      yx += forceY * bx;
      yy += forceY * by;
    }
    fx[i] += fxi;
    fy[i] += fyi;
    torque[i] += torqueI;
  }
  s.dyad << xx, xy, 0.0, yx, yy, 0.0, 0.0, 0.0, 0.0;
  s.book.friction += slipped;
}

template void sweepDiscs<false, false>(Cell&, double, const Eigen::Matrix3d&);
template void sweepDiscs<true, false>(Cell&, double, const Eigen::Matrix3d&);
template void sweepDiscs<false, true>(Cell&, double, const Eigen::Matrix3d&);
template void sweepDiscs<true, true>(Cell&, double, const Eigen::Matrix3d&);

}  // namespace dovetail::rve
