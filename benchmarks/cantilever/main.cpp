#include <iostream>

#include "program/run.hpp"
#include "run.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::cantilever;

bool runOnce(const Settings& settings) {
  std::vector<ReferenceCurve> curves;
  if (!settings.reference.empty()) curves = readReferenceCurves(settings.reference);
  const PreparedRun compute = prepareRun(settings);  // refuses before a folder is made
  benchmark::Outputs outputs(settings, "beam", false, provenanceOf(settings));
  RunResult result = compute(outputs.observer());
  compareWithReferences(result);
  if (!settings.quiet) printReport(std::cout, result);
  if (!settings.quiet && !curves.empty()) printComparison(std::cout, result, curves);
  outputs.finish(result.series, nullptr);
  if (!settings.summary.empty())
    benchmark::writeSummary(settings.summary, linesOf(result), result, describe(settings), describeCase());
  if (!result.figures.finished) std::cerr << "cantilever: " << result.figures.failure << '\n';
  return result.figures.finished;
}

}  // namespace

/// Exit code 0: the run finished; 1: it broke down, with when and where; 2: the request was refused; 130, 143: it was
/// interrupted, and what it had computed is written.
int main(int argc, char** argv) {
  return program::runProgram("cantilever", [&] {
    Settings settings;
    if (!parseOptions(argc, argv, settings)) return true;
    return settings.study.empty() ? runOnce(settings) : runStudy(settings);
  });
}
