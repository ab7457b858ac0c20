#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail {
namespace {

/// As on a machine with four processors, whatever this one has.
class Parallel : public ::testing::Test {
protected:
  Parallel() { detail::pretendProcessors(4); }
  ~Parallel() override {
    detail::pretendProcessors(processors_);
    setThreads(1);
  }

private:
  int processors_ = detail::processors();
};

double sumOfRoots(std::size_t n, std::size_t chunkSize) {
  return parallelSum(n, chunkSize, [](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += 1.0 / std::sqrt(static_cast<double>(i + 1));
    return sum;
  });
}

/// Takes some time that the compiler cannot leave out.
double busyWork(std::size_t turns) {
  double x = 1.0;
  for (std::size_t i = 0; i < turns; ++i) x = std::sqrt(x + 1.0);
  return x;
}

TEST_F(Parallel, EveryItemIsVisitedOnce) {
  for (int count : {1, 2, 3}) {
    setThreads(count);
    for (std::size_t n : {0u, 1u, 9u, 10u, 11u, 20u, 1001u}) {
      std::vector<int> visits(n, 0);
      parallelFor(n, 10, [&](std::size_t begin, std::size_t end) {
        EXPECT_EQ(begin % 10, 0u);
        for (std::size_t i = begin; i < end; ++i) ++visits[i];
      });
      EXPECT_EQ(visits, std::vector<int>(n, 1));
    }
  }
}

TEST_F(Parallel, ManyLoopsInARowMissNothing) {
  setThreads(3);
  std::vector<int> visits(7, 0);
  for (int repeat = 0; repeat < 20000; ++repeat)
    parallelFor(visits.size(), 1, [&](std::size_t item, std::size_t) { ++visits[item]; });
  EXPECT_EQ(visits, std::vector<int>(7, 20000));
}

TEST_F(Parallel, ThreadsThatFellAsleepAreCalled) {
  setThreads(2);
  for (int repeat = 0; repeat < 5; ++repeat) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    // Each task ends only when both have begun: one thread alone would never come out.
    std::atomic<int> begun{0};
    parallelTasks(2, [&](std::size_t) {
      ++begun;
      while (begun < 2) std::this_thread::yield();
    });
    EXPECT_EQ(begun, 2);
  }
}

TEST_F(Parallel, ALoopThatEndsBeforeItsThreadsComeIsComplete) {
  setThreads(4);
  for (std::size_t pause : {0u, 10u, 100u, 1000u, 10000u}) {
    busyWork(pause);
    std::vector<int> visits(4, 0);
    parallelFor(4, 1, [&](std::size_t item, std::size_t) { ++visits[item]; });
    EXPECT_EQ(visits, std::vector<int>(4, 1)) << pause;
  }
}

TEST_F(Parallel, SumsAreBitwiseEqualForAnyNumberOfThreads) {
  for (std::size_t chunkSize : {64u, 700u, 20000u}) {  // more chunks than fit on the stack, fewer, one
    setThreads(1);
    const double one = sumOfRoots(12345, chunkSize);
    for (int count : {2, 3, 4}) {
      setThreads(count);
      for (int repeat = 0; repeat < 20; ++repeat) EXPECT_EQ(one, sumOfRoots(12345, chunkSize));
    }
  }
}

TEST_F(Parallel, AnEmptyRangeSumsToZero) { EXPECT_EQ(sumOfRoots(0, 64), 0.0); }

TEST_F(Parallel, TheLargestIsFoundAndNaNIsKept) {
  std::vector<double> x(1000);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = -2.0 - std::cos(static_cast<double>(i));
  x[777] = -0.5;
  const auto largest = [&] {
    return parallelMax(x.size(), 10, [&](std::size_t begin, std::size_t end) {
      double part = x[begin];
      for (std::size_t i = begin; i < end; ++i)
        if (x[i] > part || std::isnan(x[i])) part = x[i];
      return part;
    });
  };
  for (int count : {1, 3}) {
    setThreads(count);
    x[300] = -2.0;
    EXPECT_EQ(largest(), -0.5);
    x[300] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(largest()));
  }
  EXPECT_EQ(parallelMax(0, 10, [](std::size_t, std::size_t) { return 1; }), std::numeric_limits<int>::lowest());
}

