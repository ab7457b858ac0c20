// Tangent of hybrid8: with the moments m = ∫Pᵀ 2E dV and β = ½ H⁻¹ m, K = ½ (∂m/∂u)ᵀ ∂β/∂u + ∫∂²E/∂u² : Pβ dV.
#pragma once

#include "hybrid_kernels.hpp"

namespace dovetail::fem::detail::bricks {

/// ∂ψ_c/∂ξ_j at Gauss point P, corners in binary order.
template <int P>
constexpr std::array<std::array<double, 3>, 8> cornerGradients() {
  std::array<std::array<double, 3>, 8> gradient{};
  for (std::size_t c = 0; c < 8; ++c)
    for (std::size_t j = 0; j < 3; ++j) {
      gradient[c][j] = 0.125;
      for (std::size_t k = 0; k < 3; ++k) {
        const double sign = c >> k & 1 ? 1.0 : -1.0;
        gradient[c][j] *= j == k ? sign : 1.0 + sign * gaussAt<P>[k];
      }
    }
  return gradient;
}

/// Along the parent axes pushed forward by the Jacobian at the centre (of boxes: the axes of space): gradients of the
/// corners' functions, and F.
struct PointFrame {
  std::array<std::array<Lane, 3>, 8> gradient;
  Tensor F;
};

template <int P>
DOVETAIL_INLINE PointFrame boxFrame(const BoxGeometry& geometry, const PlanarField& H) {
  constexpr auto parent = cornerGradients<P>();
  PointFrame frame;
  for (std::size_t c = 0; c < 8; ++c)
    for (std::size_t j = 0; j < 3; ++j) frame.gradient[c][j] = 8.0 * parent[c][j] * geometry.gradientScale[j];
  frame.F = valueAt<P>(H);
  for (std::size_t i = 0; i < 3; ++i) frame.F[i][i] += 1.0;
  return frame;
}

template <int P>
DOVETAIL_INLINE PointFrame generalFrame(const GeneralGeometry& geometry, const std::array<Lane, 9>& J0,
                                        const PlanarField& parentH) {
  constexpr auto parent = cornerGradients<P>();
  const std::array<Lane, 9>& map = geometry.map[P];
  PointFrame frame;
  for (std::size_t c = 0; c < 8; ++c)
    for (std::size_t j = 0; j < 3; ++j)
      frame.gradient[c][j] = parent[c][0] * map[j] + parent[c][1] * map[3 + j] + parent[c][2] * map[6 + j];
  frame.F = mapped(valueAt<P>(parentH), map);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) frame.F[i][j] += J0[3 * i + j];
  return frame;
}

/// β of a box of unit weight: stiffen() counts modes by their signs.
DOVETAIL_INLINE Coefficients solveBoxModes(const LawConstants& law, const Coefficients& moments) {
  constexpr double once = 1.0 / gaussDistance, twice = once * once;
  constexpr std::array<double, 4> scale = {1.0, once, once, twice};
  const Lane one = {1.0, 1.0, 1.0, 1.0};
  BoxModes sums;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t m = 0; m < 4; ++m) sums.normal[i][m] = scale[m] * moments[4 * i + m];
    for (std::size_t m = 0; m < 2; ++m) sums.shear[i][m] = 0.5 * scale[m] * moments[12 + 2 * i + m];
  }
  const BoxModes stress = stiffen(law, one, sums);
  Coefficients beta;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t m = 0; m < 4; ++m) beta[4 * i + m] = scale[m] * stress.normal[i][m];
    for (std::size_t m = 0; m < 2; ++m) beta[12 + 2 * i + m] = scale[m] * stress.shear[i][m];
  }
  return beta;
}

/// Moments of 2E and their derivatives by the displacement of corner c along k, [3 c + k].
struct MomentRates {
  Coefficients moments{};
  std::array<Coefficients, 24> rate{};
};

template <int P>
DOVETAIL_INLINE void addMomentRates(const PointFrame& frame, const Symmetric& strain, Lane weight, MomentRates& sum) {
  addMoments<P>(strain, weight, sum.moments);
  for (std::size_t c = 0; c < 8; ++c)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto entry = [&](std::size_t i, std::size_t j) __attribute__((always_inline)) {
        return frame.gradient[c][i] * frame.F[k][j] + frame.F[k][i] * frame.gradient[c][j];
      };
      addMoments<P>({entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)}, weight,
                    sum.rate[3 * c + k]);
    }
}

