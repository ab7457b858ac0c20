// The kernels for x86-64 with AVX2, in builds for any x86-64.
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "brick.hpp"
#include "lane.hpp"

// Without optimisation functions of the standard library would come out of line, for AVX2, and could replace those of
// other files.
#if defined(__x86_64__) && defined(__OPTIMIZE__) && !defined(__AVX2__)

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,fma"))), apply_to = function)
#else
#pragma GCC target("avx2,fma")
#endif

#define DOVETAIL_KERNELS wide
#include "pointwise_kernels.hpp"

namespace dovetail::fem::detail {
namespace {
constexpr KernelSet wideSet = wide::kernelSet;
}
}  // namespace dovetail::fem::detail

#if defined(__clang__)
#pragma clang attribute pop
#endif

namespace dovetail::fem::detail {
bool wideKernels(KernelSet& kernels) {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return false;
  kernels = wideSet;
  return true;
}
}  // namespace dovetail::fem::detail

#else

#include "kernels.hpp"

namespace dovetail::fem::detail {
bool wideKernels(KernelSet&) { return false; }
}  // namespace dovetail::fem::detail

#endif
