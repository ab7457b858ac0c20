// Studies of the benchmarks.
#pragma once

#include <algorithm>
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

/// The runs of the plan that `only` asks for. @throws InputError if there are none
template <class Settings>
Plan<Settings> chosen(const Plan<Settings>& plan, const std::string& only) {
  const bool isLabel = std::ranges::any_of(plan, [&](const auto& one) { return one.first == only; });
  Plan<Settings> runs;
  for (const auto& one : plan)
    if (isLabel ? one.first == only : one.first.find(only) != std::string::npos) runs.push_back(one);
  if (runs.empty())
    throw InputError("no run of the study is called so: " + only, "--only",
                     "take a label as the study prints it, such as '" + plan.front().first + "'");
  return runs;
}

/// Runs the study that the settings name as report::runStudy; the case's functions are found by its settings.
template <class Settings>
bool runPlan(CaseStudy<Settings> study, const Settings& asked) {
  study.name = asked.study;
  study.folder = asked.out.empty() ? "." : asked.out;
  study.workers = asked.workers;
  study.quiet = asked.quiet;
  for (const auto& [label, planned] : chosen(study.plans.at(asked.study)(asked), asked.only)) {
    Settings settings = planned;
    settings.quiet = true;
    settings.study = settings.out = settings.only = "";
    study.cases.push_back({label, describe(settings), [settings] {
                             auto result = run(settings);
                             compare(result);
                             return figuresAsJson(linesOf(result));
                           }});
  }
  return underName("--out", [&] { return report::runStudy(study, std::cout, std::cerr); });
}

}  // namespace dovetail::benchmark
