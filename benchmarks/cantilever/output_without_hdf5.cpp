#include "output.hpp"

namespace dovetail::cantilever {

bool writeSeriesHdf5(const std::filesystem::path&, const RunResult&) { return false; }

}  // namespace dovetail::cantilever
