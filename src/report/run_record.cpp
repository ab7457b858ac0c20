#include "dovetail/report/run_record.hpp"

#include <cmath>
#include <fstream>
#include <sstream>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/report/summary.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::report {

namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
  std::ifstream stream = openFile(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw InputError("the file cannot be read", file.string(), "look at its permissions");
  return text.str();
}

/// Entries of the leading lines "<mark>key: value".
io::KeyValues provenanceOf(const std::string& text, const std::string& mark) {
  io::KeyValues entries;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line) && line.starts_with(mark);) {
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos)
      entries.emplace_back(line.substr(mark.size(), colon - mark.size()), line.substr(colon + 2));
  }
  return entries;
}

void takeScene(const std::string& text, RunRecord& record) {
  if (record.provenance.empty()) record.provenance = provenanceOf(text, "// ");
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("// ")) record.scene += line + "\n";
  const Json json = Json::parse(record.scene, nullptr, false, true);
  if (json.is_object() && json.contains("title") && json["title"].is_string()) record.title = json["title"];
}

void addFigure(RunRecord& record, const std::string& name, const Json& value) {
  if (const std::string figure = textOf(value); !figure.empty()) record.figures.emplace_back(name, figure);
}

double numberOf(const Json& value) { return value.is_number() ? value.get<double>() : std::nan(""); }

void takeEnergy(const Json& energy, RunRecord& record) {
  for (const auto& [name, row] : energy.at("channels").items())
    record.channels.push_back({name,
                               row.at("kind") == "booked" ? EnergyLedger::Kind::booked : EnergyLedger::Kind::stored,
                               numberOf(row.at("now_J")), numberOf(row.at("at_start_J"))});
  record.residual = numberOf(energy.at("residual_J"));
  addFigure(record, "largest residual of the energy (J)", energy.at("largest_residual_J"));
}

void takeMomentum(const Json& momentum, RunRecord& record) {
  const char* const axes[] = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k)
    addFigure(record, std::string("residual of the momentum, ") + axes[k] + " (Ns)",
              momentum.at("residual").at("linear_Ns").at(k));
  addFigure(record, "sum of all impulses (Ns)", momentum.at("turned_over_Ns"));
  addFigure(record, "residual of the mass (kg)", momentum.at("mass_residual_kg"));
}

void takeStep(const Json& step, RunRecord& record) {
  addFigure(record, "step (s)", step.at("dt_s"));
  addFigure(record, "critical step at the end (s)", step.at("limit_s"));
  addFigure(record, "set by", step.at("limited_by"));
}

void takeTimes(const Json& times, RunRecord& record) {
  for (const Json& stage : times.value("stages", Json::array()))
    addFigure(record, "seconds of stage " + textOf(stage.at("stage")) + " (" + textOf(stage.at("do")) + ")",
              stage.at("seconds"));
  for (const Json& row : times.at("parts"))
    record.stages.push_back({row.at("part"), numberOf(row.at("seconds")), row.at("calls")});
}

void takeResults(const Json& results, RunRecord& record) {
  for (const auto& [key, value] : results.items()) addFigure(record, key, value);
  if (const std::string failure = textOf(results.value("failure", Json())); !failure.empty())
    record.warnings.push_back(failure);
}

void takeSummary(const Json& json, RunRecord& record) {
  constexpr std::pair<const char*, void (*)(const Json&, RunRecord&)> parts[] = {{"energy", takeEnergy},
                                                                                 {"momentum", takeMomentum},
                                                                                 {"step", takeStep},
                                                                                 {"times", takeTimes},
                                                                                 {"results", takeResults}};
  for (const auto& [part, take] : parts)
    if (json.contains(part)) take(json[part], record);
  for (const Json& line : json.value("warnings", Json::array())) record.warnings.push_back(line);
  for (const Json& line : json.value("notes", Json::array())) record.notes.push_back(line);
  if (json.contains("particles"))
    record.notes.push_back((json["particles"] == 0 ? std::string() : textOf(json["particles"]) + " particles at ") +
                           format("t = %.5g s", numberOf(json.at("time_s"))));
  if (record.scene.empty()) record.scene = json.value("settings", json.value("scene", Json())).dump(2) + "\n";
}

}  // namespace

RunRecord readRunFolder(const fs::path& folder) {
  RunRecord record;
  std::error_code error;
  const auto there = [&](const char* name) { return fs::is_regular_file(folder / name, error); };
  if (!there("series.csv") && !there("scene.json") && !there("summary.json"))
    throw InputError("there is no series.csv, scene.json or summary.json", folder.string(),
                     "give the folder that a run wrote into");
  record.title = fs::absolute(folder / ".").lexically_normal().parent_path().filename().string();
  if (there("series.csv")) {
    record.series = io::readCsv(folder / "series.csv");
    record.provenance = provenanceOf(contentOf(folder / "series.csv"), "# ");
  }
  if (there("modes.csv")) record.modes = io::readCsv(folder / "modes.csv");
  if (there("scene.json")) takeScene(contentOf(folder / "scene.json"), record);
  record.finished = there("summary.json");
  if (record.finished) try {
      takeSummary(readSummary(folder / "summary.json"), record);
    } catch (const Json::exception& wrong) {
      throw InputError(wrong.what(), (folder / "summary.json").string(), "run again");
    }
  if (there("summary.txt")) {
    std::istringstream lines(contentOf(folder / "summary.txt"));
    for (std::string line; std::getline(lines, line);)
      if (!line.starts_with("#")) record.summary += line + "\n";
  }
  return record;
}

}  // namespace dovetail::report
