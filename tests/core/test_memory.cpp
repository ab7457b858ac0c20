#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <vector>

#include "dovetail/core/memory.hpp"

namespace dovetail {
namespace {

constexpr double mebibyte = 1048576.0;

TEST(Memory, WhatIsTakenIsHeld) {
  const double before = residentMemory();
  const std::vector<char> taken(64 * 1048576, 'x');
  EXPECT_GT(before, 0.1 * mebibyte);
  EXPECT_GT(residentMemory() - before, 0.9 * static_cast<double>(taken.size()) * (taken[1] == 'x'));
}

TEST(Memory, ALimitOfAddressSpaceCounts) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take more address space than the limit";
#endif
  EXPECT_GT(availableMemory(), 0.0);
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit limit{1ULL << 31, 1ULL << 31};
    setrlimit(RLIMIT_AS, &limit);
    const double left = availableMemory();
    ::_exit(left <= 2048.0 * mebibyte && left >= 0.0 ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

}  // namespace
}  // namespace dovetail
