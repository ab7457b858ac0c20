#include "dovetail/scene/compare.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <map>
#include <ostream>
#include <set>

#include "comparing.hpp"
#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::scene {

namespace {

namespace fs = std::filesystem;

/// Columns with one scale: energies, and the components of a vector. "on_plate_x_N" → "on_plate__N"
std::string familyOf(const std::string& column) {
  if (io::unitOf(column) == "J") return "J";
  std::string family = column;
  for (const char* const axis : {"x_", "y_", "z_"})
    for (std::size_t at = family.find(axis); at != std::string::npos; at = family.find(axis, at + 1)) {
      const bool begins = at == 0 || family[at - 1] == '_' ||
                          ((family[at - 1] == 'v' || family[at - 1] == 'u') && at > 1 && family[at - 2] == '_');
      if (begins) return family.erase(at, 1);
    }
  return family;
}

/// Value of a column at a time between two rows. @param after  the first row that is not before it
double valueAt(std::span<const double> times, std::span<const double> column, double time, std::size_t after) {
  if (times[after] == time || after == 0) return column[after];
  const double fraction = (time - times[after - 1]) / (times[after] - times[after - 1]);
  return (1.0 - fraction) * column[after - 1] + fraction * column[after];
}

class TableComparison {
public:
  TableComparison(const io::TimeSeries& a, const io::TimeSeries& b, std::string name, Comparison& to)
      : a_(a), b_(b), name_(std::move(name)), to_(to) {
    std::vector<std::string> common;
    for (const std::string& column : a.names())
      if (has(b, column))
        common.push_back(column);
      else
        to_.unlike.push_back(name_ + " has a column " + column + " in the first only.");
    for (const std::string& column : b.names())
      if (!has(a, column)) to_.unlike.push_back(name_ + " has a column " + column + " in the second only.");
    if (!has(a, "time_s") || !has(b, "time_s")) {
      to_.unlike.push_back(name_ + " has no column time_s.");
      return;
    }
    for (const io::TimeSeries* const table : {&a, &b})
      for (const std::string& column : common)
        for (const double value : table->column(column))
          if (std::isfinite(value)) scale_[familyOf(column)] = std::max(scale_[familyOf(column)], std::abs(value));
    matchRows();
    for (const std::string& column : common) compareColumn(column);
  }

private:
  static bool has(const io::TimeSeries& table, const std::string& column) {
    return std::find(table.names().begin(), table.names().end(), column) != table.names().end();
  }
  /// Of each row of the first within the times of the second: the row that is not before it there. Rows of one time,
  /// as load steps make them, meet in their order.
  void matchRows() {
    const auto times = a_.column("time_s"), others = b_.column("time_s");
    bool equal = times.size() == others.size();
    std::size_t outside = 0;
    std::ptrdiff_t again = 0;
    for (std::size_t k = 0; k < times.size(); ++k) {
      auto after = std::lower_bound(others.begin(), others.end(), times[k]);
      again = k > 0 && times[k] == times[k - 1] ? again + 1 : 0;
      for (std::ptrdiff_t n = 0; n < again && after + 1 != others.end() && after[1] == times[k]; ++n) ++after;
      if (after == others.end() || (after == others.begin() && *after != times[k])) {
        ++outside;
        continue;
      }
      equal = equal && *after == times[k];
      rows_.emplace_back(k, static_cast<std::size_t>(after - others.begin()));
    }
    if (equal) return;
    to_.unlike.push_back(name_ + " has rows at other times (" + std::to_string(times.size()) + " and " +
                         std::to_string(others.size()) + "): compared by interpolation over the common times" +
                         (outside > 0 ? ", which leaves out " + std::to_string(outside) + " of the first." : "."));
  }
  void compareColumn(const std::string& column) {
    const auto times = a_.column("time_s"), others = b_.column("time_s"), x = a_.column(column), y = b_.column(column);
    Difference found{name_ + " " + column, 0.0, scale_[familyOf(column)], ""};
    for (const auto& [row, after] : rows_) {
      const double difference = apart(x[row], valueAt(others, y, times[row], after));
      if (!(difference > found.largest)) continue;
      found.largest = difference;
      found.where = "t = " + formatNumber(times[row]) + " s";
    }
    to_.differences.push_back(std::move(found));
  }

