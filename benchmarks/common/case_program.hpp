// The program of a case: one run, or a study.
#pragma once

#include <iostream>
#include <string>

#include "common/outputs.hpp"
#include "common/report.hpp"
#include "common/study.hpp"
#include "program/run.hpp"

namespace dovetail::benchmark {

/// What a run writes beside particles and series.
struct CaseFiles {
  std::string solid;       ///< name of the solid's frames; empty: there is none
  bool withTable = false;  ///< a second table
};

/// Runs the settings once, prints the report and writes the files that they ask for. The case's functions are found by
/// its settings. @return whether the run finished
template <class Settings, class ReadCurves>
bool runOnce(const std::string& program, const Settings& settings, const CaseFiles& files, ReadCurves readCurves) {
  decltype(readCurves(settings.reference)) curves;
  if (!settings.reference.empty()) curves = readCurves(settings.reference);
  const auto compute = prepareRun(settings);  // refuses before a folder is made
  Outputs outputs(settings, files.solid, files.withTable, provenanceOf(settings));
  auto result = compute(outputs.observer());
  compare(result);
  if (!settings.quiet) printReport(std::cout, result);
  if (!settings.quiet && !curves.empty()) printComparison(std::cout, result, curves);
  outputs.finish(result);
  if (!settings.summary.empty()) writeSummary(settings, linesOf(result), result);
  if (!result.figures.finished) std::cerr << program << ": " << result.figures.failure << '\n';
  return result.figures.finished;
}

/// What main() returns. 0: the run finished; 1: it broke down, with when and where; 2: the request was refused; 130,
/// 143: it was interrupted, and what it had computed is written.
/// @param filesOf  CaseFiles of settings @param readCurves  the published curves of a folder
template <class Settings, class FilesOf, class ReadCurves>
int runCase(const std::string& program, int argc, char** argv, FilesOf filesOf, ReadCurves readCurves) {
  return program::runProgram(program, [&] {
    Settings settings;
    if (!parseOptions(argc, argv, settings)) return true;
    if (settings.study.empty()) return runOnce(program, settings, filesOf(settings), readCurves);
    return runPlan(studyOf(settings), settings);
  });
}

}  // namespace dovetail::benchmark
