// The runs of a study: what the command line and Python have in common.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dovetail/core/parallel.hpp"
#include "dovetail/report/figure.hpp"
#include "dovetail/report/study.hpp"
#include "dovetail/scene/scene.hpp"
#include "study_plan.hpp"

namespace dovetail::program {

/// The error of a study that names none: a figure of every run with a series.
inline constexpr const char* ownError = "largest_residual_J";

/// The plan, and how it is carried out.
struct StudySettings : StudyPlan {
  std::filesystem::path folder;
  int workers = threads();              ///< processes at once; 0: one run after the other in this process
  std::optional<int> threadsEach = {};  ///< of each run; not given: the processors shared among the processes
  bool replace = false;
  bool goOn = false;  ///< keeps what finished in the folder, and resumes what has checkpoints
  /// The scene with these settings; empty: that of the way's file.
  std::function<scene::Scene(const std::vector<std::string>& settings)> read = {};
  /// Figures of a run by steps of its own, which writes no files; empty: all stages are run.
  std::function<report::Json(const scene::Scene&)> act = {};
  /// More figures, of a finished run with its files in the folder.
  std::function<report::Json(const std::filesystem::path& folder)> measure = {};

  bool hasError() const { return exact || against; }
  /// Whether every run must have a series.
  bool needsSeries() const { return !act && !measure; }
};

/// The folder of a run, by its number from 0.
std::filesystem::path folderOf(const StudySettings& settings, std::size_t run);

/// A scene that a value makes impossible is a row that says why; what makes all of them so is refused before anything
/// is run. @param settings  must outlive the study  @throws InputError
report::Study studyOf(const StudySettings& settings);

/// Makes the folders of the runs that are to begin. @param more  names of files beside those of report::runStudy
/// @throws InputError as io::prepareOutputFolder, and for earlier runs that are neither to be replaced nor gone on with
void prepareFolders(const report::Study& study, const StudySettings& settings,
                    const std::vector<std::string>& more = {});

}  // namespace dovetail::program
