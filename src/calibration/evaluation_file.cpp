#include "evaluation_file.hpp"

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/scene/files.hpp"

namespace dovetail::calibration {

using Json = nlohmann::ordered_json;

namespace {
/// JSON has no word for what is no number: null.
double numberIn(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}
}  // namespace

std::map<std::string, Outcome> readEvaluations(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / evaluationFileName;
  std::map<std::string, Outcome> known;
  std::ifstream stream = openFile(file);
  if (!stream) return known;
  try {
    const Json json = Json::parse(stream);
    for (const auto& [name, entry] : json.at("evaluations").items()) {
      Outcome outcome;
      for (const auto& [key, value] : entry.at("numbers").items()) outcome.numbers[key] = numberIn(value);
      for (const auto& [key, curve] : entry.at("curves").items())
        for (const Json& value : curve) outcome.curves[key].push_back(numberIn(value));
      entry.at("over").get_to(outcome.abscissa);
      entry.at("failure").get_to(outcome.failure);
      entry.at("seconds").get_to(outcome.seconds);
      known[name] = std::move(outcome);
    }
  } catch (const Json::exception& error) {
    throw InputError(std::string("the file is no record of evaluations: ") + error.what(), file.string(),
                     "remove it, or give another folder by --out");
  }
  return known;
}

void writeEvaluations(const std::filesystem::path& folder, const std::map<std::string, Outcome>& known) {
  Json json;
  for (const auto& [key, value] : io::provenance()) json[key] = value;
  Json& entries = json["evaluations"] = Json::object();
  for (const auto& [name, outcome] : known)
    entries[name] = {{"numbers", outcome.numbers},
                     {"over", outcome.abscissa},
                     {"curves", outcome.curves},
                     {"failure", outcome.failure},
                     {"seconds", outcome.seconds}};
  io::writeFileAtomically(folder / evaluationFileName, json.dump(1) + "\n", Survives::kills);
}

std::string textOfProbe(const Experiment& experiment) {
  Experiment probe = experiment;
  probe.name = probe.scene = "";
  probe.set.clear();
  return scene::textOf([&](scene::Fields& f) { describe(f, probe); });
}

std::string buildName() { return io::buildInfo().version + " " + io::buildInfo().commit; }

}  // namespace dovetail::calibration
