// Builds without VTK write no frames.
#include "dovetail/core/error.hpp"
#include "frames.hpp"

namespace dovetail::scene {

struct Frames::Impl {};

Frames::Frames(const Built&, const Scene&, const std::filesystem::path&, const io::KeyValues&,
               const std::vector<double>&) {
  throw InputError("this build writes no frames", "output.frames", "leave them out, or build with VTK");
}
Frames::~Frames() = default;
std::vector<double> Frames::times() const { return {}; }
void Frames::add(const Built&) {}

}  // namespace dovetail::scene
