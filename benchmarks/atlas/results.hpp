// What the studies of the atlas have left.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dovetail/report/page.hpp"
#include "dovetail/report/table.hpp"

namespace dovetail::atlas {

/// A study that was run, as a line of runs.json.
struct Result {
  std::string id;       ///< "cantilever-pareto"
  std::string command;  ///< as it can be written in the root of the project
  double seconds = 0.0;
  int status = 0;        ///< exit status of the command
  report::Json content;  ///< of its JSON file; null if it left none
};

/// Reads runs.json in the folder: [{"id", "command", "seconds", "status", "result"}, …], and the files named by
/// "result", relative to the folder.
/// @throws InputError if a file is damaged, or there is no runs.json
std::vector<Result> readResults(const std::filesystem::path& folder);

/// The result of that name with a content, or null.
const Result* find(const std::vector<Result>& results, const std::string& id);

double numberOf(const report::Json& row, const std::string& key);     ///< nan unless it is one
std::string wordOf(const report::Json& row, const std::string& key);  ///< "" unless it is text

/// A section of the page, and the same numbers as rows.
struct Chapter {
  std::vector<report::Section> sections;
  std::vector<report::Json> rows;
};

/// Error against run time, case by case, with the front.
Chapter frontsOf(const std::vector<Result>& results);
/// What became of stiff and extreme cases, with the command that repeats each.
Chapter mapsOf(const std::vector<Result>& results);
/// What scenes pay.
Chapter overheadOf(const std::vector<Result>& results);

}  // namespace dovetail::atlas
