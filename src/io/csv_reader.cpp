#include <optional>

#include "dovetail/core/error.hpp"
#include "dovetail/io/csv_table.hpp"
#include "dovetail/io/names.hpp"
#include "dovetail/io/text_source.hpp"

namespace dovetail::io {

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

/// "x [m]" and "v (m/s)" as columns are named here; empty if it is no name with a unit in brackets.
std::string nameWithUnit(const std::string& name) {
  const std::size_t open = name.find_first_of("[("), close = name.find_first_of("])");
  if (open == std::string::npos || close == std::string::npos || close < open) return "";
  std::string plain = name.substr(0, name.find_last_not_of(" [(", open) + 1) + "_";
  for (const char c : name.substr(open + 1, close - open - 1)) plain += c == '/' ? "_per_" : std::string(1, c);
  std::erase_if(plain, [](char c) { return c == '^' || c == '*' || c == ' '; });
  return isPlainName(plain) ? plain : "";
}

TimeSeries tableOf(const std::vector<std::string>& names, const std::string& where) {
  if (names.size() == 1 && names[0].find_first_of("; \t") != std::string::npos)
    throw InputError("the names of columns are not separated by commas", where,
                     "write a,b,… and numbers with decimal points");
  for (const std::string& name : names)
    if (const std::string plain = nameWithUnit(name); !plain.empty())
      throw InputError("the name " + shown(name) + " cannot be used", where, "write " + plain);
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

/// The next line that is no comment and not empty; false at the end.
class Lines {
public:
  explicit Lines(const std::filesystem::path& path)
      : bytes_(readWhole(path, "a table")), text_(plainText(bytes_, path.string(), room_), path.string()) {}

  bool next(std::string& line) {
    while (!text_.atEnd()) {
      line = text_.line();
      ++number_;
      if (line.find('\0') != std::string::npos)
        throw InputError("the line holds bytes that are zero", where(), "save the table as a text in UTF-8");
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (line.starts_with('#')) comment_ = line;
      if (!line.empty() && line.front() != '#') return true;
    }
    return false;
  }
  std::size_t number() const { return number_; }
  std::string where() const { return text_.name() + ", line " + std::to_string(number_); }
  const std::string& lastComment() const { return comment_; }

private:
  std::string bytes_, room_, comment_;
  TextSource text_;
  std::size_t number_ = 0;
};

double parseNumber(const std::string& field, const Lines& lines) {
  double value = 0.0;
  if (!isNumber(field, value))
    throw InputError(shown(field) + " is not a number", lines.where(), "write a number such as 1.5e-3, without blanks");
  return value;
}

}  // namespace

CsvTable readCsvTable(const std::filesystem::path& path) {
  Lines lines(path);
  std::optional<TimeSeries> series;  // none until the line of names has been read
  std::vector<std::size_t> numbers;
  std::vector<double> row;
  for (std::string line; lines.next(line);) {
    const std::vector<std::string> fields = split(line);
    if (!series) {
      const bool named = !isRow(fields);
      const std::vector<std::string> names = named ? fields : namesIn(lines.lastComment());
      if (names.size() != fields.size())
        throw InputError("the table begins with numbers, not with the names of its columns", lines.where(),
                         "write the names in its first line");
      series = tableOf(names, lines.where());
      if (named) continue;
    }
    const std::size_t columns = series->names().size();
    if (fields.size() != columns)
      throw InputError("a row has " + std::to_string(fields.size()) + " values", lines.where(),
                       "give " + std::to_string(columns) + ", one per column");
    row.clear();
    for (const std::string& field : fields) row.push_back(parseNumber(field, lines));
    series->append(row);
    numbers.push_back(lines.number());
  }
  if (!series) throw InputError("a table has no line of names", path.string(), "write the names in its first line");
  return {std::move(*series), std::move(numbers)};
}

TimeSeries readCsv(const std::filesystem::path& path) { return readCsvTable(path).series; }

}  // namespace dovetail::io
