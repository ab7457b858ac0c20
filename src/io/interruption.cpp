#include "dovetail/io/interruption.hpp"

#include <sys/time.h>

#include <atomic>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::io {

namespace {

struct Signal {
  int number;
  const char* told;
};
constexpr std::array<Signal, 4> heeded{{{SIGINT, "interrupted by SIGINT"},
                                        {SIGTERM, "interrupted by SIGTERM"},
                                        {SIGHUP, "interrupted by SIGHUP"},
                                        {SIGALRM, "its time was up"}}};

std::atomic<int> noted{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal's handler may touch nothing else");

void note(int number) { noted.store(number, std::memory_order_relaxed); }

}  // namespace

InterruptionGuard::InterruptionGuard() {
  noted = 0;
  for (std::size_t k = 0; k < heeded.size(); ++k) {
    sigaction(heeded[k].number, nullptr, &before_[k]);
    if (before_[k].sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = note;
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    sigaction(heeded[k].number, &action, nullptr);
  }
}

InterruptionGuard::~InterruptionGuard() {
  for (std::size_t k = 0; k < heeded.size(); ++k) sigaction(heeded[k].number, &before_[k], nullptr);
}

int interruption() { return noted.load(std::memory_order_relaxed); }
void noteInterruption(int number) { note(number); }

void interruptAfter(double seconds) {
  if (!(seconds >= 1e-6 && seconds <= 1e8))
    throw InputError("the limit is " + formatNumber(seconds) + " s", "wall-clock time", "give 1e-6 to 1e8 s");
  const double whole = std::floor(seconds);
  itimerval timer{};
  timer.it_value = {static_cast<time_t>(whole), static_cast<suseconds_t>(1e6 * (seconds - whole))};
  setitimer(ITIMER_REAL, &timer, nullptr);
}

void endAtSignals() {
  for (const Signal& signal : heeded) {
    struct sigaction now {};
    sigaction(signal.number, nullptr, &now);
    if (now.sa_handler != note) continue;
    now.sa_handler = SIG_DFL;
    sigaction(signal.number, &now, nullptr);
  }
}

std::string nameOfInterruption() {
  for (const Signal& signal : heeded)
    if (signal.number == interruption()) return signal.told;
  return "not interrupted";
}

}  // namespace dovetail::io
