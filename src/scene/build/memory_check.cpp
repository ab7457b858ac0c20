// Numbers of things that a machine bears.
#include <cmath>

#include "dovetail/core/finite.hpp"
#include "dovetail/core/memory.hpp"
#include "parts.hpp"

namespace dovetail::scene {

void requireMemory(double count, const std::string& what, double bytesEach, const std::string& remedy) {
  if (!(count <= 1e8)) throw InputError("more than 1e8 " + what, "", remedy);
  const double needed = count * bytesEach, free = availableMemory();
  if (needed <= free) return;
  const auto gibibytes = [](double bytes) {
    return formatNumber(std::round(10.0 * bytes / 1073741824.0) / 10.0) + " GiB";
  };
  throw InputError(formatNumber(std::round(count)) + " " + what + " take at least " + gibibytes(needed) +
                       " of memory, and " + gibibytes(free) + " are free",
                   "", remedy + ", or a machine with more");
}

}  // namespace dovetail::scene
