// The kernels of hex8, and the choice of the kernel of a batch.
#pragma once

#include "dovetail/core/vector_code.hpp"
#include "elements/lanes/lane_laws.hpp"
#include "kernels.hpp"

namespace dovetail::fem::detail::bricks {

template <Law law>
DOVETAIL_INLINE Symmetric stressOf(const LawConstants& constants, Lane weight, const Symmetric& strain) {
  if constexpr (law == Law::stVenantKirchhoff)
    return kirchhoffStress(constants, weight, strain);
  else if constexpr (law == Law::axialSprings)
    return springStress(constants, weight, strain);
  else
    return deformedMetricStress(constants, weight, strain);
}

/// Four times the strain energy.
template <Law law>
DOVETAIL_INLINE Lane energyOf(const LawConstants& constants, Lane weight, const Symmetric& stress,
                              const Symmetric& strain) {
  if constexpr (law == Law::axialSprings)
    return springEnergy(constants, weight, strain);
  else
    return contraction(stress, strain);
}

template <Law law, bool withEnergy>
DOVETAIL_INLINE void boxForces(const LawConstants& constants, const BoxGeometry& geometry, const Batch& batch,
                               const Vec3* u, BatchForces& forces) {
  PlanarField gradient;
  planarGradient(batch, u, geometry.gradientScale, gradient);
  PlanarField sums{};
  Lane twice{};
  forEachPoint([&](auto point) __attribute__((always_inline)) {
    constexpr int p = decltype(point)::value;
    const Tensor H = valueAt<p>(gradient);
    const Symmetric strain = doubleStrain(H);
    const Symmetric stress = stressOf<law>(constants, geometry.weight, strain);
    if constexpr (withEnergy) twice += energyOf<law>(constants, geometry.weight, stress, strain);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<Lane, 3> row = firstStressRow(H[i], i, stress);
      for (std::size_t j = 0; j < 3; ++j) sums[i][j][inFace<p>[j]] += row[j];
    }
  });
  planarForces(sums, geometry.gradientScale, forces);
  if constexpr (withEnergy) forces.energy = 0.25 * twice;
}

template <Law law, bool withEnergy>
DOVETAIL_INLINE void generalForces(const LawConstants& constants, const GeneralGeometry& geometry, const Batch& batch,
                                   const Vec3* u, BatchForces& forces) {
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
    if constexpr (withEnergy) twice += energyOf<law>(constants, geometry.weight[p], stress, strain);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<Lane, 3> row = firstStressRow(H[i], i, stress);
      for (std::size_t j = 0; j < 3; ++j)
        sums[i][j][inFace<p>[j]] += row[0] * map[3 * j] + row[1] * map[3 * j + 1] + row[2] * map[3 * j + 2];
    }
  });
  planarForces(sums, parentScale(), forces);
  if constexpr (withEnergy) forces.energy = 0.25 * twice;
}

template <Law law, bool withEnergy>
void pointwiseForces(const BrickCache& cache, const Batch& batch, const Vec3* u, BatchForces& forces) {
  const auto place = static_cast<std::size_t>(batch.geometry);
  if (batch.box)
    withVectors([&] { boxForces<law, withEnergy>(cache.constants, cache.boxes[place], batch, u, forces); });
  else
    withVectors([&] { generalForces<law, withEnergy>(cache.constants, cache.general[place], batch, u, forces); });
}

template <Law law>
void pointwiseForces(const BrickCache& cache, const Batch& batch, const Vec3* u, bool withEnergy, BatchForces& forces) {
  withEnergy ? pointwiseForces<law, true>(cache, batch, u, forces)
             : pointwiseForces<law, false>(cache, batch, u, forces);
}

DOVETAIL_INLINE Lane determinantOfOnePlus(const Tensor& H) {
  const Lane a = 1.0 + H[0][0], b = 1.0 + H[1][1], c = 1.0 + H[2][2];
  return a * (b * c - H[1][2] * H[2][1]) - H[0][1] * (H[1][0] * c - H[1][2] * H[2][0]) +
         H[0][2] * (H[1][0] * H[2][1] - b * H[2][0]);
}

/// J0⁻¹, for hybrid8, whose map is ∂ξ/∂X · J0.
DOVETAIL_INLINE std::array<Lane, 9> inverseOf(const std::array<Lane, 9>& m) {
  const Lane c0 = m[4] * m[8] - m[5] * m[7], c1 = m[5] * m[6] - m[3] * m[8], c2 = m[3] * m[7] - m[4] * m[6];
  const Lane s = 1.0 / (m[0] * c0 + m[1] * c1 + m[2] * c2);
  return {s * c0, s * (m[2] * m[7] - m[1] * m[8]), s * (m[1] * m[5] - m[2] * m[4]),
          s * c1, s * (m[0] * m[8] - m[2] * m[6]), s * (m[2] * m[3] - m[0] * m[5]),
          s * c2, s * (m[1] * m[6] - m[0] * m[7]), s * (m[0] * m[4] - m[1] * m[3])};
}

inline void forcesOf(const BrickCache& cache, const Batch& batch, const Vec3* u, bool withEnergy, BatchForces& forces) {
  switch (cache.law) {
    case Law::stVenantKirchhoff:
      return pointwiseForces<Law::stVenantKirchhoff>(cache, batch, u, withEnergy, forces);
    case Law::axialSprings:
      return pointwiseForces<Law::axialSprings>(cache, batch, u, withEnergy, forces);
    case Law::deformedMetric:
      return pointwiseForces<Law::deformedMetric>(cache, batch, u, withEnergy, forces);
    case Law::hybrid:
      return hybridForces(cache, batch, u, withEnergy, forces);
  }
}

DOVETAIL_INLINE void determinantsOf(const BrickCache& cache, const Batch& batch, const Vec3* u,
                                    BatchDeterminants& result) {
  const auto place = static_cast<std::size_t>(batch.geometry);
  PlanarField gradient;
  if (batch.box) {
    planarGradient(batch, u, cache.boxes[place].gradientScale, gradient);
    forEachPoint([&](auto point) __attribute__((always_inline)) {
      constexpr int p = decltype(point)::value;
      result.value[p] = determinantOfOnePlus(valueAt<p>(gradient));
    });
    return;
  }
  const GeneralGeometry& geometry = cache.general[place];
  planarGradient(batch, u, parentScale(), gradient);
  forEachPoint([&](auto point) __attribute__((always_inline)) {
    constexpr int p = decltype(point)::value;
    Tensor H = mapped(valueAt<p>(gradient), geometry.map[p]);
    if (cache.law == Law::hybrid)
      H = mapped(H, inverseOf(cache.hybrid[static_cast<std::size_t>(geometry.hybrid)].centreJacobian));
    result.value[p] = determinantOfOnePlus(H);
  });
}

}  // namespace dovetail::fem::detail::bricks
