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

}  // namespace dovetail::io
