#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/io/interruption.hpp"

namespace dovetail::io {
namespace {

/// How a child process that calls `action` ends, as waitpid tells it.
template <class Action>
int endOf(Action&& action) {
  const pid_t child = ::fork();
  if (child == 0) {
    action();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

TEST(Interruption, IsNotedOnceForEachSignal) {
  for (const auto& [number, name] : {std::pair{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}}) {
    const InterruptionGuard guard;
    EXPECT_EQ(interruption(), 0);
    struct sigaction now {};
    sigaction(number, nullptr, &now);
    if (now.sa_handler == SIG_IGN) continue;
    ::raise(number);
    EXPECT_EQ(interruption(), number);
    EXPECT_EQ(nameOfInterruption(), std::string("interrupted by ") + name);
  }
}

TEST(Interruption, AskedForTwiceEndsTheProgram) {
  const int status = endOf([] {
    ::signal(SIGTERM, SIG_DFL);
    const InterruptionGuard guard;
    ::raise(SIGTERM);
    if (interruption() != SIGTERM) ::_exit(1);
    ::raise(SIGTERM);
  });
  ASSERT_TRUE(WIFSIGNALED(status)) << status;
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
}

TEST(Interruption, ComesWhenTheTimeIsUp) {
  const InterruptionGuard guard;
  interruptAfter(0.02);
  EXPECT_EQ(interruption(), 0);
  for (int look = 0; look < 1000 && interruption() == 0; ++look) ::usleep(1000);
  EXPECT_EQ(interruption(), SIGALRM);
  EXPECT_EQ(nameOfInterruption(), "its time was up");
  for (const double odd : {0.0, -1.0, 1e9, std::nan("")}) EXPECT_THROW(interruptAfter(odd), InputError) << odd;
}

TEST(Interruption, LeavesIgnoredSignalsIgnored) {
  const int status = endOf([] {
    ::signal(SIGHUP, SIG_IGN);
    const InterruptionGuard guard;
    ::raise(SIGHUP);
    ::_exit(interruption());
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST(Interruption, IsTheSystemsAffairWithoutAGuard) {
  const int status = endOf([] {
    ::signal(SIGTERM, SIG_DFL);
    { const InterruptionGuard guard; }
    ::raise(SIGTERM);
  });
  EXPECT_TRUE(WIFSIGNALED(status)) << status;
}

}  // namespace
}  // namespace dovetail::io
