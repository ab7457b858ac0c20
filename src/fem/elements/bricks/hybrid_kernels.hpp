// hybrid8: the stress is β-linear in 18 modes; β = H⁻¹ ∫PᵀE dV makes ½∫S:E dV stationary (Pian & Tong 1986).
#pragma once

#include "elements/kernels/kernels.hpp"
#include "elements/lanes/lane_laws.hpp"

namespace dovetail::fem::detail::bricks {

/// Sums of a field at the Gauss points against 1, s, t, st, where s and t are the signs (bits S and T of the point).
template <int S, int T>
DOVETAIL_INLINE std::array<Lane, 4> faceSums(const std::array<Lane, 8>& e) {
  constexpr std::size_t s = 1u << S, t = 1u << T, r = 7u - s - t;
  const Lane v0 = e[0] + e[r], v1 = e[s] + e[s + r], v2 = e[t] + e[t + r], v3 = e[s + t] + e[7];
  const Lane p = v0 + v1, q = v2 + v3, a = v1 - v0, b = v3 - v2;
  return {p + q, a + b, q - p, b - a};
}

/// Values at the four points of a face from the coefficients of 1, s, t, st.
DOVETAIL_INLINE std::array<Lane, 4> faceExpand(const std::array<Lane, 4>& c) {
  const Lane p = c[0] - c[1], q = c[0] + c[1], a = c[2] - c[3], b = c[2] + c[3];
  return {p - a, q - b, p + a, q + b};
}

/// Sums against 1 and the sign of bit T.
template <int T>
DOVETAIL_INLINE std::array<Lane, 2> lineSums(const std::array<Lane, 8>& e) {
  constexpr std::size_t t = 1u << T, s = T == 0 ? 2u : 1u, r = 7u - s - t;
  const Lane lower = (e[0] + e[s]) + (e[r] + e[s + r]), upper = (e[t] + e[t + s]) + (e[t + r] + e[7]);
  return {upper + lower, upper - lower};
}

/// Strain moments of a batch of boxes and, after `stiffen`, the stress coefficients: normal entries 11 over (η, ζ),
/// 22 over (ξ, ζ), 33 over (ξ, η); shear entries 12 over ζ, 23 over ξ, 31 over η.
struct BoxModes {
  std::array<std::array<Lane, 4>, 3> normal;
  std::array<std::array<Lane, 2>, 3> shear;
};

/// Stress coefficients times the weight of a Gauss point, from the sums of 2E. In a box the modes decouple: constants
/// by Hooke's law, the two normal stresses that share a linear mode by that of plane stress, the rest one by one.
DOVETAIL_INLINE BoxModes stiffen(const LawConstants& law, Lane weight, const BoxModes& sums) {
  const Lane w = 0.125 * weight;
  const Lane mu = law.mu * w, plane = law.halfPlane * w, young = law.halfYoung * w;
  const auto& n = sums.normal;
  const Lane pressure = law.halfLambda * w * (n[0][0] + n[1][0] + n[2][0]);
  const auto pair = [&](Lane a, Lane b) __attribute__((always_inline)) { return plane * (a + law.poisson * b); };
  BoxModes stress;
  stress.normal[0] = {pressure + mu * n[0][0], pair(n[0][1], n[2][2]), pair(n[0][2], n[1][2]), young * n[0][3]};
  stress.normal[1] = {pressure + mu * n[1][0], pair(n[1][1], n[2][1]), pair(n[1][2], n[0][2]), young * n[1][3]};
  stress.normal[2] = {pressure + mu * n[2][0], pair(n[2][1], n[1][1]), pair(n[2][2], n[0][1]), young * n[2][3]};
  for (std::size_t i = 0; i < 3; ++i) stress.shear[i] = {mu * sums.shear[i][0], mu * sums.shear[i][1]};
  return stress;
}

/// Σ over the Gauss points of weight S : 2E.
DOVETAIL_INLINE Lane modeEnergy(const BoxModes& stress, const BoxModes& sums) {
  Lane normal{}, shear{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t m = 0; m < 4; ++m) normal += stress.normal[i][m] * sums.normal[i][m];
    for (std::size_t m = 0; m < 2; ++m) shear += stress.shear[i][m] * sums.shear[i][m];
  }
  return normal + 2.0 * shear;
}

