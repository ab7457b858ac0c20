#include "common/outputs.hpp"
#include "dovetail/io_hdf5/time_series_hdf5.hpp"

void dovetail::benchmark::writeSeriesHdf5(const std::filesystem::path& file, const io::TimeSeries& series,
                                          const io::KeyValues& provenance) {
  io::writeHdf5(file, series, provenance);
}
