#include "hybrid_kernels.hpp"

#include <algorithm>

#include "dovetail/core/vector_code.hpp"
#include "hybrid_tangent.hpp"

namespace dovetail::fem::detail::bricks {

void hybridForces(const BrickCache& cache, const Batch& batch, const Vec3* u, bool withEnergy, BatchForces& forces) {
  const auto place = static_cast<std::size_t>(batch.geometry);
  if (batch.box)
    return withVectors([&] { hybridBoxForces(cache.constants, cache.boxes[place], batch, u, withEnergy, forces); });
  const GeneralGeometry& geometry = cache.general[place];
  const HybridGeometry& hybrid = cache.hybrid[static_cast<std::size_t>(geometry.hybrid)];
  withVectors([&] { hybridGeneralForces(hybrid, geometry, batch, u, withEnergy, forces); });
}

void hybridTangent(const BrickCache& cache, const Batch& batch, const Vec3* u, Lane* K) {
  std::fill(K, K + 576, Lane{});
  const auto place = static_cast<std::size_t>(batch.geometry);
  if (batch.box) return withVectors([&] { hybridBoxTangent(cache.constants, cache.boxes[place], batch, u, K); });
  const GeneralGeometry& geometry = cache.general[place];
  const HybridGeometry& hybrid = cache.hybrid[static_cast<std::size_t>(geometry.hybrid)];
  withVectors([&] { hybridGeneralTangent(hybrid, geometry, batch, u, K); });
}

}  // namespace dovetail::fem::detail::bricks
