#include "dovetail/core/vector_code.hpp"

namespace dovetail {
namespace {

VectorCode best() {
#if defined(__x86_64__)
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
  if (avx512) return VectorCode::avx512;
  if (__builtin_cpu_supports("avx2")) return VectorCode::avx2;
#endif
  return VectorCode::portable;
}

}  // namespace

VectorCode& vectorCode() {
  static VectorCode code = best();
  return code;
}

}  // namespace dovetail
