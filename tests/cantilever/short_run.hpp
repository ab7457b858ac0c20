// Short runs of the cantilever for tests.
#pragma once

#include <string>
#include <vector>

#include "common/case_program.hpp"
#include "run.hpp"

namespace dovetail::cantilever::test {

using Words = std::vector<std::string>;

inline Settings settingsOf(Words words) {
  words.push_back("--quiet");
  return benchmark::settingsOf<Settings>("cantilever", words);
}
/// @param until  s @param words  options and their values
inline RunResult runUntil(double until, Words words = {}) {
  words.insert(words.end(), {"--until", std::to_string(until)});
  return run(settingsOf(words));
}

/// Joules at the end in the channels whose names start so.
inline double joulesOf(const RunResult& result, const std::string& beginning) {
  double sum = 0.0;
  for (const auto& channel : result.ledger.channels())
    if (channel.name.starts_with(beginning)) sum += channel.joules;
  return sum;
}

/// What a run of 0.01 s is refused with; empty if it is taken.
inline std::string refusal(const Words& words) {
  try {
    runUntil(0.01, words);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace dovetail::cantilever::test
