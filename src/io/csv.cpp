#include <charconv>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/plain_text.hpp"
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

bool isNumber(std::string_view field, double& value) {
  if (field.size() > 1 && field.front() == '+' && field[1] != '-') field.remove_prefix(1);
  const auto result = std::from_chars(field.data(), field.data() + field.size(), value);
  return result.ec == std::errc{} && result.ptr == field.data() + field.size();
}

double parseNumber(const std::string& field, const std::string& where) {
  double value = 0.0;
  if (!isNumber(field, value))
    throw InputError("'" + field + "' is not a number", where, "write a number such as 1.5e-3, without blanks");
  return value;
}

TimeSeries tableOf(const std::vector<std::string>& names, const std::string& where) {
  if (names.size() == 1 && names[0].find_first_of("; \t") != std::string::npos)
    throw InputError("the names of columns are not separated by commas", where,
                     "write a,b,… and numbers with decimal points");
  try {
    return TimeSeries(names);
  } catch (const InputError& error) {
    throw InputError(error.what(), where, "");
  }
}

/// Whether a line begins with a number: then the names may stand in the comment before it, as NumPy writes them.
bool isRow(const std::vector<std::string>& fields) {
  double value = 0.0;
  return isNumber(fields.front(), value);
}

std::vector<std::string> namesIn(std::string comment) {
  comment.erase(0, std::min(comment.size(), comment.find_first_not_of("# \t")));
  std::vector<std::string> names = split(comment);
  for (std::string& name : names) name.erase(0, std::min(name.size(), name.find_first_not_of(" \t")));
  return names;
}

std::string linesOfFile(const std::filesystem::path& path) {
  std::ifstream file = openFile(path);
  if (!file) throw InputError("a table cannot be read", path.string(), "give a CSV file that exists");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  text.erase(0, text.size() - withoutByteOrderMark(text, path.string()).size());
  endLinesWithLf(text);
  return text;
}

}  // namespace

TimeSeries readCsv(const std::filesystem::path& path) {
  std::istringstream text(linesOfFile(path));
  std::optional<TimeSeries> series;  // none until the line of names has been read
  std::vector<double> row;
  std::string comment;
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    const std::string where = path.string() + ", line " + std::to_string(++number);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.starts_with('#')) comment = line;
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string> fields = split(line);
    if (!series) {
      const bool named = !isRow(fields);
      if (!named && namesIn(comment).size() != fields.size())
        throw InputError("the table begins with numbers, not with the names of its columns", where,
                         "write the names in its first line");
      series = tableOf(named ? fields : namesIn(comment), where);
      if (named) continue;
    }
    const std::size_t columns = series->names().size();
    if (fields.size() != columns)
      throw InputError("a row has " + std::to_string(fields.size()) + " values", where,
                       "give " + std::to_string(columns) + ", one per column");
    row.clear();
    for (const std::string& field : fields) row.push_back(parseNumber(field, where));
    series->append(row);
  }
  if (!series) throw InputError("a table has no line of names", path.string(), "write the names in its first line");
  return std::move(*series);
}

}  // namespace dovetail::io
