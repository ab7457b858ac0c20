// Builds without VTK write no frames and read none.
#include "dovetail/core/error.hpp"
#include "dovetail/scene/grid_fields.hpp"
#include "frames.hpp"
#include "inspect/comparing.hpp"
#include "inspect/inspecting.hpp"

namespace dovetail::scene {

struct Frames::Impl {};

void requireFrames(const Output&) {
  throw InputError("this build writes no frames", "output.frames", "leave them out, or build with VTK");
}
Frames::Frames(const Built&, const Scene& scene, const std::filesystem::path&, const io::KeyValues&,
               const std::vector<double>&) {
  requireFrames(scene.output);
}
Frames::~Frames() = default;
std::vector<double> Frames::times() const { return {}; }
void Frames::add(const Built&) {}

bool isFrameFile(const std::filesystem::path& file) { return file.extension() == ".pvd"; }
void compareFrames(const std::filesystem::path&, const std::filesystem::path&, const std::string& name,
                   Comparison& to) {
  to.unlike.push_back(name + " was not compared: this build has no VTK.");
}
bool inspectFrames(const std::filesystem::path&, std::ostream&) { return false; }

void writeGridFields(const std::filesystem::path&, const GridOptions&, std::ostream&) {
  throw InputError("this build writes no fields", "fields", "build with VTK");
}

}  // namespace dovetail::scene
