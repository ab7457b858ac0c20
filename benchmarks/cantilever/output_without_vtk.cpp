#include "output.hpp"

namespace dovetail::cantilever {

std::unique_ptr<FrameWriter> makeFrameWriter(const std::filesystem::path&, const Settings&) { return nullptr; }

}  // namespace dovetail::cantilever
