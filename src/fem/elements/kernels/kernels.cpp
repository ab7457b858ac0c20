#include "kernels.hpp"

#include "pointwise_kernels.hpp"

namespace dovetail::fem::detail {

void batchForces(const BrickCache& cache, const Batch& batch, const Vec3* u, bool withEnergy, BatchForces& forces) {
  bricks::forcesOf(cache, batch, u, withEnergy, forces);
}
void batchDeterminants(const BrickCache& cache, const Batch& batch, const Vec3* u, BatchDeterminants& result) {
  withVectors([&] { bricks::determinantsOf(cache, batch, u, result); });
}

}  // namespace dovetail::fem::detail
