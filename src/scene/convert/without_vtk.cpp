// Builds without VTK read and write no frames.
#include "dovetail/core/error.hpp"
#include "grain_sources.hpp"

namespace dovetail::scene {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw InputError("this build reads and writes no files of VTK", file.string(), "use a CSV file, or build with VTK");
}

}  // namespace

grain_io::GrainFile grainsOfFrame(const std::filesystem::path& frame) { refuse(frame); }
std::vector<std::pair<double, std::filesystem::path>> framesOf(const std::filesystem::path& series) { refuse(series); }
void writeGrainFrame(const std::filesystem::path& to, const grain_io::GrainFile&) { refuse(to); }
void writeMeshFrame(const std::filesystem::path& to, const fem::SolidMesh&) { refuse(to); }

}  // namespace dovetail::scene
