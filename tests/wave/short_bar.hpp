// Short bars for tests.
#pragma once

#include <string>
#include <vector>

#include "common/case_program.hpp"
#include "run.hpp"

namespace dovetail::wave::test {

using Words = std::vector<std::string>;

inline Settings settingsOf(Words words) {
  words.push_back("--quiet");
  return benchmark::settingsOf<Settings>("wave_propagation", words);
}

/// 4 m of particles, 1.6 m of overlap, a pulse of six elements.
inline Settings shortBar(Words more = {}) {
  more.insert(more.end(), {"--dem-length", "4", "--overlap", "1.6", "--fem-length", "4"});
  Settings settings = settingsOf(more);
  settings.pulseElements = 6.0;
  if (!settings.fractionOfCritical) settings.dtFactor = 0.01;
  return settings;
}
inline RunFigures figuresOf(const Words& more) { return run(shortBar(more)).figures; }

inline RunResult runAndCompare(const Settings& settings) {
  RunResult result = run(settings);
  compare(result);
  return result;
}

/// What run() refuses the words with; empty if it takes them.
inline std::string refusal(const Words& more) {
  try {
    figuresOf(more);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace dovetail::wave::test
