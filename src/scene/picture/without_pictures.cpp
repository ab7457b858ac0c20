// Builds without VTK, which reads frames, or zlib, which packs pictures.
#include "dovetail/core/error.hpp"
#include "dovetail/scene/picture.hpp"

namespace dovetail::scene {

std::filesystem::path writePicture(const std::filesystem::path&, const PictureOptions&, std::ostream&) {
  throw InputError("this build draws no pictures", "picture", "build with VTK and zlib (libvtk9-dev, zlib1g-dev)");
}
ShownRun showRun(const std::filesystem::path&) { return {}; }

}  // namespace dovetail::scene
