// The force kernels: one batch of four elements per call.
#pragma once

#include "lane.hpp"

namespace dovetail::fem::detail {

/// ∂U/∂u of a batch; per-element energies to `energy` unless it is null.
/// @param u  displacement of all nodes, m
void batchForces(const ElementCache& cache, const Batch& batch, const Vec3* u, BatchForces& forces, Lane* energy);

/// Kernels of hybrid8.
void hybridBoxForces(const LawConstants& law, const BoxGeometry& geometry, const Batch& batch, const Vec3* u,
                     BatchForces& forces, Lane* energy);
void hybridGeneralForces(const HybridGeometry& hybrid, const GeneralGeometry& geometry, const Batch& batch,
                         const Vec3* u, BatchForces& forces, Lane* energy);

/// det F at the eight Gauss points.
std::array<Lane, 8> batchDeterminants(const ElementCache& cache, const Batch& batch, const Vec3* u);

}  // namespace dovetail::fem::detail