using StrainField = std::array<std::array<Lane, 8>, 6>;

DOVETAIL_INLINE BoxModes boxSums(const StrainField& e) {
  return {{faceSums<1, 2>(e[0]), faceSums<0, 2>(e[1]), faceSums<0, 1>(e[2])},
          {lineSums<2>(e[3]), lineSums<0>(e[4]), lineSums<1>(e[5])}};
}

DOVETAIL_INLINE void hybridBoxForces(const LawConstants& law, const BoxGeometry& geometry, const Batch& batch,
                                     const Vec3* u, bool withEnergy, BatchForces& forces) {
  PlanarField gradient;
  planarGradient(batch, u, geometry.gradientScale, gradient);
  StrainField strain;
  forEachPoint([&](auto p) __attribute__((always_inline)) {
    const Symmetric e = doubleStrain(valueAt<decltype(p)::value>(gradient));
    for (std::size_t i = 0; i < 6; ++i) strain[i][p] = e[i];
  });
  const BoxModes sums = boxSums(strain);
  const BoxModes stress = stiffen(law, geometry.weight, sums);
  if (withEnergy) forces.energy = 0.25 * modeEnergy(stress, sums);

  std::array<std::array<Lane, 4>, 3> normal;
  std::array<std::array<Lane, 2>, 3> shear;
  for (std::size_t i = 0; i < 3; ++i) {
    normal[i] = faceExpand(stress.normal[i]);
    shear[i] = {stress.shear[i][0] - stress.shear[i][1], stress.shear[i][0] + stress.shear[i][1]};
  }
  PlanarField total{};
  forEachPoint([&](auto point) __attribute__((always_inline)) {
    constexpr int p = decltype(point)::value;
    const Tensor H = valueAt<p>(gradient);
    const Symmetric S = {normal[0][inFace<p>[0]], normal[1][inFace<p>[1]], normal[2][inFace<p>[2]],
                         shear[0][p >> 2 & 1],    shear[1][p & 1],         shear[2][p >> 1 & 1]};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<Lane, 3> row = firstStressRow(H[i], i, S);
      for (std::size_t j = 0; j < 3; ++j) total[i][j][inFace<p>[j]] += row[j];
    }
  });
  planarForces(total, geometry.gradientScale, forces);
}

/// 2 J0ᵀ E J0 from Ĥ = ∂u/∂X · J0 and F̂ = J0 + Ĥ: ĤᵀJ0 + F̂ᵀĤ.
DOVETAIL_INLINE Symmetric parentStrain(const Tensor& H, const Tensor& F, const std::array<Lane, 9>& J0) {
  const auto entry = [&](std::size_t i, std::size_t j) __attribute__((always_inline)) {
    return H[0][i] * J0[j] + H[1][i] * J0[3 + j] + H[2][i] * J0[6 + j] + F[0][i] * H[0][j] + F[1][i] * H[1][j] +
           F[2][i] * H[2][j];
  };
  return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)};
}

/// Signs and Gauss distance as the modes see them at point P.
template <int P>
inline constexpr std::array<double, 3> gaussAt = {P & 1 ? gaussDistance : -gaussDistance,
                                                  P & 2 ? gaussDistance : -gaussDistance,
                                                  P & 4 ? gaussDistance : -gaussDistance};

/// First other coordinate and second other coordinate of the modes of 11, 22, 33; the coordinate of 12, 23, 31.
inline constexpr std::array<std::array<std::size_t, 2>, 3> normalAxes = {{{1, 2}, {0, 2}, {0, 1}}};
inline constexpr std::array<std::size_t, 3> shearAxis = {2, 0, 1};

using Coefficients = std::array<Lane, 18>;

