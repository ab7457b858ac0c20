// dovetail study
#include "dovetail/report/study.hpp"

#include <algorithm>
#include <iostream>

#include "dovetail/hierarchical/farm.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/report/text.hpp"
#include "energy_study.hpp"
#include "program/options.hpp"
#include "study_cases.hpp"
#include "study_errors.hpp"
#include "verbs.hpp"

namespace dovetail::program {

namespace {

namespace fs = std::filesystem;

struct Settings : StudySettings {
  bool energy = false;
};

/// Names of files beside the tables.
std::vector<std::string> moreFilesOf(const Settings& settings) {
  std::vector<std::string> files;
  if (settings.energy) files = energyStudyFiles();
  for (const std::string& file : curveFiles(settings)) files.push_back(file);
  return files;
}

/// The command line as it was written.
struct Written {
  std::string file, against, along, repeat;
  report::Norm norm = report::Norm::mean;
  std::optional<double> exact;
  std::vector<std::string> over, set, show, error;
};

/// What the file plans, where it is a study, and over it what was written.
void takeAxes(const Written& written, Settings& settings) {
  if (isStudy(written.file))
    static_cast<StudyPlan&>(settings) = readStudy(written.file);
  else
    settings.ways = {{"", "", written.file, {}, {}}};
  for (const std::string& text : written.set) settings.set.push_back(settingFrom(text));
  Way& first = settings.ways.front();
  if (!written.over.empty() && !first.name.empty())
    throw InputError("each way of the study has axes of its own", "--over", "change them in " + written.file);
  if (!written.over.empty()) first.over.clear();
  for (const std::string& text : written.over) first.over.push_back(axisFrom(text, "--over " + text));
  if (!written.repeat.empty()) settings.repeat = axisFrom(written.repeat, "--repeat " + written.repeat);
  if (first.name.empty() && first.over.empty() && !settings.repeat)
    throw InputError("there is nothing to vary", "dovetail study", "give --over KEY=A,B,C, or the file of a study");
}

void takeError(const Written& written, const Options& options, Settings& settings) {
  if (!written.show.empty()) settings.columns = written.show;
  if (!written.error.empty()) settings.error = written.error;
  if (written.exact || !written.against.empty()) settings.exact = written.exact, settings.against.reset();
  if (!written.against.empty()) settings.against = Against{fs::absolute(written.against).string(), "", ""};
  if (settings.exact && settings.against)
    throw InputError("there are two references, \"exact\" and \"against\"", written.file, "leave out one of them");
  if (!settings.against)
    options.refuseIdle("--along --norm", "without a reference curve", "add --against FILE");
  else if (settings.error.empty())
    throw InputError("the reference has no column to be compared with", settings.against->file, "add --error COLUMN");
  if (!written.along.empty()) settings.against->along = written.along;
  if (options.given("--norm")) settings.against->norm = written.norm;
  if (settings.error.size() > 1 && !(settings.against && settings.against->norm == report::Norm::relative))
    throw InputError("errors of several columns cannot be added up", "--error " + settings.error[1],
                     "give one, or a reference curve with the norm relative");
  if (settings.error.empty()) settings.error = {ownError};
  for (const std::string& column : settings.error)  // refused before anything is run
    if (settings.against && settings.against->way.empty())
      curveOfFile(settings.against->file, *settings.against, column);
}

}  // namespace

bool studyScene(int argc, char** argv) {
  Settings settings;
  Written written;
  std::string out;
  bool keys = false;
  Options options("dovetail study",
                  "Runs a scene with every combination of values; writes study.csv, .json, .md and .svg.");
  options.text("FILE", written.file, "scene (JSON), or study: a file with scene, axes and error");
  options.texts("--over KEY=A,B,C", written.over, "values of a parameter of \"let\", or at a path such as steps.dt");
  options.texts("--set KEY=VALUE", written.set, "the same for all runs");
  options.texts("--show COLUMN", written.show, "of the series, shown in the tables at the end of the run");
  options.text("--repeat KEY=A,B,C", written.repeat,
               "the same, such as a seed, whose runs are one point of the figure, with their mean and range");
  options.texts("--error COLUMN", written.error,
                "of the series: its magnitude at the end is the error; default: the largest residual; several for "
                "--norm relative");
  options.number("--exact VALUE", written.exact, {-1e300, 1e300, true, true, "a number"},
                 "exact value of the column: the error is the difference from it");
  options.text("--against FILE", written.against,
               "CSV file with a curve of the column, such as series.csv of a finer run: the error is the distance "
               "from it; draws curves.svg");
  options.text("--along COLUMN", written.along, "of x of that curve; default: time_s");
  options.choice("--norm", written.norm, normWords, "of the difference from that curve");
  options.flag("--energy", settings.energy,
               "writes energy.html and .csv too: residual of the energy, its order in the step, growth and channels");
  options.integer("--workers N", settings.workers, 1, 1024, "processes at once; default: one for each processor");
  options.integer("--threads N", settings.threadsEach, 1, 1024,
                  "of each run; default: the processors over the workers");
  options.flag("--replace", settings.replace, "replaces an earlier study in the folder");
  options.flag("--continue", settings.goOn,
               "keeps the runs of an earlier study in the folder that finished, and resumes those with checkpoints");
  options.text("--out DIR", out, "folder; <file>-study if not given");
  options.flag("--keys", keys, "prints a reference of the keys of studies");
  if (!options.parse(argc, argv)) return true;
  if (keys) return std::cout << studyReference(), true;
  if (written.file.empty()) throw InputError("FILE is missing", "dovetail study", "name a scene or a study");
  options.refuseBoth("--exact", "--against");
  options.refuseBoth("--replace", "--continue");
  takeAxes(written, settings);
  takeError(written, options, settings);
  if (hierarchical::ranksOfFarm() > 1) {  // processes of a study cannot share the ranks
    if (options.given("--workers"))
      throw InputError("a study on ranks runs one case after the other", "--workers", "leave it out, or mpirun");
    settings.workers = 0;
  }
  settings.folder = out.empty() ? fs::path(written.file).stem().string() + "-study" : out;
  report::Study study = studyOf(settings);
  study.about["settings"] = report::objectOf(options.described());
  prepareFolders(study, settings, moreFilesOf(settings));
  if (!report::runStudy(study, std::cout, std::cerr)) return false;
  if (settings.energy) writeEnergyStudy(study.folder);
  if (settings.against) drawCurves(settings);
  std::cout << "tables and figure in " << study.folder.string() << '\n';
  return true;
}

}  // namespace dovetail::program
