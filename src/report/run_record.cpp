#include "dovetail/report/run_record.hpp"

#include <fstream>
#include <sstream>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/report/table.hpp"

namespace dovetail::report {

namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
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

}  // namespace

void readSummaryJson(const std::string& text, const std::string& where, RunRecord& record) {
  try {
    const Json json = Json::parse(text);
    if (!json.is_object()) throw InputError("this is no summary of a run", where, "remove it");
    for (const auto& [key, value] : json.items())
      if (const std::string figure = textOf(value); !figure.empty()) record.figures.emplace_back(key, figure);
    if (json.contains("failure") && textOf(json["failure"]) != "") record.warnings.push_back(textOf(json["failure"]));
    for (const Json& row : json.value("ledger", Json::array()))
      record.channels.push_back({row.at("channel"),
                                 row.at("kind") == "booked" ? EnergyLedger::Kind::booked : EnergyLedger::Kind::stored,
                                 row.at("at_end_J"), row.at("at_opening_J")});
    for (const Json& row : json.value("profile", Json::array()))
      record.stages.push_back({row.at("stage"), row.at("seconds"), row.at("calls")});
    if (record.scene.empty() && json.contains("settings")) record.scene = json["settings"].dump(2) + "\n";
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