TEST_F(Parallel, TheExceptionOfTheLowestChunkComesOut) {
  for (int count : {1, 2, 3}) {
    setThreads(count);
    for (int repeat = 0; repeat < 50; ++repeat) {
      std::vector<int> visits(40, 0);
      const auto body = [&](std::size_t begin, std::size_t) {
        ++visits[begin];
        if (begin == 17) busyWork(2000);  // those above fail first
        if (begin == 17 || begin >= 20) throw std::runtime_error("chunk " + std::to_string(begin));
      };
      try {
        parallelFor(40, 1, body);
        ADD_FAILURE() << "nothing thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "chunk 17");
      }
      for (std::size_t i = 0; i <= 17; ++i) EXPECT_EQ(visits[i], 1) << i;
    }
    EXPECT_GT(sumOfRoots(1000, 10), 0.0);  // loops go on as before
  }
}

TEST_F(Parallel, TasksAreHandedOutInOrderAndThrowAsLoopsDo) {
  for (int count : {1, 2, 3}) {
    setThreads(count);
    std::vector<std::atomic<int>> turn(30);
    std::atomic<int> turns{0};
    parallelTasks(turn.size(), [&](std::size_t task) { turn[task] = ++turns; });
    // Of the tasks before one that begins, at most those in the hands of the other threads have not begun.
    for (int task = 0; task < 30; ++task) EXPECT_GE(turn[static_cast<std::size_t>(task)], task + 2 - count) << task;
    EXPECT_EQ(turns, 30);
    try {
      parallelTasks(9, [](std::size_t task) {
        if (task >= 3) throw InputError("task " + std::to_string(task), "", "");
      });
      ADD_FAILURE() << "nothing thrown";
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(), "task 3");
    }
  }
}

TEST_F(Parallel, InnerLoopsRunOnTheThreadThatMeetsThem) {
  setThreads(1);
  const double one = sumOfRoots(5000, 10);
  setThreads(3);
  std::vector<double> sums(20, 0.0);
  std::vector<int> inner(20, 0), strangers(20, 0);
  parallelFor(sums.size(), 1, [&](std::size_t item, std::size_t) {
    inner[item] = threads();
    const auto self = std::this_thread::get_id();
    parallelFor(100, 1, [&](std::size_t, std::size_t) { strangers[item] += std::this_thread::get_id() != self; });
    sums[item] = sumOfRoots(5000, 10);
  });
  EXPECT_EQ(threads(), 3);
  EXPECT_EQ(sums, std::vector<double>(20, one));
  EXPECT_EQ(inner, std::vector<int>(20, 1));
  EXPECT_EQ(strangers, std::vector<int>(20, 0));
}

TEST_F(Parallel, LoopsOfTwoThreadsOfTheUserDoNotMix) {
  setThreads(2);
  const double one = sumOfRoots(3000, 10);
  double other = 0.0;
  std::thread second([&] {
    for (int repeat = 0; repeat < 200; ++repeat) other = sumOfRoots(3000, 10);
  });
  for (int repeat = 0; repeat < 200; ++repeat) EXPECT_EQ(sumOfRoots(3000, 10), one);
  second.join();
  EXPECT_EQ(other, one);
}

TEST_F(Parallel, NoMoreThreadsAreTakenThanProcessorsOrChunks) {
  setThreads(1000);
  EXPECT_EQ(threads(), 4);
  std::atomic<int> now{0}, most{0};
  parallelTasks(40, [&](std::size_t) {
    const int here = ++now;
    for (int seen = most; seen < here && !most.compare_exchange_weak(seen, here);) {
    }
    busyWork(20000);
    --now;
  });
  EXPECT_LE(most, 4);
  setThreads(2);
  most = 0;
  for (int repeat = 0; repeat < 20; ++repeat)
    parallelFor(40, 1, [&](std::size_t, std::size_t) {
      const int here = ++now;
      for (int seen = most; seen < here && !most.compare_exchange_weak(seen, here);) {
      }
      busyWork(1000);
      --now;
    });
  EXPECT_LE(most, 2);
}

TEST_F(Parallel, TheEnvironmentSaysHowMany) {
  EXPECT_EQ(detail::threadsFromEnvironment(nullptr, 8), 8);
  EXPECT_EQ(detail::threadsFromEnvironment("", 8), 8);
  EXPECT_EQ(detail::threadsFromEnvironment("3", 8), 3);
  EXPECT_EQ(detail::threadsFromEnvironment("3,2", 8), 3);
  EXPECT_EQ(detail::threadsFromEnvironment("64", 8), 8);
  for (const char* wrong : {"0", "-2", "many", "3x", "99999999999"})
    EXPECT_THROW(detail::threadsFromEnvironment(wrong, 8), InputError) << wrong;
}

TEST_F(Parallel, NoThreadsIsRefused) { EXPECT_THROW(setThreads(0), InputError); }

}  // namespace
}  // namespace dovetail
