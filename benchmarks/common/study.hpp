// Studies of the benchmarks.
#pragma once

#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/outputs.hpp"
#include "common/report.hpp"
#include "dovetail/report/study.hpp"

namespace dovetail::benchmark {

/// Labels and settings, in their order.
template <class Settings>
using Plan = std::vector<std::pair<std::string, Settings>>;

/// A study of a case: the name of its program, fronts, and what is shown; its plans by name.
template <class Settings>
struct CaseStudy : report::Study {
  std::map<std::string, Plan<Settings> (*)(const Settings&)> plans;
};

/// Runs the study that the settings name as report::runStudy; the case's functions are found by its settings.
template <class Settings>
bool runPlan(CaseStudy<Settings> study, const Settings& asked) {
  study.name = asked.study;
  study.folder = asked.out.empty() ? "." : asked.out;
  study.workers = asked.workers;
  study.quiet = asked.quiet;
  for (const auto& [label, planned] : study.plans.at(asked.study)(asked)) {
    Settings settings = planned;
    settings.quiet = true;
    settings.study = settings.out = "";
    study.cases.push_back({label, describe(settings), [settings] {
                             auto result = run(settings);
                             compare(result);
                             return figuresAsJson(linesOf(result));
                           }});
  }
  return underName("--out", [&] { return report::runStudy(study, std::cout, std::cerr); });
}

}  // namespace dovetail::benchmark
