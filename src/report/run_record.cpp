#include "dovetail/report/run_record.hpp"

#include <cmath>
#include <fstream>
#include <sstream>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/report/table.hpp"

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

void addChannel(RunRecord& record, const std::string& name, const Json& row, const char* before, const char* now) {
  record.channels.push_back({name, row.at("kind") == "booked" ? EnergyLedger::Kind::booked : EnergyLedger::Kind::stored,
                             numberOf(row.at(now)), numberOf(row.at(before))});
}

void takeSceneSummary(const Json& json, RunRecord& record) {
  const Json& energy = json.at("energy");
  for (const auto& [name, row] : energy.at("channels").items()) addChannel(record, name, row, "at_start_J", "now_J");
  record.residual = numberOf(energy.at("residual_J"));
  addFigure(record, "largest residual of the energy (J)", energy.at("largest_residual_J"));
  const Json& momentum = json.at("momentum");
  const char* const axes[] = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k)
    addFigure(record, std::string("residual of the momentum, ") + axes[k] + " (Ns)",
              momentum.at("residual").at("linear_Ns").at(k));
  addFigure(record, "sum of all impulses (Ns)", momentum.at("turned_over_Ns"));
  addFigure(record, "residual of the mass (kg)", momentum.at("mass_residual_kg"));
  const Json& step = json.at("step");
  addFigure(record, "step (s)", step.at("dt_s"));
  addFigure(record, "critical step at the end (s)", step.at("limit_s"));
  addFigure(record, "set by", step.at("limited_by"));
  for (const Json& stage : json.at("times").at("stages"))
    addFigure(record, "seconds of stage " + textOf(stage.at("stage")) + " (" + textOf(stage.at("do")) + ")",
              stage.at("seconds"));
  for (const Json& row : json.at("times").at("parts"))
    record.stages.push_back({row.at("part"), numberOf(row.at("seconds")), row.at("calls")});
  for (const Json& line : json.at("warnings")) record.warnings.push_back(line);
}

void takeBenchmarkSummary(const Json& json, RunRecord& record) {
  for (const auto& [key, value] : json.items()) addFigure(record, key, value);
  if (json.contains("failure") && textOf(json["failure"]) != "") record.warnings.push_back(textOf(json["failure"]));
  for (const Json& row : json.value("ledger", Json::array()))
    addChannel(record, row.at("channel"), row, "at_opening_J", "at_end_J");
  for (const Json& row : json.value("profile", Json::array()))
    record.stages.push_back({row.at("stage"), row.at("seconds"), row.at("calls")});
  if (record.scene.empty() && json.contains("settings")) record.scene = json["settings"].dump(2) + "\n";
}

}  // namespace

void readSummaryJson(const std::string& text, const std::string& where, RunRecord& record) {
  try {
    const Json json = Json::parse(text);
    if (!json.is_object()) throw InputError("this is no summary of a run", where, "remove it");
    if (json.contains("energy"))
      takeSceneSummary(json, record);
    else
      takeBenchmarkSummary(json, record);
  } catch (const Json::exception& error) {
    throw InputError(error.what(), where, "remove it, or run again");
  }
}

RunRecord readRunFolder(const fs::path& folder) {
  RunRecord record;
  std::error_code error;
  const auto there = [&](const char* name) { return fs::is_regular_file(folder / name, error); };
  if (!there("series.csv") && !there("scene.json") && !there("summary.json") && !there("summary.txt"))
    throw InputError("there is no series.csv, scene.json or summary of a run", folder.string(),
                     "give the folder that a run wrote into");
  record.title = fs::absolute(folder / ".").lexically_normal().parent_path().filename().string();
  if (there("series.csv")) {
    record.series = io::readCsv(folder / "series.csv");
    record.provenance = provenanceOf(contentOf(folder / "series.csv"), "# ");
  }
  if (there("scene.json")) takeScene(contentOf(folder / "scene.json"), record);
  record.finished = there("summary.json") || there("summary.txt");
  if (there("summary.json"))
    readSummaryJson(contentOf(folder / "summary.json"), (folder / "summary.json").string(), record);
  if (there("summary.txt")) {
    RunRecord told;
    readSummaryText(contentOf(folder / "summary.txt"), told);
    record.summary = told.summary;
    if (record.figures.empty()) record.figures = told.figures;
    if (record.channels.empty()) {
      record.channels = told.channels;
      record.residual = told.residual;
    }
    if (record.stages.empty()) record.stages = told.stages;
    if (record.warnings.empty()) record.warnings = told.warnings;
    record.notes = told.notes;
  }
  std::erase(record.notes, record.title);
  return record;
}

}  // namespace dovetail::report
