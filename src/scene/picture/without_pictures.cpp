// Builds without VTK, which reads frames, or zlib, which packs pictures.
#include "dovetail/core/error.hpp"
#include "dovetail/scene/picture.hpp"

namespace dovetail::scene {

namespace {
[[noreturn]] void refuse() {
  throw InputError("this build draws no pictures", "picture", "build with VTK and zlib (libvtk9-dev, zlib1g-dev)");
}
}  // namespace

std::filesystem::path writePicture(const std::filesystem::path&, const PictureOptions&, std::ostream&) { refuse(); }
Picture drawPicture(const std::filesystem::path&, const PictureOptions&) { refuse(); }
Picture drawPicture(const Built&, const Scene&, const PictureOptions&) { refuse(); }
ShownRun showRun(const std::filesystem::path&) { return {}; }

}  // namespace dovetail::scene
