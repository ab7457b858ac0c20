// Signals that ask a program to end, heeded between two steps.
#pragma once

#include <array>
#include <csignal>
#include <string>

namespace dovetail::io {

/// While it lives, the first SIGINT, SIGTERM, SIGHUP or SIGALRM does not end the program but is noted for
/// interruption(); a second one of the same kind ends it as ever. Signals that are ignored (nohup) stay so. One at a
/// time, on the main thread; it forgets what was noted when it is made.
class InterruptionGuard {
public:
  InterruptionGuard();
  ~InterruptionGuard();
  InterruptionGuard(const InterruptionGuard&) = delete;
  InterruptionGuard& operator=(const InterruptionGuard&) = delete;

private:
  std::array<struct sigaction, 4> before_{};
};

/// The number of the signal that asks this program to end, 0 if there is none. A run that finds one finishes its step,
/// writes everything and says so; its program then ends with the exit code 128 + number, as shells have it. Costs a
/// load from memory, so it may be called at every step.
int interruption();
/// As if that signal had come: for one that another process of the run has had.
void noteInterruption(int number);

/// Lets SIGALRM come after so many seconds of wall-clock time, once: within a guard, a limit to what a run may take.
/// Takes the place of an earlier limit and of any other timer of alarm(2). Child processes do not inherit it.
/// @param seconds  from 1e-6 to 1e8
/// @throws InputError for others
void interruptAfter(double seconds);

/// From here on signals end the program as ever, guard or not: for work that loses nothing by it and does not ask.
void endAtSignals();

/// "interrupted by SIGTERM"; "its time was up" for SIGALRM
std::string nameOfInterruption();

}  // namespace dovetail::io
