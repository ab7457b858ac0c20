// What the programs of the published cases refuse.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "program.hpp"

namespace dovetail::cantilever::test {

using Words = std::vector<std::string>;

/// The program refuses the words in one line that has the parts: the option, and what to write instead.
inline void expectRefused(const Words& words, const Words& parts) {
  const std::string name = std::filesystem::path(TEST_PROGRAM).filename().string();
  std::string line = name;
  for (const std::string& word : words) line += " '" + word + "'";
  SCOPED_TRACE(line);
  const Outcome outcome = runProgram(words);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with(name + ": ") && outcome.err.ends_with("\n")) << outcome.err;
  for (const std::string& part : parts)
    EXPECT_NE(outcome.err.find(part), std::string::npos) << '"' << part << "\" is not in: " << outcome.err;
}

/// A choice is refused with its words, a number behind a name too.
inline void expectChoice(const std::string& option, const Words& names) {
  Words parts = names;
  parts.push_back(option);
  expectRefused({option, names.front() + "x"}, parts);
  expectRefused({option, "0"}, parts);
}

}  // namespace dovetail::cantilever::test
