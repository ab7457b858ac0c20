#include "dovetail/io/interruption.hpp"

#include <atomic>

namespace dovetail::io {

namespace {

struct Signal {
  int number;
  const char* name;
};
constexpr std::array<Signal, 3> heeded{{{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}}};

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

std::string nameOfInterruption() {
  for (const Signal& signal : heeded)
    if (signal.number == interruption()) return std::string("interrupted by ") + signal.name;
  return "not interrupted";
}

}  // namespace dovetail::io
