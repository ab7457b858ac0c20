#include "output.hpp"

namespace dovetail::wave {

std::unique_ptr<FrameWriter> makeFrameWriter(const std::filesystem::path&, const Settings&) { return nullptr; }

}  // namespace dovetail::wave
