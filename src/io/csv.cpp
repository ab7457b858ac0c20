#include <charconv>
#include <fstream>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::io {

namespace {

std::string linesOf(const TimeSeries& series, std::size_t firstRow) {
  std::string text;
  const std::size_t columns = series.names().size();
  for (std::size_t row = firstRow; row < series.rows(); ++row)
    for (std::size_t i = 0; i < columns; ++i) {
      text += formatNumber(series.column(i)[row]);
      text += i + 1 < columns ? ',' : '\n';
    }
  return text;
}

}  // namespace

void writeCsv(const std::filesystem::path& path, const TimeSeries& series, const KeyValues& provenance) {
  std::string text = provenanceLines(withMark(provenance), "# ");
  const std::size_t columns = series.names().size();
  for (std::size_t i = 0; i < columns; ++i) text += series.names()[i] + (i + 1 < columns ? "," : "\n");
  writeFileAtomically(path, text + linesOf(series, 0));
}

void GrowingCsv::write(const TimeSeries& series) {
  if (rows_ == 0)
    writeCsv(path_, series, provenance_);
  else if (rows_ < series.rows())
    appendToFile(path_, linesOf(series, rows_), isOurs);
  rows_ = series.rows();
}

namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::size_t begin = 0;
  for (std::size_t comma = line.find(','); comma != std::string::npos; comma = line.find(',', begin)) {
    fields.push_back(line.substr(begin, comma - begin));
    begin = comma + 1;
  }
  fields.push_back(line.substr(begin));
  return fields;
}

double parseNumber(const std::string& field, const std::string& where) {
  double value = 0.0;
  const char* end = field.data() + field.size();
  const auto result = std::from_chars(field.data(), end, value);
  if (result.ec != std::errc{} || result.ptr != end)
    throw InputError("'" + field + "' is not a number", where, "write a number such as 1.5e-3, without blanks");
  return value;
}

}  // namespace

TimeSeries readCsv(const std::filesystem::path& path) {
  std::ifstream file = openFile(path);
  if (!file)
    throw InputError("a table cannot be read", path.string(), "give a CSV file that exists");
  std::vector<TimeSeries> series;  // none until the line of names has been read
  std::vector<double> row;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    const std::string where = path.string() + ", line " + std::to_string(++number);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string> fields = split(line);
    if (series.empty()) {
      series.emplace_back(fields);
      continue;
    }
    const std::size_t columns = series.front().names().size();
    if (fields.size() != columns)
      throw InputError("a row has " + std::to_string(fields.size()) + " values", where,
                       "give " + std::to_string(columns) + ", one per column");
    row.clear();
    for (const std::string& field : fields) row.push_back(parseNumber(field, where));
    series.front().append(row);
  }
  if (series.empty())
    throw InputError("a table has no line of names", path.string(), "write the names in its first line");
  return std::move(series.front());
}

}  // namespace dovetail::io
