#include "dovetail/core/large_pages.hpp"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace dovetail {

void preferLargePages([[maybe_unused]] const void* data, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
  constexpr std::uintptr_t page = std::uintptr_t{1} << 21;
  constexpr int collapse = 25;  // MADV_COLLAPSE, which older headers lack
  const auto address = reinterpret_cast<std::uintptr_t>(data);
  const std::uintptr_t begin = address / page * page, end = (address + bytes) / page * page;
  if (bytes < page) return;
  // Advice only: what the system does not grant costs time, not digits.
  if (madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE) == 0)
    (void)madvise(reinterpret_cast<void*>(begin), end - begin, collapse);
#endif
}

}  // namespace dovetail