/// Row of corner c, component k, in the order of the element's nodes.
DOVETAIL_INLINE constexpr std::size_t rowOf(std::size_t c, std::size_t k) {
  constexpr std::array<std::size_t, 8> node = {0, 1, 3, 2, 4, 5, 7, 6};
  return 3 * node[c] + k;
}

/// K += ½ rateᵀ ∂β/∂u. @param solve  β of moments
template <class Solve>
DOVETAIL_INLINE void addModeStiffness(const MomentRates& sum, Solve&& solve, Lane scale, Lane* K) {
  for (std::size_t c = 0; c < 24; ++c) {
    const Coefficients beta = solve(sum.rate[c]);
    for (std::size_t r = 0; r <= c; ++r) {
      Lane product{};
      for (std::size_t m = 0; m < 18; ++m) product += sum.rate[r][m] * beta[m];
      product *= 0.5 * scale;
      const std::size_t row = rowOf(r / 3, r % 3), column = rowOf(c / 3, c % 3);
      K[24 * row + column] += product;
      if (r != c) K[24 * column + row] += product;
    }
  }
}

/// K += weight ∂ψ_a/∂X · S · ∂ψ_b/∂X on every component.
DOVETAIL_INLINE void addGeometricStiffness(const PointFrame& frame, const Symmetric& weightedStress, Lane* K) {
  for (std::size_t b = 0; b < 8; ++b) {
    std::array<Lane, 3> t;
    for (std::size_t i = 0; i < 3; ++i)
      t[i] = weightedStress[entryOf[i][0]] * frame.gradient[b][0] +
             weightedStress[entryOf[i][1]] * frame.gradient[b][1] +
             weightedStress[entryOf[i][2]] * frame.gradient[b][2];
    for (std::size_t a = 0; a <= b; ++a) {
      const Lane value = frame.gradient[a][0] * t[0] + frame.gradient[a][1] * t[1] + frame.gradient[a][2] * t[2];
      for (std::size_t k = 0; k < 3; ++k) {
        K[24 * rowOf(a, k) + rowOf(b, k)] += value;
        if (a != b) K[24 * rowOf(b, k) + rowOf(a, k)] += value;
      }
    }
  }
}

DOVETAIL_INLINE void hybridBoxTangent(const LawConstants& law, const BoxGeometry& geometry, const Batch& batch,
                                      const Vec3* u, Lane* K) {
  const Lane one = {1.0, 1.0, 1.0, 1.0};
  PlanarField H;
  planarGradient(batch, u, geometry.gradientScale, H);
  MomentRates sum;
  forEachPoint([&](auto p) __attribute__((always_inline)) {
    constexpr int P = decltype(p)::value;
    addMomentRates<P>(boxFrame<P>(geometry, H), doubleStrain(valueAt<P>(H)), one, sum);
  });
  const Coefficients beta = solveBoxModes(law, sum.moments);
  addModeStiffness(
      sum, [&](const Coefficients& m) { return solveBoxModes(law, m); }, geometry.weight, K);
  forEachPoint([&](auto p) __attribute__((always_inline)) {
    constexpr int P = decltype(p)::value;
    addGeometricStiffness(boxFrame<P>(geometry, H), modeStress<P>(beta, geometry.weight), K);
  });
}

DOVETAIL_INLINE void hybridGeneralTangent(const HybridGeometry& hybrid, const GeneralGeometry& geometry,
                                          const Batch& batch, const Vec3* u, Lane* K) {
  const Lane one = {1.0, 1.0, 1.0, 1.0};
  const std::array<Lane, 9>& J0 = hybrid.centreJacobian;
  PlanarField parentH;
  planarGradient(batch, u, parentScale(), parentH);
  MomentRates sum;
  forEachPoint([&](auto p) __attribute__((always_inline)) {
    constexpr int P = decltype(p)::value;
    const PointFrame frame = generalFrame<P>(geometry, J0, parentH);
    const Tensor H = mapped(valueAt<P>(parentH), geometry.map[P]);
    addMomentRates<P>(frame, parentStrain(H, frame.F, J0), geometry.weight[P], sum);
  });
  const Coefficients beta = solveModes(hybrid, sum.moments);
  addModeStiffness(
      sum, [&](const Coefficients& m) { return solveModes(hybrid, m); }, one, K);
  forEachPoint([&](auto p) __attribute__((always_inline)) {
    constexpr int P = decltype(p)::value;
    addGeometricStiffness(generalFrame<P>(geometry, J0, parentH), modeStress<P>(beta, geometry.weight[P]), K);
  });
}

}  // namespace dovetail::fem::detail::bricks
