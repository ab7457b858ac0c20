// dovetail calibrate: parameters of grains from measurements, continua from grains, widths and lengths from a measure.
#include "dovetail/calibration/calibrate.hpp"

#include <iostream>
#include <memory>

#include "dovetail/core/error.hpp"
#include "dovetail/io/interruption.hpp"
#include "dovetail/io/output_folder.hpp"
#include "verbs.hpp"

namespace dovetail::program {

namespace {

struct Options {
  std::string file, out;
  std::vector<std::string> settings;
  int rehearsals = 0;
  std::uint64_t seed = 1;
  bool schema = false, keys = false;
};

int act(const Options& options) {
  if (options.schema || options.keys) {
    std::cout << (options.schema ? calibration::schemaText() : calibration::referenceText());
    return 0;
  }
  if (options.file.empty()) throw InputError("FILE is missing", "dovetail calibrate", "name a calibration file");
  const calibration::Calibration file = calibration::readCalibration(options.file, options.settings);
  const std::filesystem::path folder =
      options.out.empty() ? std::filesystem::path(options.file).stem().string() + "-calibration" : options.out;
  io::prepareOutputFolder(folder, {"calibration.txt", "calibration.json"});
  const calibration::CalibrationResult result = calibration::calibrate(
      file, {.folder = folder, .rehearsals = options.rehearsals, .seed = options.seed}, std::cerr);
  calibration::writeReports(folder, file, result);
  std::cout << reportOf(file, result);
  if (result.interrupted) return 128 + io::interruption();
  return result.whyStopped.empty() && (!result.fit || result.fit->converged) ? 0 : 1;
}

}  // namespace

Verb addCalibrate(CLI::App& app) {
  CLI::App* const verb = app.add_subcommand(
      "calibrate", "continuum of a packing, grain parameters from measurements, or the best widths and lengths");
  const auto options = std::make_shared<Options>();
  verb->add_option("FILE", options->file, "calibration file (JSON), see docs/calibration.md");
  verb->add_option("--set", options->settings, "key=value: a parameter of \"let\", or a path such as tolerance")
      ->expected(1)
      ->take_all();
  verb->add_option("--out", options->out, "folder for all files; <file>-calibration if not given");
  verb->add_option("--rehearse", options->rehearsals,
                   "number of rehearsals: fits of targets that are simulated at the parameters' starts, with noise")
      ->check(CLI::Range(1, 10000));
  verb->add_option("--seed", options->seed, "of the noise")->capture_default_str();
  verb->add_flag("--schema", options->schema, "prints the JSON Schema of calibration files");
  verb->add_flag("--keys", options->keys, "prints a reference of all their keys");
  return {verb, [options] { return act(*options); }};
}

}  // namespace dovetail::program
