// The force kernels: one batch of four elements per call.
//
// The kernels are written once, in headers whose namespace is the macro DOVETAIL_KERNELS, and compiled twice: for the
// processor that the build is for (kernels_portable.cpp), and for x86-64 with AVX2 (kernels_wide.cpp). The one that
// fits is taken at run time. Their digits are the same unless DOVETAIL_FP_CONTRACT is on.
#pragma once

#include "lane.hpp"

namespace dovetail::fem::detail {

struct KernelSet {
  /// ∂U/∂u of a batch, and its energy if asked for.
  /// @param u  displacement of all nodes, m
  void (*forces)(const BrickCache& cache, const Batch& batch, const Vec3* u, bool withEnergy, BatchForces& forces);
  void (*determinants)(const BrickCache& cache, const Batch& batch, const Vec3* u, BatchDeterminants& result);
};

KernelSet portableKernels();
/// @return false if the build or the processor has none
bool wideKernels(KernelSet& kernels);

/// The fastest kernels for this processor.
const KernelSet& kernels();

}  // namespace dovetail::fem::detail
