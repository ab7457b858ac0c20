// Series as HDF5.
#include "dovetail/io_hdf5/time_series_hdf5.hpp"
#include "series.hpp"

namespace dovetail::scene {

void requireHdf5() {}
void writeSeriesHdf5(const std::filesystem::path& path, const io::TimeSeries& table, const io::KeyValues& provenance) {
  io::writeHdf5(path, table, provenance);
}

}  // namespace dovetail::scene
