#include <cmath>

#include "dovetail/dem/laws/slider.hpp"
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
  double ratio, friction, rolling, rollingLimit;
  double dt, xx, xy, yy;  // step, and rates of strain
};

/// The parts are those of dem's laws, along one line and about one axis.
template <bool slides, bool rolls>
void applyLaw(const DiscLaw law, const TouchingRows<2>& __restrict at, DiscRows& __restrict r) {
  const int padded = at.padded;
  constexpr double inJoule = 1.0;  // in place of 1/dt
  for (int m = 0; m < padded; ++m) {
    const double bx = at.branch[0][m], by = at.branch[1][m];
    const double d = std::sqrt(at.squared[m]), inverse = 1.0 / d, nx = bx * inverse, ny = by * inverse;
    const double overlap = r.radiusI[m] + r.radiusJ[m] - d, k = r.stiffness[m], normalForce = k * overlap;
    double tangentialForce = 0.0, moment = 0.0, slipped = 0.0;
    const double armI = 0.5 * (d + r.radiusI[m] - r.radiusJ[m]), armJ = d - armI;
    if constexpr (slides) {
      const double wx = r.speedX[m] + law.xx * bx + law.xy * by, wy = r.speedY[m] + law.xy * bx + law.yy * by;
      const double kt = law.ratio * k, slip = wy * nx - wx * ny - armI * r.spinI[m] - armJ * r.spinJ[m];
      const dem::Slider<false, double> now(r.stretch[m], kt * r.stretch[m], law.dt * slip, slip, kt, 0.0,
                                           law.friction * normalForce, inJoule);
      tangentialForce = now.force;
      slipped = now.slipPower;
      r.stretch[m] = now.stretch;
    }
    if constexpr (rolls) {
      const double least = r.radiusI[m] < r.radiusJ[m] ? r.radiusI[m] : r.radiusJ[m];
      const double kr = law.rolling * law.ratio * k * r.radiusI[m] * r.radiusJ[m];
      const double spin = r.spinI[m] - r.spinJ[m];
      const dem::Slider<false, double> now(r.roll[m], kr * r.roll[m], law.dt * spin, spin, kr, 0.0,
                                           law.rollingLimit * least * normalForce, inJoule);
      moment = now.force;
      slipped += now.slipPower;
      r.roll[m] = now.stretch;
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
void sweepDiscs(Rve& cell, double dt, const MeanMotion& motion) {
  CellState& s = cell.state;
  const Springs& springs = cell.springs;
  const Eigen::Matrix3d& D = motion.rate;
  const DiscLaw law{
      springs.tangential, springs.friction, springs.rolling, springs.rollingLimit, dt, D(0, 0), D(0, 1), D(1, 1)};
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
  const double ended =
      forTouchingBlocks<2>(cell, {memory, rolls ? 2u : (slides ? 1u : 0u)}, [&](const TouchingRows<2>& at) {
        const auto take = [&](int m) {
          const int i = at.i[m], j = at.j[m], c = at.contact[m];
          r.radiusI[m] = radius[i];
          r.radiusJ[m] = radius[j];
          r.stiffness[m] = stiffness[c];
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
        };
        for (int m = 0; m < at.count; ++m) take(m);
        for (int m = at.count; m < at.padded; ++m) {
          take(m);
          r.stiffness[m] = 0.0;
        }
        withVectors([&] {
          applyLaw<slides, rolls>(law, at, r);
          sums.add(r.force, at);
          if constexpr (slides || rolls) sums.slipped.add(r.slipped, static_cast<std::size_t>(at.padded));
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
  sums.ledger(s, ended);
}

template void sweepDiscs<false, false>(Rve&, double, const MeanMotion&);
template void sweepDiscs<true, false>(Rve&, double, const MeanMotion&);
template void sweepDiscs<false, true>(Rve&, double, const MeanMotion&);
template void sweepDiscs<true, true>(Rve&, double, const MeanMotion&);

}  // namespace dovetail::rve
