// Numbers of threads for the tests of several folders.
#pragma once

#include "dovetail/core/parallel.hpp"

namespace dovetail {

/// compute() on that many threads, whatever the machine has.
template <class Compute>
auto onThreads(int count, Compute&& compute) {
  struct Restore {
    int threads = dovetail::threads(), processors = detail::processors();
    ~Restore() {
      detail::pretendProcessors(processors);
      setThreads(threads);
    }
  } restore;
  detail::pretendProcessors(count);
  setThreads(count);
  return compute();
}

}  // namespace dovetail
