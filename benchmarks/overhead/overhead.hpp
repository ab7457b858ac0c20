// What a scene pays: time and memory, measured so that other work on the machine disturbs little.
#pragma once

#include <malloc.h>
#include <time.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace dovetail::overhead {

/// Processor time of this thread, s: goes on only while the thread runs.
inline double processorTime() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Bytes that are allocated now, large blocks included.
inline double allocated() {
  const struct mallinfo2 info = ::mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

/// Two pieces of work done turn by turn.
struct Duel {
  double first = 0.0, second = 0.0;              ///< s per turn: the least of all turns
  double ratio = 0.0, lower = 0.0, upper = 0.0;  ///< second over first: median of the turns, and its quartiles
};
/// @param turns  each does the first and the second work, which of them begins alternates
inline Duel duel(int turns, const std::function<void()>& first, const std::function<void()>& second) {
  const auto timed = [](const std::function<void()>& work) {
    const double start = processorTime();
    work();
    return processorTime() - start;
  };
  std::vector<double> a, b, ratios;
  for (int turn = 0; turn < turns; ++turn) {
    if (turn % 2 == 0) a.push_back(timed(first));
    b.push_back(timed(second));
    if (turn % 2 == 1) a.push_back(timed(first));
    ratios.push_back(b.back() / a.back());
  }
  std::sort(ratios.begin(), ratios.end());
  return {*std::ranges::min_element(a), *std::ranges::min_element(b), median(ratios), ratios[ratios.size() / 4],
          ratios[(3 * ratios.size()) / 4]};
}

}  // namespace dovetail::overhead
