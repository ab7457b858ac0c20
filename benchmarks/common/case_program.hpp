// The program of a case: one run, or a study.
#pragma once

#include <iostream>
#include <string>
#include <vector>

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
  Outputs outputs(settings, files.solid, files.withTable, io::provenance(describe(settings)));
  auto result = compute(outputs.observer());
  compare(result);
  if (!settings.quiet) printReport(std::cout, result);
  if (!settings.quiet && !curves.empty()) printComparison(std::cout, result, curves);
  outputs.finish(result);
  if (!settings.summary.empty())
    writeSummary(settings.summary, linesOf(result), result, describe(settings), result.scene);
  if (!result.figures.finished) std::cerr << program << ": " << result.figures.failure << '\n';
  return result.figures.finished;
}

/// The settings that words of a command line mean.
template <class Settings>
Settings settingsOf(const std::string& program, std::vector<std::string> words) {
  words.insert(words.begin(), program);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  Settings settings;
  parseOptions(static_cast<int>(argv.size()), argv.data(), settings);
  return settings;
}

/// One run of a study. What its options exclude is refused as what the run itself refuses.
template <class Settings>
report::StudyCase studyCase(const std::string& program, const PlannedRun& planned) {
  try {
    auto settings = settingsOf<Settings>(program, planned.words);
    settings.quiet = true;
    return {planned.label, describe(settings), [settings] {
              auto result = run(settings);
              compare(result);
              return figuresAsJson(linesOf(result));
            }};
  } catch (const InputError& error) {
    return {planned.label, {}, [error]() -> report::Json { throw InputError(error); }};
  }
}

template <class Settings>
bool runStudyOf(const std::string& program, const std::string& studies, const Settings& asked) {
  report::Study study = studyFrom(studies, program, asked);
  for (const PlannedRun& planned : plannedRuns(studies, asked))
    study.cases.push_back(studyCase<Settings>(program, planned));
  return underName("--out", [&] { return report::runStudy(study, std::cout, std::cerr); });
}

/// What main() returns. 0: the run finished; 1: it broke down, with when and where; 2: the request was refused; 130,
/// 143: it was interrupted, and what it had computed is written.
/// @param filesOf  CaseFiles of settings @param readCurves  the published curves of a folder
/// @param studies  see plannedRuns
template <class Settings, class FilesOf, class ReadCurves>
int runCase(const std::string& program, int argc, char** argv, FilesOf filesOf, ReadCurves readCurves,
            const std::string& studies) {
  const auto body = [&] {
    Settings settings;
    if (!parseOptions(argc, argv, settings)) return true;
    if (settings.study.empty()) return runOnce(program, settings, filesOf(settings), readCurves);
    return runStudyOf<Settings>(program, studies, settings);
  };
  return program::runProgram(program, body, program::Signals::noted);
}

}  // namespace dovetail::benchmark
