// The kernels for the processor that the build is for, and the choice among the sets.
#define DOVETAIL_KERNELS portable
#include "pointwise_kernels.hpp"

namespace dovetail::fem::detail {

KernelSet portableKernels() { return portable::kernelSet; }

const KernelSet& kernels() {
  static const KernelSet chosen = [] {
    KernelSet set = portableKernels();
    wideKernels(set);
    return set;
  }();
  return chosen;
}

}  // namespace dovetail::fem::detail
