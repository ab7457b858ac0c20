// Named columns of doubles over the time of a run, and their CSV form.
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dovetail/io/provenance.hpp"

namespace dovetail::io {

/// A table, stored by column. A name ends with its unit: "time_s", "kinetic_particles_J", "speed_m_per_s",
/// "acceleration_m_per_s2"; a name without one ("contacts") is a pure number.
class TimeSeries {
public:
  /// @throws InputError if there are no columns, if a name occurs twice, or if one holds anything but ASCII letters,
  ///         digits, '_', '-' and '.', or does not start with a letter
  explicit TimeSeries(std::vector<std::string> names);

  /// Adds one row, in the order of the names. @throws InputError if the count differs; nothing is added
  void append(std::span<const double> row);
  void append(std::initializer_list<double> row) { append(std::span<const double>(row.begin(), row.size())); }

  std::size_t rows() const { return columns_.front().size(); }
  const std::vector<std::string>& names() const { return names_; }
  std::span<const double> column(std::size_t index) const { return columns_.at(index); }
  /// @throws InputError if there is no such column
  std::span<const double> column(std::string_view name) const;

private:
  std::vector<std::string> names_;
  std::vector<std::vector<double>> columns_;
};

/// Unit in a column's name: "J" of "kinetic_particles_J", "m/s2" of "acceleration_m_per_s2", "Nm" of "torque_Nm", "1/m"
/// of "count_per_m", "1" where the name ends with no unit. Units: m, g, s, N, J, W, Pa, Hz, K, rad, deg with the usual
/// prefixes, an exponent, and products with N ("Ns", "Nms", "kNm").
std::string unitOf(std::string_view columnName);

/// Comma-separated: the provenance in leading '#' lines, a line of names, the rows. Numbers are the shortest that read
/// back to the same bits. Replaces a file of ours at once (see output_folder.hpp for the rule and the errors).
void writeCsv(const std::filesystem::path& path, const TimeSeries& series, const KeyValues& provenance);

/// A CSV file that grows with its table, so that a run which is cut off leaves what it has computed.
class GrowingCsv {
public:
  GrowingCsv(std::filesystem::path path, KeyValues provenance)
      : path_(std::move(path)), provenance_(std::move(provenance)) {}

  /// Brings the file up to the table, to which rows may have been added since the last call: the first call writes it
  /// as writeCsv, later ones append. In the end the bytes are those of writeCsv.
  /// @throws InputError, Error as writeCsv; the file then holds the rows of the call before
  void write(const TimeSeries& series);

private:
  std::filesystem::path path_;
  KeyValues provenance_;
  std::size_t rows_ = 0;
};

/// Reads what writeCsv wrote, or any table of the same form. '#' lines are ignored; the last of them may have the
/// names, if numbers follow. A byte-order mark of UTF-8 and lines that end with CR are taken.
/// @throws InputError, naming the line, if the file cannot be read, a row has another count, or a field is no number
TimeSeries readCsv(const std::filesystem::path& path);

}  // namespace dovetail::io
