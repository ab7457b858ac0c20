#include "thread_pool.hpp"

#include <algorithm>
#include <system_error>
#include <thread>

namespace dovetail::detail {

namespace {

constexpr std::uint32_t openBit = 1u << 31, sleepBit = 1u << 30, countMask = sleepBit - 1;

thread_local bool insideLoop = false;

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Looks for `done` for some 30 µs, most of the time letting others have the processor.
template <class Done>
bool look(Done&& done) {
  for (int i = 0; i < 200; ++i) {
    if (done()) return true;
    pause();
  }
  for (int i = 0; i < 50; ++i) {
    if (done()) return true;
    std::this_thread::yield();
  }
  return done();
}

}  // namespace

bool ThreadPool::inside() { return insideLoop; }

bool ThreadPool::run(std::size_t chunks, bool oneByOne, Body body, void* context, int threads) {
  const std::unique_lock lock(inUse_, std::try_to_lock);
  if (!lock) return false;
  seatThreads(std::min(static_cast<std::size_t>(threads), chunks));
  const std::size_t used = std::min({static_cast<std::size_t>(threads), chunks, seats_.size()});
  Loop loop{body, context, oneByOne ? 1 : used, used};
  share(chunks, loop.ranges);
  loop_ = &loop;
  gate_.store(openBit, std::memory_order_release);
  insideLoop = true;
  callTwo();
  takeChunks(0);
  close();
  insideLoop = false;
  if (loop.failure) std::rethrow_exception(loop.failure);
  return true;
}

void ThreadPool::seatThreads(std::size_t threads) {
  while (seats_.size() < threads) {
    const std::size_t number = seats_.size();
    seats_.push_back(std::make_unique<Seat>());
    if (number == 0) continue;
    try {
      std::thread([this, number, seat = seats_.back().get()] { serve(number, *seat); }).detach();
    } catch (const std::system_error&) {  // the system has no more: go on with those that are there
      seats_.pop_back();
      return;
    }
  }
}

void ThreadPool::share(std::size_t chunks, std::size_t ranges) {
  for (std::size_t r = 0; r < ranges; ++r) {
    seats_[r]->next.store(chunks * r / ranges, std::memory_order_relaxed);
    seats_[r]->end = chunks * (r + 1) / ranges;
  }
}

void ThreadPool::serve(std::size_t number, Seat& seat) {
  insideLoop = true;
  for (;;) {
    awaitCall(seat);
    if (!enter()) continue;
    if (number < loop_->threads) {  // else called by an earlier loop on more threads
      callTwo();
      takeChunks(number);
    }
    leave();
  }
}

void ThreadPool::awaitCall(Seat& seat) {
  const auto isCalled = [&] { return seat.call.load(std::memory_order_relaxed) == called; };
  if (!look(isCalled)) {
    std::uint32_t state = looking;
    if (seat.call.compare_exchange_strong(state, asleep, std::memory_order_relaxed))
      while (!isCalled()) seat.call.wait(asleep, std::memory_order_relaxed);
  }
  seat.call.store(looking, std::memory_order_relaxed);
}

// Each thread that comes calls two more, so that the first pays for two of them, however many there are.
void ThreadPool::callTwo() {
  for (int call = 0; call < 2; ++call) {
    const std::size_t number = loop_->nextCalled.fetch_add(1, std::memory_order_relaxed);
    if (number >= loop_->threads) return;
    Seat& seat = *seats_[number];
    if (seat.call.exchange(called, std::memory_order_relaxed) == asleep) seat.call.notify_one();
  }
}

bool ThreadPool::enter() {
  std::uint32_t gate = gate_.load(std::memory_order_relaxed);
  while (gate & openBit)
    if (gate_.compare_exchange_weak(gate, gate + 1, std::memory_order_acquire, std::memory_order_relaxed)) return true;
  return false;
}

void ThreadPool::leave() {
  if (gate_.fetch_sub(1, std::memory_order_release) == (sleepBit | 1)) gate_.notify_one();
}

void ThreadPool::close() {
  gate_.fetch_and(~openBit, std::memory_order_relaxed);
  const auto isEmpty = [this] { return (gate_.load(std::memory_order_acquire) & countMask) == 0; };
  if (look(isEmpty)) return;
  gate_.fetch_or(sleepBit, std::memory_order_relaxed);
  for (std::uint32_t gate = gate_.load(std::memory_order_acquire); gate & countMask;
       gate = gate_.load(std::memory_order_acquire))
    gate_.wait(gate, std::memory_order_acquire);
}

void ThreadPool::takeChunks(std::size_t number) {
  const std::size_t ranges = loop_->ranges;
  for (std::size_t turn = 0; turn < ranges; ++turn) {
    Seat& seat = *seats_[(number + turn) % ranges];
    while (seat.next.load(std::memory_order_relaxed) < seat.end) {
      const std::size_t chunk = seat.next.fetch_add(1, std::memory_order_relaxed);
      if (chunk < seat.end) runChunk(chunk);
    }
  }
}

// Chunks above one that failed may be left out, those below may not: which exception comes out is then settled.
void ThreadPool::runChunk(std::size_t chunk) {
  Loop& loop = *loop_;
  if (chunk > loop.lowestFailed.load(std::memory_order_relaxed)) return;
  try {
    loop.body(loop.context, chunk);
  } catch (...) {
    const std::lock_guard lock(loop.failing);
    if (chunk > loop.lowestFailed.load(std::memory_order_relaxed)) return;
    loop.lowestFailed.store(chunk, std::memory_order_relaxed);
    loop.failure = std::current_exception();
  }
}

}  // namespace dovetail::detail
