#include "kernels.hpp"

#include "lane_laws.hpp"

namespace dovetail::fem::detail {

namespace {

template <Law law>
DOVETAIL_INLINE Symmetric stressOf(const LawConstants& constants, Lane weight, const Symmetric& strain) {
  if constexpr (law == Law::stVenantKirchhoff)
    return kirchhoffStress(constants, weight, strain);
  else
    return deformedMetricStress(constants, weight, strain);
}

template <int P>
DOVETAIL_INLINE Tensor valueAt(const PlanarField& field) {
  Tensor value;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) value[i][j] = field[i][j][inFace<P>[j]];
  return value;
}

template <Law law, bool withEnergy>
DOVETAIL_INLINE void boxForces(const LawConstants& constants, const BoxGeometry& geometry, const Batch& batch, const Vec3* u,
               BatchForces& forces, Lane* energy) {
  PlanarField gradient;
  planarGradient(batch, u, geometry.gradientScale, gradient);
  PlanarField sums{};
  Lane twice{};
  forEachPoint([&](auto point) __attribute__((always_inline)) {
    constexpr int p = decltype(point)::value;
    const Tensor H = valueAt<p>(gradient);
    const Symmetric strain = doubleStrain(H);
    const Symmetric stress = stressOf<law>(constants, geometry.weight, strain);
    if constexpr (withEnergy) twice += contraction(stress, strain);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<Lane, 3> row = firstStressRow(H[i], i, stress);
      for (std::size_t j = 0; j < 3; ++j) sums[i][j][inFace<p>[j]] += row[j];
    }
  });
  planarForces(sums, geometry.gradientScale, forces);
  if constexpr (withEnergy) *energy = 0.25 * twice;
}

/// H = ∂u/∂ξ · map.
DOVETAIL_INLINE Tensor mapped(const Tensor& parent, const std::array<Lane, 9>& map) {
  Tensor H;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      H[i][j] = parent[i][0] * map[j] + parent[i][1] * map[3 + j] + parent[i][2] * map[6 + j];
  return H;
}

template <Law law, bool withEnergy>
DOVETAIL_INLINE void generalForces(const LawConstants& constants, const GeneralGeometry& geometry, const Batch& batch, const Vec3* u,
                   BatchForces& forces, Lane* energy) {
  PlanarField gradient;
  planarGradient(batch, u, parentScale(), gradient);
  PlanarField sums{};
  Lane twice{};
  forEachPoint([&](auto point) __attribute__((always_inline)) {
    constexpr int p = decltype(point)::value;
    const std::array<Lane, 9>& map = geometry.map[p];
    const Tensor H = mapped(valueAt<p>(gradient), map);
    const Symmetric strain = doubleStrain(H);
    const Symmetric stress = stressOf<law>(constants, geometry.weight[p], strain);
    if constexpr (withEnergy) twice += contraction(stress, strain);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<Lane, 3> row = firstStressRow(H[i], i, stress);
      for (std::size_t j = 0; j < 3; ++j)
        sums[i][j][inFace<p>[j]] += row[0] * map[3 * j] + row[1] * map[3 * j + 1] + row[2] * map[3 * j + 2];
    }
  });
  planarForces(sums, parentScale(), forces);
  if constexpr (withEnergy) *energy = 0.25 * twice;
}

template <Law law>
DOVETAIL_INLINE void pointwiseForces(const ElementCache& cache, const Batch& batch, const Vec3* u, BatchForces& forces, Lane* energy) {
  const auto place = static_cast<std::size_t>(batch.geometry);
  if (batch.box)
    energy ? boxForces<law, true>(cache.constants, cache.boxes[place], batch, u, forces, energy)
           : boxForces<law, false>(cache.constants, cache.boxes[place], batch, u, forces, nullptr);
  else
    energy ? generalForces<law, true>(cache.constants, cache.general[place], batch, u, forces, energy)
           : generalForces<law, false>(cache.constants, cache.general[place], batch, u, forces, nullptr);
}

DOVETAIL_INLINE Lane determinantOfOnePlus(const Tensor& H) {
  const Lane a = 1.0 + H[0][0], b = 1.0 + H[1][1], c = 1.0 + H[2][2];
  return a * (b * c - H[1][2] * H[2][1]) - H[0][1] * (H[1][0] * c - H[1][2] * H[2][0]) +
         H[0][2] * (H[1][0] * H[2][1] - b * H[2][0]);
}

/// Inverse of J0 times determinant, for hybrid8, whose map is ∂ξ/∂X · J0.
DOVETAIL_INLINE Tensor inverseJacobian(const std::array<Lane, 9>& m) {
  const Lane c0 = m[4] * m[8] - m[5] * m[7], c1 = m[5] * m[6] - m[3] * m[8], c2 = m[3] * m[7] - m[4] * m[6];
  const Lane s = 1.0 / (m[0] * c0 + m[1] * c1 + m[2] * c2);
  return {{{s * c0, s * (m[2] * m[7] - m[1] * m[8]), s * (m[1] * m[5] - m[2] * m[4])},
           {s * c1, s * (m[0] * m[8] - m[2] * m[6]), s * (m[2] * m[3] - m[0] * m[5])},
           {s * c2, s * (m[1] * m[6] - m[0] * m[7]), s * (m[0] * m[4] - m[1] * m[3])}}};
}

}  // namespace

DOVETAIL_KERNEL void batchForces(const ElementCache& cache, const Batch& batch, const Vec3* u, BatchForces& forces, Lane* energy) {
  const auto place = static_cast<std::size_t>(batch.geometry);
  switch (cache.law) {
    case Law::stVenantKirchhoff:
      return pointwiseForces<Law::stVenantKirchhoff>(cache, batch, u, forces, energy);
    case Law::deformedMetric:
      return pointwiseForces<Law::deformedMetric>(cache, batch, u, forces, energy);
    case Law::hybrid:
      if (batch.box) return hybridBoxForces(cache.constants, cache.boxes[place], batch, u, forces, energy);
      const GeneralGeometry& geometry = cache.general[place];
      return hybridGeneralForces(cache.hybrid[static_cast<std::size_t>(geometry.hybrid)], geometry, batch, u, forces,
                                 energy);
  }
}

DOVETAIL_KERNEL std::array<Lane, 8> batchDeterminants(const ElementCache& cache, const Batch& batch, const Vec3* u) {
  const auto place = static_cast<std::size_t>(batch.geometry);
  PlanarField gradient;
  std::array<Lane, 8> determinant{};
  if (batch.box) {
    planarGradient(batch, u, cache.boxes[place].gradientScale, gradient);
    forEachPoint([&](auto p) __attribute__((always_inline)) { determinant[p] = determinantOfOnePlus(valueAt<decltype(p)::value>(gradient)); });
    return determinant;
  }
  const GeneralGeometry& geometry = cache.general[place];
  planarGradient(batch, u, parentScale(), gradient);
  forEachPoint([&](auto p) __attribute__((always_inline)) {
    Tensor H = mapped(valueAt<decltype(p)::value>(gradient), geometry.map[p]);
    if (cache.law == Law::hybrid) {
      const Tensor K = inverseJacobian(cache.hybrid[static_cast<std::size_t>(geometry.hybrid)].centreJacobian);
      H = mapped(H, {K[0][0], K[0][1], K[0][2], K[1][0], K[1][1], K[1][2], K[2][0], K[2][1], K[2][2]});
    }
    determinant[p] = determinantOfOnePlus(H);
  });
  return determinant;
}

}  // namespace dovetail::fem::detail
