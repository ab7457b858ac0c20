#include "results.hpp"

#include <cmath>
#include <fstream>

#include "dovetail/core/error.hpp"

namespace dovetail::atlas {

namespace {

using report::Json;

/// null if there is no such file
Json readJson(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return nullptr;
  Json json = Json::parse(file, nullptr, false);
  if (json.is_discarded()) throw InputError("the file is no JSON", path.string(), "run scripts/atlas anew");
  return json;
}

}  // namespace

std::vector<Result> readResults(const std::filesystem::path& folder) {
  const Json runs = readJson(folder / "runs.json");
  if (!runs.is_array())
    throw InputError("there is no list of studies", (folder / "runs.json").string(), "run scripts/atlas");
  std::vector<Result> results;
  for (const Json& run : runs)
    results.push_back({.id = wordOf(run, "id"),
                       .command = wordOf(run, "command"),
                       .seconds = numberOf(run, "seconds"),
                       .status = run.value("status", 1),
                       .content = readJson(folder / wordOf(run, "result"))});
  return results;
}

const Result* find(const std::vector<Result>& results, const std::string& id) {
  for (const Result& result : results)
    if (result.id == id && !result.content.is_null()) return &result;
  return nullptr;
}

double numberOf(const Json& row, const std::string& key) {
  return row.contains(key) && row[key].is_number() ? row[key].get<double>() : std::nan("");
}

std::string wordOf(const Json& row, const std::string& key) {
  return row.contains(key) && row[key].is_string() ? row[key].get<std::string>() : "";
}

}  // namespace dovetail::atlas
