// Builds without HDF5 write none.
#include "dovetail/core/error.hpp"
#include "series.hpp"

namespace dovetail::scene {

void requireHdf5() { throw InputError("this build writes no HDF5", "output.hdf5", "leave it out, or build with HDF5"); }
void writeSeriesHdf5(const std::filesystem::path&, const io::TimeSeries&, const io::KeyValues&) { requireHdf5(); }

}  // namespace dovetail::scene