  const io::TimeSeries &a_, &b_;
  std::string name_;
  Comparison& to_;
  std::map<std::string, double> scale_;
  std::vector<std::pair<std::size_t, std::size_t>> rows_;
};

bool isSeries(const fs::path& file) { return file.extension() == ".csv" || file.extension() == ".h5"; }
io::TimeSeries readSeries(const fs::path& file) {
  return file.extension() == ".h5" ? readSeriesHdf5(file) : io::readCsv(file);
}

void compareFiles(const fs::path& a, const fs::path& b, const std::string& name, Comparison& to) {
  if (isSeries(a) && isSeries(b)) {
    const io::TimeSeries first = readSeries(a), second = readSeries(b);
    TableComparison(first, second, name, to);
  } else if (isFrameFile(a) && a.extension() == b.extension()) {
    compareFrames(a, b, name, to);
  } else if (a.extension() == ".state" && b.extension() == ".state") {
    if (headOf(a, fs::file_size(a)) != headOf(b, fs::file_size(b)))
      to.unlike.push_back(name + " differs in its bytes.");
  } else {
    throw InputError("files of these kinds cannot be compared", a.string() + ", " + b.string(),
                     "give two series, frames or states of one kind, or two folders of runs");
  }
}

/// Of files of a run that can be compared; series.h5 holds what series.csv holds.
std::set<std::string> namesIn(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename() == "series.csv" || entry.path().extension() == ".pvd")
      names.insert(entry.path().filename().string());
  return names;
}

}  // namespace

double apart(double a, double b) {
  if (std::isnan(a) != std::isnan(b)) return std::numeric_limits<double>::infinity();
  return a == b || std::isnan(a) ? 0.0 : std::abs(a - b);
}

double Difference::relative() const {
  return scale > 0.0 ? largest / scale : largest > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

bool Comparison::within(double tolerance) const {
  return unlike.empty() && std::all_of(differences.begin(), differences.end(),
                                       [&](const Difference& d) { return d.relative() <= tolerance; });
}

Comparison compare(const fs::path& a, const fs::path& b) {
  std::error_code error;
  for (const fs::path& path : {a, b})
    if (!fs::exists(path, error))
      throw InputError("there is no such file or folder", path.string(), "correct its name");
  Comparison comparison;
  if (!fs::is_directory(a, error) && !fs::is_directory(b, error)) {
    compareFiles(a, b, a.stem().string(), comparison);
    return comparison;
  }
  if (!fs::is_directory(a, error) || !fs::is_directory(b, error))
    throw InputError("a file cannot be compared with a folder", a.string() + ", " + b.string(),
                     "give two files or two folders");
  const std::set<std::string> first = namesIn(a), second = namesIn(b);
  std::set<std::string> all = first;
  all.insert(second.begin(), second.end());
  if (all.empty())
    throw InputError("there is nothing to compare", a.string() + ", " + b.string(),
                     "give folders of runs with output.series or output.frames");
  for (const std::string& name : all)
    if (first.contains(name) && second.contains(name))
      compareFiles(a / name, b / name, fs::path(name).stem().string(), comparison);
    else
      comparison.unlike.push_back(name + " is in the " + (first.contains(name) ? "first" : "second") + " only.");
  return comparison;
}

void print(const Comparison& comparison, double tolerance, std::size_t rows, std::ostream& out) {
  for (const std::string& line : comparison.unlike) out << line << '\n';
  std::vector<Difference> sorted = comparison.differences;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Difference& x, const Difference& y) { return x.relative() > y.relative(); });
  std::size_t beyond = 0, equal = 0, width = 0;
  for (const Difference& one : sorted) {
    beyond += one.relative() > tolerance ? 1 : 0;
    equal += one.largest == 0.0 ? 1 : 0;
  }
  sorted.resize(std::min(rows, sorted.size() - equal));
  for (const Difference& one : sorted) width = std::max(width, one.what.size());
  if (!sorted.empty())
    out << std::left << std::setw(static_cast<int>(width) + 2) << "quantity" << std::setw(14) << "largest"
        << std::setw(14) << "over scale"
        << "where\n";
  for (const Difference& one : sorted)
    out << std::left << std::setw(static_cast<int>(width) + 2) << one.what << std::setw(14) << one.largest
        << std::setw(14) << one.relative() << one.where << '\n';
  out << comparison.differences.size() << " quantities, " << equal << " of them equal, " << beyond << " beyond "
      << tolerance << " of their scale: " << (comparison.within(tolerance) ? "the same" : "NOT the same") << '\n';
}

}  // namespace dovetail::scene