/// moments += weight Pᵀ · 2E.
template <int P>
DOVETAIL_INLINE void addMoments(const Symmetric& strain, Lane weight, Coefficients& moments) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double s = gaussAt<P>[normalAxes[i][0]], t = gaussAt<P>[normalAxes[i][1]];
    const Lane e = weight * strain[i];
    moments[4 * i] += e;
    moments[4 * i + 1] += s * e;
    moments[4 * i + 2] += t * e;
    moments[4 * i + 3] += s * t * e;
    const Lane g = 2.0 * weight * strain[3 + i];
    moments[12 + 2 * i] += g;
    moments[13 + 2 * i] += gaussAt<P>[shearAxis[i]] * g;
  }
}

/// weight · P β.
template <int P>
DOVETAIL_INLINE Symmetric modeStress(const Coefficients& b, Lane weight) {
  Symmetric S;
  for (std::size_t i = 0; i < 3; ++i) {
    const double s = gaussAt<P>[normalAxes[i][0]], t = gaussAt<P>[normalAxes[i][1]];
    S[i] = weight * (b[4 * i] + s * b[4 * i + 1] + t * b[4 * i + 2] + s * t * b[4 * i + 3]);
    S[3 + i] = weight * (b[12 + 2 * i] + gaussAt<P>[shearAxis[i]] * b[13 + 2 * i]);
  }
  return S;
}

/// β = ½ H⁻¹ moments (the moments are those of 2E).
DOVETAIL_INLINE Coefficients solveModes(const HybridGeometry& hybrid, const Coefficients& moments) {
  Coefficients beta{};
  std::size_t place = 0;
  for (std::size_t i = 0; i < 18; ++i) {
    const Lane own = 0.5 * moments[i];
    Lane sum = hybrid.stiffness[place++] * own;
    for (std::size_t j = i + 1; j < 18; ++j, ++place) {
      sum += hybrid.stiffness[place] * (0.5 * moments[j]);
      beta[j] += hybrid.stiffness[place] * own;
    }
    beta[i] += sum;
  }
  return beta;
}

DOVETAIL_INLINE void hybridGeneralForces(const HybridGeometry& hybrid, const GeneralGeometry& geometry,
                                         const Batch& batch, const Vec3* u, bool withEnergy, BatchForces& forces) {
  const std::array<Lane, 9>& J0 = hybrid.centreJacobian;
  PlanarField gradient;
  planarGradient(batch, u, parentScale(), gradient);
  std::array<Tensor, 8> stretch;
  Coefficients moments{};
  forEachPoint([&](auto point) __attribute__((always_inline)) {
    constexpr int p = decltype(point)::value;
    const Tensor H = mapped(valueAt<p>(gradient), geometry.map[p]);
    Tensor& F = stretch[p];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) F[i][j] = J0[3 * i + j] + H[i][j];
    addMoments<p>(parentStrain(H, F, J0), geometry.weight[p], moments);
  });
  const Coefficients beta = solveModes(hybrid, moments);
  if (withEnergy) {
    forces.energy = Lane{};
    for (std::size_t i = 0; i < 18; ++i) forces.energy += 0.25 * beta[i] * moments[i];
  }
  PlanarField total{};
  forEachPoint([&](auto point) __attribute__((always_inline)) {
    constexpr int p = decltype(point)::value;
    const std::array<Lane, 9>& map = geometry.map[p];
    const Symmetric S = modeStress<p>(beta, geometry.weight[p]);
    for (std::size_t i = 0; i < 3; ++i) {
      std::array<Lane, 3> row;
      for (std::size_t j = 0; j < 3; ++j)
        row[j] = stretch[p][i][0] * S[entryOf[0][j]] + stretch[p][i][1] * S[entryOf[1][j]] +
                 stretch[p][i][2] * S[entryOf[2][j]];
      for (std::size_t j = 0; j < 3; ++j)
        total[i][j][inFace<p>[j]] += row[0] * map[3 * j] + row[1] * map[3 * j + 1] + row[2] * map[3 * j + 2];
    }
  });
  planarForces(total, parentScale(), forces);
}

}  // namespace dovetail::fem::detail::bricks
