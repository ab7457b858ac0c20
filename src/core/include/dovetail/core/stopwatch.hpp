// What work takes: run time, and time of the processors.
#pragma once

#include <chrono>
#include <ctime>

namespace dovetail {

struct TimeTaken {
  double wall = 0.0;       ///< s
  double processor = 0.0;  ///< s, all threads of this process together: other programs do not lengthen it
  TimeTaken& operator+=(const TimeTaken& other) {
    wall += other.wall;
    processor += other.processor;
    return *this;
  }
};

/// Begins when it is made.
class Stopwatch {
public:
  TimeTaken sinceBegin() const {
    return {std::chrono::duration<double>(Clock::now() - begun_).count(), processorTime() - processor_};
  }
  /// Begins anew.
  TimeTaken lap() {
    const TimeTaken taken = sinceBegin();
    *this = Stopwatch();
    return taken;
  }

private:
  using Clock = std::chrono::steady_clock;
  static double processorTime() {
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }
  Clock::time_point begun_ = Clock::now();
  double processor_ = processorTime();
};

}  // namespace dovetail
