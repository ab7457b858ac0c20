#include "dovetail/io_hdf5/time_series_hdf5.hpp"
#include "output.hpp"

namespace dovetail::wave {

bool writeSeriesHdf5(const std::filesystem::path& file, const RunResult& result) {
  io::writeHdf5(file, result.series, provenanceOf(result.settings));
  return true;
}

}  // namespace dovetail::wave
