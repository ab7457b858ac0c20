// Short runs of the cantilever for tests.
#pragma once

#include <string>

#include "dovetail/core/error.hpp"
#include "run.hpp"

namespace dovetail::cantilever::test {

inline Settings shortSettings(double until) {
  Settings settings;
  settings.until = until;
  settings.quiet = true;
  return settings;
}

/// Joules at the end in the channels whose names start so.
inline double joulesOf(const RunResult& result, const std::string& beginning) {
  double sum = 0.0;
  for (const auto& channel : result.ledger.channels())
    if (channel.name.starts_with(beginning)) sum += channel.joules;
  return sum;
}

/// What run() refuses the settings with; empty if it takes them.
inline std::string refusal(const Settings& settings) {
  try {
    run(settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace dovetail::cantilever::test
