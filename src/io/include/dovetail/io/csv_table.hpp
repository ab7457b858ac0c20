// Tables of CSV files with the places of their rows.
#pragma once

#include "dovetail/io/time_series.hpp"

namespace dovetail::io {

struct CsvTable {
  TimeSeries series;
  std::vector<std::size_t> line;  ///< of each row in the file, from 1: comments and empty lines count
};

/// As readCsv, for those that have to say where a row is wrong.
/// @throws InputError as readCsv
CsvTable readCsvTable(const std::filesystem::path& path);

}  // namespace dovetail::io
