// Threads that wait for loops and share out the chunks of one.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <vector>

namespace dovetail::detail {

/// The threads that come to a loop in time work on it; the one that called never waits for a thread that has taken no
/// chunk, so a thread that finds no free processor costs nothing. Idle threads look for work for some 30 µs, then
/// sleep.
class ThreadPool {
public:
  using Body = void (*)(void* context, std::size_t chunk);

  /// Runs body for every chunk on `threads` threads, the calling one among them; see runChunks.
  /// @return false if another loop has the pool: nothing was run
  bool run(std::size_t chunks, bool oneByOne, Body body, void* context, int threads);

  /// Whether this thread is at work on a loop.
  static bool inside();

private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  static constexpr std::size_t cacheLine = 64;

  struct Loop {
    Body body;
    void* context;
    std::size_t ranges;
    std::size_t threads;
    std::atomic<std::size_t> nextCalled{1};
    std::atomic<std::size_t> lowestFailed{none};
    std::mutex failing{};
    std::exception_ptr failure{};
  };

  enum Call : std::uint32_t { looking, asleep, called };

  /// A thread's range of chunks, and the word by which it is called.
  struct Seat {
    alignas(cacheLine) std::atomic<std::size_t> next{0};
    std::size_t end = 0;
    alignas(cacheLine) std::atomic<std::uint32_t> call{looking};
  };

  void seatThreads(std::size_t threads);
  void share(std::size_t chunks, std::size_t ranges);
  [[noreturn]] void serve(std::size_t number, Seat& seat);
  void awaitCall(Seat& seat);
  void callTwo();
  bool enter();
  void leave();
  void close();
  void takeChunks(std::size_t number);
  void runChunk(std::size_t chunk);

  std::mutex inUse_;
  std::vector<std::unique_ptr<Seat>> seats_;  ///< of the calling thread, then of the pool's
  Loop* loop_ = nullptr;
  /// Whether the loop takes in threads, whether its caller sleeps, and how many of the pool's threads are in it.
  alignas(cacheLine) std::atomic<std::uint32_t> gate_{0};
};

}  // namespace dovetail::detail
