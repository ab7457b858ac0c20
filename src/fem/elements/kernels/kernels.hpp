// The force kernels: one batch of four elements per call, in the version that fits the processor (vector_code.hpp).
#pragma once

#include "elements/lanes/lane.hpp"

namespace dovetail::fem::detail {

/// ∂U/∂u of a batch, and its energy if asked for.
/// @param u  displacement of all nodes, m
void batchForces(const BrickCache& cache, const Batch& batch, const Vec3* u, bool withEnergy, BatchForces& forces);
void batchDeterminants(const BrickCache& cache, const Batch& batch, const Vec3* u, BatchDeterminants& result);

namespace bricks {
/// Those of hybrid8.
void hybridForces(const BrickCache& cache, const Batch& batch, const Vec3* u, bool withEnergy, BatchForces& forces);
/// K = ∂²U/∂u² of a batch, [24 (3a + i) + 3b + k], N/m.
void hybridTangent(const BrickCache& cache, const Batch& batch, const Vec3* u, Lane* K);
}  // namespace bricks

}  // namespace dovetail::fem::detail
