#include "dovetail/core/parallel.hpp"

#include "dovetail/core/error.hpp"

namespace dovetail {

namespace {
int threadCount = 1;
}

int threads() { return threadCount; }

void setThreads(int count) {
  if (count < 1)
    throw InputError("the number of threads is " + std::to_string(count), "threads", "give 1 or more");
#ifdef _OPENMP
  threadCount = count;
#endif
}

namespace detail {
void runChunks(std::size_t chunks, void (*body)(void*, std::size_t), void* context) {
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(threadCount)
#endif
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) body(context, chunk);
}
}  // namespace detail

}  // namespace dovetail
