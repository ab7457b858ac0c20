#include "common/curves.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::benchmark {

namespace fs = std::filesystem;

std::vector<NamedFile> filesNamed(const std::string& folder, const std::string& head, const std::string& tail) {
  std::vector<NamedFile> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.size() < head.size() + tail.size() || !name.starts_with(head) || !name.ends_with(tail)) continue;
    files.push_back({entry.path(), name.substr(head.size(), name.size() - head.size() - tail.size())});
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return files;
}

double numberInName(const std::string& text, const fs::path& file, const std::string& example) {
  double value = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size() || !(value >= 0.0) || !std::isfinite(value))
    throw InputError("'" + text + "' is no number", file.string(), "name the file as in " + example);
  return value;
}

std::vector<std::vector<double>> readColumns(const fs::path& file, const std::vector<std::string>& names) {
  const io::TimeSeries table = io::readCsv(file);
  if (table.rows() == 0) throw InputError("there are no rows", file.string(), "restore the file");
  std::vector<std::vector<double>> columns;
  for (const std::string& name : names) {
    if (std::find(table.names().begin(), table.names().end(), name) == table.names().end())
      throw InputError("column " + name + " is missing", file.string(), "restore the file");
    const auto column = table.column(name);
    for (std::size_t row = 0; row < column.size(); ++row)
      if (!std::isfinite(column[row]))
        throw InputError("a value of " + name + " in row " + std::to_string(row + 1) + " is not finite", file.string(),
                         "restore the file");
    columns.emplace_back(column.begin(), column.end());
  }
  return columns;
}

}  // namespace dovetail::benchmark
