#include "series.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"

namespace dovetail::scene {

Series::Series(Built& built, const Scene& scene, SeriesFiles files)
    : row_(built, scene),
      table_(row_.names()),
      files_(std::move(files)),
      path_(files_.folder / "series.csv"),
      file_(path_, files_.provenance) {
  if (files_.hdf5) requireHdf5();
}

void Series::takeUp(std::uint64_t rows) {
  if (rows == 0) return;
  const io::TimeSeries earlier = io::readCsv(path_);
  if (earlier.names() != table_.names() || earlier.rows() < rows)
    throw InputError("the series does not belong to the checkpoint", path_.string(), "restore it, or start a new run");
  std::vector<double> row(table_.names().size());
  for (std::size_t k = 0; k < rows; ++k) {
    for (std::size_t c = 0; c < row.size(); ++c) row[c] = earlier.column(c)[k];
    table_.append(row);
  }
  file_.write(table_);
}

bool Series::looksAtLimit() const {
  constexpr std::int64_t rarely = 2000;  // macro steps
  return table_.rows() % static_cast<std::uint64_t>(std::max<std::int64_t>(1, rarely / files_.every)) == 0;
}

void Series::add(Built& built) {
  const bool looks = looksAtLimit();
  if (looks) limit_ = built.run->criticalStep();
  table_.append(row_.now(built, looks ? limit_->dt : table_.column("limit_s").back()));
  file_.write(table_);
}

void Series::close(const std::string& scene) const {
  if (!files_.hdf5) return;
  io::KeyValues provenance = files_.provenance;
  provenance.emplace_back("scene", scene);
  writeSeriesHdf5(files_.folder / "series.h5", table_, provenance);
}

}  // namespace dovetail::scene
