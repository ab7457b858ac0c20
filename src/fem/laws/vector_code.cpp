#include "dovetail/fem/laws/vector_code.hpp"

namespace dovetail::fem::detail {

bool& wideVectors() {
#if defined(__x86_64__)
  static bool wide = __builtin_cpu_supports("avx2");
#else
  static bool wide = false;
#endif
  return wide;
}

}  // namespace dovetail::fem::detail
