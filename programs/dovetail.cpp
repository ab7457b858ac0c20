// The command line of scenes.
#include <CLI/CLI.hpp>
#include <algorithm>
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
#include "program/run.hpp"
#include "verbs.hpp"

namespace {

using namespace dovetail;

const std::map<std::string, std::string>& starters() {
  static const std::map<std::string, std::string> all{
#include "starters.inc"
  };
  return all;
}

struct Options {
  std::string file, out, kind;
  std::vector<std::string> settings;
  bool profile = false, markdown = false, replace = false;
  std::optional<double> maxWallSeconds;
  std::string until;
  std::optional<int> threads;
};

void limitTime(const Options& options) {
  if (options.maxWallSeconds) io::interruptAfter(*options.maxWallSeconds);
}

bool runScene(const Options& options) {
  limitTime(options);
  const scene::Scene scene = scene::readScene(options.file, options.settings);
  const std::filesystem::path folder =
      options.out.empty() ? std::filesystem::path(options.file).stem().string() + "-out" : options.out;
  if (!options.replace) io::requireNoRun(folder);
  return scene::run(scene, {.folder = folder, .profile = options.profile}, std::cout);
}
bool checkScene(const Options& options) {
  io::endAtSignals();
  scene::check(scene::readScene(options.file, options.settings), std::cout);
  return true;
}
std::optional<double> untilOf(const Options& options) {
  if (options.until.empty()) return std::nullopt;
  const auto time = scene::quantityOf(options.until);
  if (!time || (time->dimension != scene::unit::time && time->dimension != scene::unit::none) || !(time->value > 0.0))
    throw InputError("'" + options.until + "' is no time", "--until",
                     "give seconds, or a time with its unit, such as '2 s'");
  return time->value;
}
bool resumeRun(const Options& options) {
  limitTime(options);
  if (options.threads && *options.threads < 1)
    throw InputError("the number of threads is " + std::to_string(*options.threads), "--threads", "give 1 or more");
  return scene::resume(
      {.folder = options.file, .profile = options.profile, .until = untilOf(options), .threads = options.threads},
      std::cout);
}
bool inspectFile(const Options& options) {
  scene::tell(options.file, std::cout);
  return true;
}
bool writeSchema(const Options& options) {
  std::cout << (options.markdown ? scene::referenceText() : scene::schemaText());
  return true;
}
bool upgradeScene(const Options& options) {
  const scene::FileText file = scene::textOfFile(options.file);
  const scene::Upgrade upgrade = scene::upgraded(file.text, file.name);
  for (const std::string& change : upgrade.changes) std::cout << change << '\n';
  if (upgrade.changes.empty())
    std::cout << "nothing to change\n";
  else
    replaceFile(options.file, {upgrade.text}, [](const std::filesystem::path& path) {
      return std::filesystem::is_regular_file(std::filesystem::symlink_status(path));
    });
  return true;
}
bool writeStarter(const Options& options) {
  const std::string text = "// dovetail " + io::buildInfo().version + "\n" + starters().at(options.kind);
  if (options.file.empty())
    std::cout << text;
  else if (std::filesystem::exists(options.file))
    throw InputError("there is a file of this name", options.file, "give another name");
  else
    io::writeFileAtomically(options.file, text);
  return true;
}

using program::Verb;

std::vector<Verb> addVerbs(CLI::App& app, Options& options) {
  std::vector<Verb> verbs;
  const auto add = [&](const char* name, const char* help, bool (*act)(const Options&)) {
    verbs.push_back(
        {app.add_subcommand(name, help), [act, &options] { return act(options) ? 0 : 128 + io::interruption(); }});
    return verbs.back().app;
  };
  const auto takesScene = [&](CLI::App* verb) {
    verb->add_option("SCENE", options.file, "scene file (JSON)")->required();
    verb->add_option("--set", options.settings, "key=value: a parameter of \"let\", or a path such as steps.dt")
        ->expected(1)
        ->take_all();
  };
  const auto steps = [&](CLI::App* verb) {
    verb->add_flag("--profile", options.profile, "time per part of a step in the summary");
    verb->add_option(
        "--max-wall-seconds", options.maxWallSeconds,
        "limit of wall-clock time, set-up included: then the run ends with a checkpoint and exit code 142");
  };
  CLI::App* const run = add("run", "runs a scene", runScene);
  takesScene(run);
  run->add_option("--out", options.out, "folder for all files; <scene>-out if not given");
  run->add_flag("--replace", options.replace, "replaces an earlier run in the folder");
  steps(run);
  takesScene(add("check", "builds a scene, and prints sizes, critical steps, memory and run time", checkScene));
  CLI::App* const resume = add("resume", "continues a run from its last checkpoint", resumeRun);
  resume->add_option("FOLDER", options.file, "that the run wrote into")->required();
  resume->add_option("--until", options.until,
                     "new end time of the last stage, since the start of the run; also for a finished run");
  resume->add_option("--threads", options.threads, "in place of the scene's; results are the same for any number");
  steps(resume);
  add("info", "prints what a file or folder contains", inspectFile)->add_option("FILE", options.file)->required();
  add("upgrade", "updates renamed keys and words of a scene file", upgradeScene)
      ->add_option("SCENE", options.file, "scene file (JSON), which is changed in place")
      ->required();
  add("schema", "prints the JSON Schema of scenes", writeSchema)
      ->add_flag("--markdown", options.markdown, "a reference of all keys instead");
  verbs.push_back(program::addCompare(app));
  verbs.push_back(program::addFields(app));
  verbs.push_back(program::addCalibrate(app));
  CLI::App* const starter = add("new", "prints a commented starter scene, or writes it", writeStarter);
  std::vector<std::string> kinds;
  for (const auto& [kind, text] : starters()) kinds.push_back(kind);
  starter->add_option("KIND", options.kind)->required()->check(CLI::IsMember(kinds));
  starter->add_option("FILE", options.file, "new file; standard output if not given");
  for (const program::OwnVerb& verb : program::ownVerbs) add(verb.name, verb.help, nullptr);  // for the help
  return verbs;
}

/// @return the verb that was asked for, null for --help and --version
const Verb* parse(CLI::App& app, const std::vector<Verb>& verbs, int argc, char** argv) {
  const auto isVerb = [&](const Verb& verb) { return verb.app->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '-' && std::none_of(verbs.begin(), verbs.end(), isVerb)) {
    std::string names;
    for (const Verb& verb : verbs) names += (names.empty() ? "" : ", ") + verb.app->get_name();
    throw InputError("there is no verb '" + std::string(argv[1]) + "'", "command line", "write one of " + names);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    app.exit(asked);
    return nullptr;
  } catch (const CLI::Error& error) {
    throw InputError(error.what(), "command line", "see dovetail --help");
  }
  for (const Verb& verb : verbs)
    if (verb.app->parsed()) return &verb;
  return nullptr;
}

bool act(int argc, char** argv) {
  program::offerTetrahedra();
  for (const program::OwnVerb& verb : program::ownVerbs)
    if (argc > 1 && std::string(argv[1]) == verb.name) return verb.act(argc - 1, argv + 1);
  CLI::App app(
      "Runs scenes of grains and solids. Exit codes: 0 done, 1 broke down or differs, 2 refused, 128 + n ended by "
      "signal n, 142 when the time of --max-wall-seconds was up.");
  app.set_version_flag("--version", "dovetail " + io::buildInfo().version + " " + io::buildInfo().commit);
  app.require_subcommand(1);
  Options options;
  const std::vector<Verb> verbs = addVerbs(app, options);
  const Verb* const verb = parse(app, verbs, argc, argv);
  return !verb || verb->act() == 0;
}

}  // namespace

int main(int argc, char** argv) {
  return program::runProgram("dovetail", [&] { return act(argc, argv); });
}
