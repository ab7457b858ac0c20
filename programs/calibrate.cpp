// dovetail calibrate: parameters of grains from measurements, continua from grains, widths and lengths from a measure.
#include "dovetail/calibration/calibrate.hpp"

#include <iostream>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "program/options.hpp"
#include "verbs.hpp"

namespace dovetail::program {

bool calibrate(int argc, char** argv) {
  std::string name, out;
  std::vector<std::string> settings;
  std::optional<int> rehearsals;
  std::uint64_t seed = 1;
  bool schema = false, keys = false;
  Options options("dovetail calibrate",
                  "Continuum of a packing, grain parameters from measurements, or the best widths and lengths.");
  options.text("FILE", name, "calibration file (JSON), see docs/calibration.md");
  options.texts("--set KEY=VALUE", settings, "a parameter of \"let\", or a path such as tolerance");
  options.text("--out DIR", out, "folder for all files; <file>-calibration if not given");
  options.integer("--rehearse N", rehearsals, 1, 10000,
                  "number of rehearsals: fits of targets that are simulated at the parameters' starts, with noise");
  options.number("--seed N", seed, notNegative("a whole number"), "of the noise");
  options.flag("--schema", schema, "prints the JSON Schema of calibration files");
  options.flag("--keys", keys, "prints a reference of all their keys");
  if (!options.parse(argc, argv)) return true;
  if (schema || keys) {
    std::cout << (schema ? calibration::schemaText() : calibration::referenceText());
    return true;
  }
  if (name.empty()) throw InputError("FILE is missing", "dovetail calibrate", "name a calibration file");
  const calibration::Calibration file = calibration::readCalibration(name, settings);
  const std::filesystem::path folder = out.empty() ? std::filesystem::path(name).stem().string() + "-calibration" : out;
  io::prepareOutputFolder(folder, {"calibration.txt", "calibration.json"});
  const calibration::CalibrationResult result =
      calibration::calibrate(file, {.folder = folder, .rehearsals = rehearsals.value_or(0), .seed = seed}, std::cerr);
  calibration::writeReports(folder, file, result);
  std::cout << reportOf(file, result);
  return !result.interrupted && result.whyStopped.empty() && (!result.fit || result.fit->converged);
}

}  // namespace dovetail::program
