// dovetail run, check, resume, info, upgrade, schema, new
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/io/interruption.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/scene/files.hpp"
#include "dovetail/scene/read.hpp"
#include "dovetail/scene/units.hpp"
#include "dovetail/scene/upgrade.hpp"
#include "program/options.hpp"
#include "study_plan.hpp"
#include "verbs.hpp"

namespace dovetail::program {

namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::string>& starters() {
  static const std::map<std::string, std::string> all{
#include "starters.inc"
  };
  return all;
}

struct SceneFile {
  std::string name;
  std::vector<std::string> settings;

  void addTo(Options& options) {
    options.text("SCENE", name, "scene file (JSON)").require();
    options.texts("--set KEY=VALUE", settings, "a parameter of \"let\", or a path such as steps.dt");
  }
  scene::Scene read() const {
    if (isStudy(name)) throw InputError("this is a study", name, "run it with dovetail study " + name);
    return scene::readScene(name, settings);
  }
};

struct Stepping {
  bool profile = false;
  std::optional<double> maxWallSeconds;

  void addTo(Options& options) {
    options.flag("--profile", profile, "time per part of a step in the summary");
    options.number("--max-wall-seconds S", maxWallSeconds, positive("a positive time in seconds"),
                   "limit of wall-clock time, set-up included: then the run ends with a checkpoint and exit code 142");
  }
  void begin() const {
    if (maxWallSeconds) io::interruptAfter(*maxWallSeconds);
  }
};

std::optional<double> timeIn(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto time = scene::quantityOf(text);
  if (!time || (time->dimension != scene::unit::time && time->dimension != scene::unit::none) || !(time->value > 0.0))
    throw InputError("'" + text + "' is no time", "--until", "give seconds, or a time with its unit, such as '2 s'");
  return time->value;
}

}  // namespace

bool runScene(int argc, char** argv) {
  SceneFile file;
  Stepping stepping;
  std::string out;
  bool replace = false;
  Options options("dovetail run", "Runs a scene.");
  file.addTo(options);
  options.text("--out DIR", out, "folder for all files; <scene>-out if not given");
  options.flag("--replace", replace, "replaces an earlier run in the folder");
  stepping.addTo(options);
  if (!options.parse(argc, argv)) return true;
  stepping.begin();
  const scene::Scene scene = file.read();
  const fs::path folder = out.empty() ? fs::path(file.name).stem().string() + "-out" : out;
  if (!replace) io::requireNoRun(folder);
  return scene::run(scene, {.folder = folder, .profile = stepping.profile, .onRanks = true}, std::cout);
}

bool checkScene(int argc, char** argv) {
  SceneFile file;
  Options options("dovetail check", "Builds a scene, and prints sizes, critical steps, memory and run time.");
  file.addTo(options);
  if (!options.parse(argc, argv)) return true;
  io::endAtSignals();
  scene::check(file.read(), std::cout);
  return true;
}

bool resumeRun(int argc, char** argv) {
  std::string folder, until;
  std::optional<int> threads;
  Stepping stepping;
  Options options("dovetail resume", "Continues a run from its last checkpoint.");
  options.text("FOLDER", folder, "that the run wrote into").require();
  options.text("--until TIME", until,
               "new end time of the last stage, since the start of the run; also for a finished run");
  options.integer("--threads N", threads, 1, 1024, "in place of the scene's; results are the same for any number");
  stepping.addTo(options);
  if (!options.parse(argc, argv)) return true;
  stepping.begin();
  return scene::resume(
      {.folder = folder, .profile = stepping.profile, .onRanks = true, .until = timeIn(until), .threads = threads},
      std::cout);
}

bool inspectFile(int argc, char** argv) {
  std::string file;
  Options options("dovetail info", "Prints what a file or folder contains.");
  options.text("FILE", file, "scene, series, state, frame, summary, surface, mesh, or folder of a run").require();
  if (options.parse(argc, argv)) scene::tell(file, std::cout);
  return true;
}

bool upgradeScene(int argc, char** argv) {
  std::string name;
  Options options("dovetail upgrade", "Updates renamed keys and words of a scene file.");
  options.text("SCENE", name, "scene file (JSON), which is changed in place").require();
  if (!options.parse(argc, argv)) return true;
  const scene::FileText file = scene::textOfFile(name);
  const scene::Upgrade upgrade = scene::upgraded(file.text, file.name);
  for (const std::string& change : upgrade.changes) std::cout << change << '\n';
  if (upgrade.changes.empty())
    std::cout << "nothing to change\n";
  else
    replaceFile(name, {upgrade.text},
                [](const fs::path& path) { return fs::is_regular_file(fs::symlink_status(path)); });
  return true;
}

bool writeSchema(int argc, char** argv) {
  bool markdown = false;
  Options options("dovetail schema", "Prints the JSON Schema of scenes.");
  options.flag("--markdown", markdown, "a reference of all keys instead");
  if (options.parse(argc, argv)) std::cout << (markdown ? scene::referenceText() : scene::schemaText());
  return true;
}

bool writeStarter(int argc, char** argv) {
  std::string kind, file, kinds;
  for (const auto& [name, text] : starters()) kinds += (kinds.empty() ? "" : "|") + name;
  Options options("dovetail new", "Prints a commented starter scene, or writes it.");
  options.word("KIND", kind, kinds, "of the scene").require();
  options.text("FILE", file, "new file; standard output if not given");
  if (!options.parse(argc, argv)) return true;
  const std::string text = "// dovetail " + io::buildInfo().version + "\n" + starters().at(kind);
  if (file.empty())
    std::cout << text;
  else if (fs::exists(file))
    throw InputError("there is a file of this name", file, "give another name");
  else
    io::writeFileAtomically(file, text);
  return true;
}

}  // namespace dovetail::program
