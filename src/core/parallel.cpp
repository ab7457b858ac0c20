#include "dovetail/core/parallel.hpp"

#include <atomic>
#include <charconv>
#include <cstdlib>
#include <string>
#include <thread>

#include "dovetail/core/error.hpp"
#include "thread_pool.hpp"

#ifdef __linux__
#include <sched.h>
#endif

namespace dovetail {

namespace {

int allowedProcessors() {
#ifdef __linux__
  cpu_set_t mask;
  if (sched_getaffinity(0, sizeof mask, &mask) == 0) return std::max(1, CPU_COUNT(&mask));
#endif
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

std::atomic<int>& processorCount() {
  static std::atomic<int> count{allowedProcessors()};
  return count;
}

std::atomic<int>& threadCount() {
  static std::atomic<int> count{detail::threadsFromEnvironment(std::getenv("OMP_NUM_THREADS"), detail::processors())};
  return count;
}

// Never destroyed: its threads sleep until the process ends, from wherever that ends it.
detail::ThreadPool& pool() {
  static auto& threads = *new detail::ThreadPool;
  return threads;
}

}  // namespace

int threads() { return detail::ThreadPool::inside() ? 1 : threadCount().load(std::memory_order_relaxed); }

void setThreads(int count) {
  if (count < 1) throw InputError("the number of threads is " + std::to_string(count), "threads", "give 1 or more");
  threadCount() = std::min(count, detail::processors());
}

namespace detail {

int processors() { return processorCount().load(std::memory_order_relaxed); }

void pretendProcessors(int count) { processorCount() = count; }

int threadsFromEnvironment(const char* text, int processors) {
  const std::string asked = text == nullptr ? "" : text;
  if (asked.empty()) return processors;
  int count = 0;
  const auto [rest, error] = std::from_chars(asked.data(), asked.data() + asked.size(), count);
  const bool ended = rest == asked.data() + asked.size() || *rest == ',';  // later numbers are those of nested loops
  if (error != std::errc{} || !ended || count < 1)
    throw InputError("OMP_NUM_THREADS is '" + asked + "'", "threads", "give a number of 1 or more, or unset it");
  return std::min(count, processors);
}

void runChunks(std::size_t chunks, bool oneByOne, void (*body)(void*, std::size_t), void* context) {
  if (pool().run(chunks, oneByOne, body, context, threads())) return;
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) body(context, chunk);
}

}  // namespace detail

}  // namespace dovetail
