// Short bars for tests.
#pragma once

#include <string>

#include "dovetail/core/error.hpp"
#include "run.hpp"

namespace dovetail::wave::test {

/// 4 m of particles, 1.6 m of overlap, a pulse of six elements.
inline Settings shortBar() {
  Settings settings;
  settings.demLength = 4.0;
  settings.overlap = 1.6;
  settings.femLength = 4.0;
  settings.pulseElements = 6.0;
  settings.dtFactor = 0.01;
  settings.quiet = true;
  return settings;
}

inline RunResult runAndCompare(const Settings& settings) {
  RunResult result = run(settings);
  compare(result);
  return result;
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

}  // namespace dovetail::wave::test
