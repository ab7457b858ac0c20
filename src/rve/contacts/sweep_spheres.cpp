#include <cmath>

#include "contact_list.hpp"
#include "touching_rows.hpp"

namespace dovetail::rve {

namespace {

/// What the law takes and gives, contact by contact.
struct SphereRows {
  Row radiusI, radiusJ, stiffness, tangent;
  Row stretch[3], speed[3], spinI[3], spinJ[3];  // speed of j less i
  Row force[3], couple[3], armI, armJ;           // on i; n × force
  Row slope, slipped;
};

struct SphereLaw {
  double ratio, slipFraction, dt;
  double rate[6];  // of strain: xx, yy, zz, xy, yz, xz
  double spin[3];  // of L
};

/// A spring whose stiffness changes: while that grows, the force stays and the stretch shrinks; while it falls, the
/// stretch stays and the force shrinks. Returns what the stretch shrinks to, in fractions of it.
inline double keptWhileGrowing(double before, double now) { return now > before ? before / now : 1.0; }

template <bool slides, bool elastic>
void applyLaw(const SphereLaw law, const TouchingRows<3>& __restrict at, SphereRows& __restrict r) {
  const int padded = at.padded;
  for (int m = 0; m < padded; ++m) {
    const double bx = at.branch[0][m], by = at.branch[1][m], bz = at.branch[2][m];
    const double d = std::sqrt(at.squared[m]), inverse = 1.0 / d;
    const double nx = bx * inverse, ny = by * inverse, nz = bz * inverse;
    const double overlap = r.radiusI[m] + r.radiusJ[m] - d;
    const double k = elastic ? r.stiffness[m] * std::sqrt(overlap) : r.stiffness[m];
    const double normalForce = elastic ? 2.0 / 3.0 * k * overlap : k * overlap;
    if constexpr (elastic) r.slope[m] = k;
    if constexpr (!slides) {
      r.force[0][m] = -normalForce * nx;
      r.force[1][m] = -normalForce * ny;
      r.force[2][m] = -normalForce * nz;
    } else {
      const double armI = 0.5 * (d + r.radiusI[m] - r.radiusJ[m]), armJ = d - armI;
      const double turnX = armI * r.spinI[0][m] + armJ * r.spinJ[0][m],
                   turnY = armI * r.spinI[1][m] + armJ * r.spinJ[1][m],
                   turnZ = armI * r.spinI[2][m] + armJ * r.spinJ[2][m];
      const double wx =
          r.speed[0][m] + law.rate[0] * bx + law.rate[3] * by + law.rate[5] * bz - (turnY * nz - turnZ * ny);
      const double wy =
          r.speed[1][m] + law.rate[3] * bx + law.rate[1] * by + law.rate[4] * bz - (turnZ * nx - turnX * nz);
      const double wz =
          r.speed[2][m] + law.rate[5] * bx + law.rate[4] * by + law.rate[2] * bz - (turnX * ny - turnY * nx);
      // The spring turns about the normal with the mean spin of both, and tilts with the normal.
      const double twist = law.dt * ((0.5 * (r.spinI[0][m] + r.spinJ[0][m]) + law.spin[0]) * nx +
                                     (0.5 * (r.spinI[1][m] + r.spinJ[1][m]) + law.spin[1]) * ny +
                                     (0.5 * (r.spinI[2][m] + r.spinJ[2][m]) + law.spin[2]) * nz);
      double ux = r.stretch[0][m], uy = r.stretch[1][m], uz = r.stretch[2][m], lost = 0.0;
      if constexpr (elastic) {
        const double before = r.tangent[m], now = law.ratio * k, fraction = keptWhileGrowing(before, now);
        lost = 0.5 * (before - now * fraction * fraction) * (ux * ux + uy * uy + uz * uz);
        ux *= fraction;
        uy *= fraction;
        uz *= fraction;
        r.tangent[m] = now;
      }
      const double sx = ux + twist * (ny * uz - nz * uy) + law.dt * wx,
                   sy = uy + twist * (nz * ux - nx * uz) + law.dt * wy,
                   sz = uz + twist * (nx * uy - ny * ux) + law.dt * wz;
      const double along = sx * nx + sy * ny + sz * nz;
      const double tx = sx - along * nx, ty = sy - along * ny, tz = sz - along * nz;
      const double length = std::sqrt(tx * tx + ty * ty + tz * tz), most = law.slipFraction * overlap;
      const double kept = length > most ? most / length : 1.0;
      const double stiff = law.ratio * k * kept, hx = stiff * tx, hy = stiff * ty, hz = stiff * tz;
      r.slipped[m] = stiff * length * (length - kept * length) + lost;
      r.stretch[0][m] = kept * tx;
      r.stretch[1][m] = kept * ty;
      r.stretch[2][m] = kept * tz;
      r.force[0][m] = hx - normalForce * nx;
      r.force[1][m] = hy - normalForce * ny;
      r.force[2][m] = hz - normalForce * nz;
      r.couple[0][m] = ny * hz - nz * hy;
      r.couple[1][m] = nz * hx - nx * hz;
      r.couple[2][m] = nx * hy - ny * hx;
      r.armI[m] = armI;
      r.armJ[m] = armJ;
    }
  }
}

SphereLaw lawOf(const Springs& springs, double dt, const Eigen::Matrix3d& L) {
  return {springs.tangential,
          (springs.slides() ? slipFractionOf(springs) : 0.0) * (springs.elasticSpheres() ? 2.0 / 3.0 : 1.0),
          dt,
          {L(0, 0), L(1, 1), L(2, 2), 0.5 * (L(0, 1) + L(1, 0)), 0.5 * (L(1, 2) + L(2, 1)), 0.5 * (L(0, 2) + L(2, 0))},
          {0.5 * (L(2, 1) - L(1, 2)), 0.5 * (L(0, 2) - L(2, 0)), 0.5 * (L(1, 0) - L(0, 1))}};
}

}  // namespace

template <bool slides, bool elastic>
void sweepSpheres(Rve& cell, double dt, const Eigen::Matrix3d& L) {
  CellState& s = cell.state;
  const SphereLaw law = lawOf(cell.springs, dt, L);
  const double *v[3], *spin[3], *const radius = cell.radius.data(), *const stiffness = s.contacts.stiffness.data();
  double *force[3], *torque[3], *memory[4];  // stretch, and tangent
  for (std::size_t k = 0; k < 3; ++k) {
    v[k] = s.v[k].data();
    spin[k] = s.spin[k].data();
    force[k] = s.force[k].data();
    torque[k] = s.torque[k].data();
    memory[k] = s.contacts.stretch[k].data();
  }
  memory[3] = s.contacts.tangent.data();
  std::vector<double> slope(elastic ? cell.size() : 0, 0.0);
  ContactSums<3> sums;
  SphereRows r;
  forTouchingBlocks<3>(cell, {memory, slides ? (elastic ? 4u : 3u) : 0u}, [&](const TouchingRows<3>& at) {
    for (int m = 0; m < at.padded; ++m) {
      const int i = at.i[m], j = at.j[m], c = at.contact[m];
      r.radiusI[m] = radius[i];
      r.radiusJ[m] = radius[j];
      r.stiffness[m] = m < at.count ? stiffness[c] : 0.0;
      if constexpr (slides && elastic) r.tangent[m] = m < at.count ? memory[3][c] : 0.0;
      if constexpr (slides)
        for (int k = 0; k < 3; ++k) {
          r.stretch[k][m] = memory[k][c];
          r.speed[k][m] = v[k][j] - v[k][i];
          r.spinI[k][m] = spin[k][i];
          r.spinJ[k][m] = spin[k][j];
        }
    }
    withVectors([&] {
      applyLaw<slides, elastic>(law, at, r);
      sums.add(r.force, at);
      if constexpr (slides) sums.slipped.add(r.slipped, at.padded);
    });
    for (int m = 0; m < at.count; ++m) {
      const int i = at.i[m], j = at.j[m], c = at.contact[m];
      for (int k = 0; k < 3; ++k) {
        const double f = r.force[k][m];
        force[k][i] += f;
        force[k][j] -= f;
        if constexpr (slides) {
          memory[k][c] = r.stretch[k][m];
          torque[k][i] += r.armI[m] * r.couple[k][m];
          torque[k][j] += r.armJ[m] * r.couple[k][m];
        }
      }
      if constexpr (slides && elastic) memory[3][c] = r.tangent[m];
      if constexpr (elastic) {
        slope[at.i[m]] += r.slope[m];
        slope[at.j[m]] += r.slope[m];
      }
    }
  });
  sums.ledger(s);
  if constexpr (elastic) s.criticalStep = criticalStep(cell, slope);
}

template void sweepSpheres<false, false>(Rve&, double, const Eigen::Matrix3d&);
template void sweepSpheres<true, false>(Rve&, double, const Eigen::Matrix3d&);
template void sweepSpheres<false, true>(Rve&, double, const Eigen::Matrix3d&);
template void sweepSpheres<true, true>(Rve&, double, const Eigen::Matrix3d&);

}  // namespace dovetail::rve
