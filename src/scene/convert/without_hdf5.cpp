// Builds without HDF5 write no series.
#include "dovetail/core/error.hpp"
#include "grain_sources.hpp"

namespace dovetail::scene {

void writeGrainSeries(const std::filesystem::path& to, const std::vector<grain_io::GrainFile>&) {
  throw InputError("this build writes no HDF5", to.string(), "use .vtu, or build with HDF5");
}

}  // namespace dovetail::scene
