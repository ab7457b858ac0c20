// Builds without HDF5 write none.
#include "dovetail/core/error.hpp"
#include "inspect/comparing.hpp"
#include "inspect/inspecting.hpp"
#include "series.hpp"

namespace dovetail::scene {

void requireHdf5() { throw InputError("this build writes no HDF5", "output.hdf5", "leave it out, or build with HDF5"); }
void writeSeriesHdf5(const std::filesystem::path&, const io::TimeSeries&, const io::KeyValues&) { requireHdf5(); }

void writeSolidsHdf5(const std::filesystem::path&, const Built&, const Scene&, const io::KeyValues&) {}

io::TimeSeries readSeriesHdf5(const std::filesystem::path& file) {
  throw InputError("this build reads no HDF5", file.string(), "give the series.csv beside it, or build with HDF5");
}
io::KeyValues readProvenanceHdf5(const std::filesystem::path&) { return {}; }

}  // namespace dovetail::scene
