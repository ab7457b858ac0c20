#include "dovetail/io/time_series.hpp"

#include <algorithm>
#include <array>

#include "dovetail/core/error.hpp"
#include "dovetail/io/names.hpp"

namespace dovetail::io {

TimeSeries::TimeSeries(std::vector<std::string> names) : names_(std::move(names)), columns_(names_.size()) {
  if (names_.empty()) throw InputError("a time series has no columns", "time series", "name at least one");
  for (std::size_t i = 0; i < names_.size(); ++i) {
    requirePlainName(names_[i], "column " + std::to_string(i));
    if (std::find(names_.begin(), names_.begin() + static_cast<std::ptrdiff_t>(i), names_[i]) !=
        names_.begin() + static_cast<std::ptrdiff_t>(i))
      throw InputError("the column '" + names_[i] + "' occurs twice", "time series", "give each column its own name");
  }
}

void TimeSeries::append(std::span<const double> row) {
  if (row.size() != columns_.size())
    throw InputError("a row has " + std::to_string(row.size()) + " values", "time series",
                     "give " + std::to_string(columns_.size()) + ", one per column");
  for (std::size_t i = 0; i < row.size(); ++i) columns_[i].push_back(row[i]);
}

std::span<const double> TimeSeries::column(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) {
    std::string known;
    for (const std::string& other : names_) known += (known.empty() ? "" : ", ") + other;
    throw InputError("there is no column '" + std::string(name) + "'", "time series", "the columns are " + known);
  }
  return columns_[static_cast<std::size_t>(found - names_.begin())];
}

namespace {

template <std::size_t n>
bool isAmong(const std::array<std::string_view, n>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// True for a unit with an optional exponent, "m", "m2", "kg", and for a product, "Ns", "kNm", "kgm2".
bool isUnit(std::string_view word) {
  static constexpr std::array<std::string_view, 27> units{"m",  "mm", "um", "s",   "ms",  "us",  "kg", "g",   "N",
                                                          "kN", "mN", "MN", "J",   "kJ",  "mJ",  "uJ", "MJ",  "W",
                                                          "kW", "Pa", "Hz", "kPa", "MPa", "GPa", "K",  "rad", "deg"};
  static constexpr std::array<std::string_view, 5> firstFactors{"N", "kN", "mN", "MN", "kg"};
  static constexpr std::array<std::string_view, 5> lastFactors{"m", "mm", "s", "ms", "us"};
  if (word.size() > 1 && word.back() >= '2' && word.back() <= '9') word.remove_suffix(1);
  if (isAmong(units, word)) return true;
  for (const std::string_view first : firstFactors) {
    if (!word.starts_with(first)) continue;
    std::string_view rest = word.substr(first.size());
    if (rest.starts_with("m") && isAmong(lastFactors, rest.substr(1))) rest.remove_prefix(1);  // Nms
    if (isAmong(lastFactors, rest)) return true;
  }
  return false;
}

}  // namespace

std::string unitOf(std::string_view columnName) {
  std::string unit;
  std::string_view rest = columnName;
  while (true) {
    const std::size_t split = rest.rfind('_');
    if (split == std::string_view::npos) break;
    const std::string word(rest.substr(split + 1));
    const bool isPer = word == "per" && !unit.empty() && unit.front() != '/';
    const bool isNext = isUnit(word) && (unit.empty() || unit.front() == '/');
    if (!isPer && !isNext) break;
    unit.insert(0, isPer ? "/" : word);
    rest = rest.substr(0, split);
  }
  if (unit.empty()) return "1";
  return unit.front() == '/' ? "1" + unit : unit;
}

}  // namespace dovetail::io
