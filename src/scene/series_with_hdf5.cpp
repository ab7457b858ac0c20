// Series as HDF5.
#include "comparing.hpp"
#include "dovetail/io_hdf5/time_series_hdf5.hpp"
#include "series.hpp"
#include "telling.hpp"

namespace dovetail::scene {

void requireHdf5() {}
void writeSeriesHdf5(const std::filesystem::path& path, const io::TimeSeries& table, const io::KeyValues& provenance) {
  io::writeHdf5(path, table, provenance);
}

io::TimeSeries readSeriesHdf5(const std::filesystem::path& file) { return io::readHdf5(file); }
io::KeyValues readProvenanceHdf5(const std::filesystem::path& file) { return io::readHdf5Provenance(file); }

}  // namespace dovetail::scene
