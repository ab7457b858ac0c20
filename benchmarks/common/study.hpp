// Studies of the benchmarks.
#pragma once

#include <iostream>
#include <utility>
#include <vector>

#include "common/outputs.hpp"
#include "common/report.hpp"
#include "dovetail/report/study.hpp"

namespace dovetail::benchmark {

/// Labels and settings, in their order.
template <class Settings>
using Plan = std::vector<std::pair<std::string, Settings>>;

/// Runs the plan as report::runStudy; `study` has the name of the program, fronts, and what is shown.
/// @param figuresOf  runs settings and returns the figures
template <class Settings, class Figures>
bool runPlan(report::Study study, const Settings& asked, const Plan<Settings>& plan, Figures figuresOf) {
  study.name = asked.study;
  study.folder = asked.out.empty() ? "." : asked.out;
  study.workers = asked.workers;
  study.quiet = asked.quiet;
  for (const auto& [label, planned] : plan) {
    Settings settings = planned;
    settings.quiet = true;
    settings.study = settings.out = "";
    study.cases.push_back({label, describe(settings), [settings, figuresOf] { return figuresOf(settings); }});
  }
  return underName("--out", [&] { return report::runStudy(study, std::cout, std::cerr); });
}

}  // namespace dovetail::benchmark
