#include <cmath>
#include <utility>

#include "contact_list.hpp"
#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "touching_rows.hpp"

namespace dovetail::rve {

namespace {

/// What the law takes and gives, contact by contact.
struct SphereRows {
  Row radiusI, radiusJ, stiffness, tangent;
  Row stretch[3], speed[3], spinI[3], spinJ[3];  // speed of j less i
  Row force[3], torqueI[3], torqueJ[3];          // on i; on each
  Row slope, slipped;
};

struct SphereLaw {
  double ratio, friction, dt;
  Vec3 rate[3], turn[3];  // by rows
};

[[gnu::always_inline]] inline Vec3 product(const Vec3 (&rows)[3], const Vec3& a) {
  return {dot(rows[0], a), dot(rows[1], a), dot(rows[2], a)};
}

/// The parts are those of dem's laws; i looks at j, so n points from i to j and the springs pull i along.
template <bool slides, bool elastic>
void applyLaw(const SphereLaw law, const TouchingRows<3>& __restrict at, SphereRows& __restrict r) {
  const int padded = at.padded;
  constexpr double inJoule = 1.0, firstMean = 2.0 / 3.0;  // in place of 1/dt; of Hertz's slope
  for (int m = 0; m < padded; ++m) {
    const Vec3 b = vectorAt(at.branch, m);
    const double d = std::sqrt(at.squared[m]);
    const Vec3 n = (1.0 / d) * b;
    const double overlap = r.radiusI[m] + r.radiusJ[m] - d;
    const double k = elastic ? r.stiffness[m] * std::sqrt(overlap) : r.stiffness[m];
    const double normalForce = (elastic ? dem::hertzForce : 1.0) * k * overlap;
    if constexpr (elastic) r.slope[m] = k;
    if constexpr (!slides) {
      setVector(r.force, m, -normalForce * n);
    } else {
      const double armI = 0.5 * (d + r.radiusI[m] - r.radiusJ[m]), armJ = d - armI;
      const Vec3 spinI = vectorAt(r.spinI, m), spinJ = vectorAt(r.spinJ, m);
      const Vec3 w = vectorAt(r.speed, m) + product(law.rate, b) - cross(armI * spinI + armJ * spinJ, n);
      const double twist = law.dt * dot(0.5 * (spinI + spinJ), n);
      const Vec3 old = dem::carried(product(law.turn, vectorAt(r.stretch, m)), n, twist), slip = w - dot(w, n) * n;
      const double kt = law.ratio * k, limit = law.friction * normalForce;
      const dem::Slider<false> now =
          elastic ? dem::slideGrowing<false>(old, r.tangent[m], law.dt * slip, slip, kt, firstMean, 0.0, limit, inJoule)
                  : dem::Slider<false>(old, kt * old, law.dt * slip, slip, kt, 0.0, limit, inJoule);
      if constexpr (elastic) r.tangent[m] = kt;
      r.slipped[m] = now.slipPower;
      setVector(r.stretch, m, now.stretch);
      setVector(r.force, m, now.force - normalForce * n);
      const Vec3 couple = cross(n, now.force);
      setVector(r.torqueI, m, armI * couple);
      setVector(r.torqueJ, m, armJ * couple);
    }
  }
}

SphereLaw lawOf(const Springs& springs, double dt, const MeanMotion& motion) {
  SphereLaw law{springs.tangential, springs.friction, dt, {}, {}};
  for (int k = 0; k < 3; ++k) {
    law.rate[k] = {motion.rate(k, 0), motion.rate(k, 1), motion.rate(k, 2)};
    law.turn[k] = {motion.turn(k, 0), motion.turn(k, 1), motion.turn(k, 2)};
  }
  return law;
}

}  // namespace

template <bool slides, bool elastic>
void sweepSpheres(Rve& cell, double dt, const MeanMotion& motion) {
  CellState& s = cell.state;
  const SphereLaw law = lawOf(cell.springs, dt, motion);
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
  const double ended =
      forTouchingBlocks<3>(cell, {memory, slides ? (elastic ? 4u : 3u) : 0u}, [&](const TouchingRows<3>& at) {
        const auto take = [&](int m) {
          const int i = at.i[m], j = at.j[m], c = at.contact[m];
          r.radiusI[m] = radius[i];
          r.radiusJ[m] = radius[j];
          r.stiffness[m] = stiffness[c];
          if constexpr (slides && elastic) r.tangent[m] = memory[3][c];
          if constexpr (slides)
            for (int k = 0; k < 3; ++k) {
              r.stretch[k][m] = memory[k][c];
              r.speed[k][m] = v[k][j] - v[k][i];
              r.spinI[k][m] = spin[k][i];
              r.spinJ[k][m] = spin[k][j];
            }
        };
        for (int m = 0; m < at.count; ++m) take(m);
        for (int m = at.count; m < at.padded; ++m) {
          take(m);
          r.stiffness[m] = r.tangent[m] = 0.0;
        }
        withVectors([&] {
          applyLaw<slides, elastic>(law, at, r);
          sums.add(r.force, at);
          if constexpr (slides) sums.slipped.add(r.slipped, static_cast<std::size_t>(at.padded));
        });
        for (int m = 0; m < at.count; ++m) {
          const int i = at.i[m], j = at.j[m], c = at.contact[m];
          for (int k = 0; k < 3; ++k) {
            const double f = r.force[k][m];
            force[k][i] += f;
            force[k][j] -= f;
            if constexpr (slides) {
              memory[k][c] = r.stretch[k][m];
              torque[k][i] += r.torqueI[k][m];
              torque[k][j] += r.torqueJ[k][m];
            }
          }
          if constexpr (slides && elastic) memory[3][c] = r.tangent[m];
          if constexpr (elastic) {
            slope[at.i[m]] += r.slope[m];
            slope[at.j[m]] += r.slope[m];
          }
        }
      });
  sums.ledger(s, ended);
  if constexpr (elastic) s.criticalStep = criticalStep(cell, std::move(slope));
}

template void sweepSpheres<false, false>(Rve&, double, const MeanMotion&);
template void sweepSpheres<true, false>(Rve&, double, const MeanMotion&);
template void sweepSpheres<false, true>(Rve&, double, const MeanMotion&);
template void sweepSpheres<true, true>(Rve&, double, const MeanMotion&);

}  // namespace dovetail::rve
