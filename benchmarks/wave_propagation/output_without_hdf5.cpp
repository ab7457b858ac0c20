#include "output.hpp"

namespace dovetail::wave {

bool writeSeriesHdf5(const std::filesystem::path&, const RunResult&) { return false; }

}  // namespace dovetail::wave
