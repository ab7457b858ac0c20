#include <cmath>

#include "touching_rows.hpp"

namespace dovetail::rve {

namespace {

/// What the law takes and gives, contact by contact.
struct DiscRows {
  Row radiusI, radiusJ, stiffness, stretch, roll;
  Row speedX, speedY, spinI, spinJ;  // of j less i; of each
  Row force[2], torqueI, torqueJ;    // on i; on each
  Row slipped;
};

struct DiscLaw {
  double ratio, slipFraction, rolling, rollFraction;
  double dt, xx, xy, yy;  // step, and rates of strain
};

inline double within(double value, double most) {
  const double below = value < most ? value : most;
  return below > -most ? below : -most;
}

template <bool slides, bool rolls>
void applyLaw(const DiscLaw law, const TouchingRows<2>& __restrict at, DiscRows& __restrict r) {
  const int padded = at.padded;
  for (int m = 0; m < padded; ++m) {
    const double bx = at.branch[0][m], by = at.branch[1][m];
    const double d = std::sqrt(at.squared[m]), inverse = 1.0 / d, nx = bx * inverse, ny = by * inverse;
    const double overlap = r.radiusI[m] + r.radiusJ[m] - d, k = r.stiffness[m], normalForce = k * overlap;
    double tangentialForce = 0.0, moment = 0.0, slipped = 0.0;
    const double armI = 0.5 * (d + r.radiusI[m] - r.radiusJ[m]), armJ = d - armI;
    if constexpr (slides) {
      const double wx = r.speedX[m] + law.xx * bx + law.xy * by, wy = r.speedY[m] + law.xy * bx + law.yy * by;
      const double tried = r.stretch[m] + (wy * nx - wx * ny - armI * r.spinI[m] - armJ * r.spinJ[m]) * law.dt;
      const double u = within(tried, law.slipFraction * overlap);
      tangentialForce = law.ratio * k * u;
      slipped = tangentialForce * (tried - u);
      r.stretch[m] = u;
    }
    if constexpr (rolls) {
      const double product = r.radiusI[m] * r.radiusJ[m];
      const double least = r.radiusI[m] < r.radiusJ[m] ? r.radiusI[m] : r.radiusJ[m];
      const double tried = r.roll[m] + (r.spinI[m] - r.spinJ[m]) * law.dt;
      const double turn = within(tried, law.rollFraction * overlap * least / product);
      moment = law.rolling * law.ratio * k * product * turn;
      slipped += moment * (tried - turn);
      r.roll[m] = turn;
    }
    r.force[0][m] = -normalForce * nx - tangentialForce * ny;
    r.force[1][m] = -normalForce * ny + tangentialForce * nx;
    r.torqueI[m] = armI * tangentialForce - moment;
    r.torqueJ[m] = armJ * tangentialForce + moment;
    r.slipped[m] = slipped;
  }
}

}  // namespace

template <bool slides, bool rolls>
void sweepDiscs(Rve& cell, double dt, const Eigen::Matrix3d& L) {
  CellState& s = cell.state;
  const Springs& springs = cell.springs;
  const DiscLaw law{springs.tangential,
                    slides ? slipFractionOf(springs) : 0.0,
                    springs.rolling,
                    rolls ? springs.rollingLimit / (springs.tangential * springs.rolling) : 0.0,
                    dt,
                    L(0, 0),
                    0.5 * (L(0, 1) + L(1, 0)),
                    L(1, 1)};
  const double* const vx = s.v[0].data();
  const double* const vy = s.v[1].data();
  const double* const spin = s.spin[2].data();
  const double* const radius = cell.radius.data();
  double* const fx = s.force[0].data();
  double* const fy = s.force[1].data();
  double* const torque = s.torque[2].data();
  const double* const stiffness = s.contacts.stiffness.data();
  double* const stretch = s.contacts.stretch[0].data();
  double* const roll = s.contacts.roll.data();
  double* const memory[] = {stretch, roll};
  ContactSums<2> sums;
  DiscRows r;
  forTouchingBlocks<2>(cell, {memory, rolls ? 2u : (slides ? 1u : 0u)}, [&](const TouchingRows<2>& at) {
    for (int m = 0; m < at.padded; ++m) {
      const int i = at.i[m], j = at.j[m], c = at.contact[m];
      r.radiusI[m] = radius[i];
      r.radiusJ[m] = radius[j];
      r.stiffness[m] = m < at.count ? stiffness[c] : 0.0;
      if constexpr (slides) {
        r.stretch[m] = stretch[c];
        r.speedX[m] = vx[j] - vx[i];
        r.speedY[m] = vy[j] - vy[i];
      }
      if constexpr (slides || rolls) {
        r.spinI[m] = spin[i];
        r.spinJ[m] = spin[j];
      }
      if constexpr (rolls) r.roll[m] = roll[c];
    }
    withVectors([&] {
      applyLaw<slides, rolls>(law, at, r);
      sums.add(r.force, at);
      if constexpr (slides || rolls) sums.slipped.add(r.slipped, at.padded);
    });
    for (int m = 0; m < at.count; ++m) {
      const int i = at.i[m], j = at.j[m], c = at.contact[m];
      fx[i] += r.force[0][m];
      fy[i] += r.force[1][m];
      fx[j] -= r.force[0][m];
      fy[j] -= r.force[1][m];
      if constexpr (slides) stretch[c] = r.stretch[m];
      if constexpr (rolls) roll[c] = r.roll[m];
      if constexpr (slides || rolls) {
        torque[i] += r.torqueI[m];
        torque[j] += r.torqueJ[m];
      }
    }
  });
  sums.ledger(s);
}

template void sweepDiscs<false, false>(Rve&, double, const Eigen::Matrix3d&);
template void sweepDiscs<true, false>(Rve&, double, const Eigen::Matrix3d&);
template void sweepDiscs<false, true>(Rve&, double, const Eigen::Matrix3d&);
template void sweepDiscs<true, true>(Rve&, double, const Eigen::Matrix3d&);

}  // namespace dovetail::rve
