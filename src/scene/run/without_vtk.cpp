// Builds without VTK write no frames and read none, nor its files.
#include "build/parts.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "dovetail/scene/grid_fields.hpp"
#include "dovetail/solid_io/solid_files.hpp"
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
void Frames::add(const Built&, SameInstant) {}
void writeModes(const std::filesystem::path&, const Built&, std::size_t, const fem::Modes&, const io::KeyValues&) {}

bool isFrameFile(const std::filesystem::path& file) { return file.extension() == ".pvd"; }
void compareFrames(const std::filesystem::path&, const std::filesystem::path&, const std::string& name,
                   Comparison& to) {
  to.unlike.push_back(name + " was not compared: this build has no VTK.");
}
bool inspectFrames(const std::filesystem::path&, std::ostream&) { return false; }

void writeGridFields(const std::filesystem::path&, const GridOptions&, std::ostream&) {
  throw InputError("this build writes no fields", "fields", "build with VTK");
}

SurfaceOfFile readTriangles(const std::string& file) {
  SurfaceOfFile read;
  read.mesh = mesh_io::readSurface(file, &read.notes);
  return read;
}
MeshOfFile readMesh(const std::string& file) {
  solid_io::SolidFile read = solid_io::readSolid(file);
  return {std::move(read.mesh), std::move(read.notes)};
}
std::vector<MovingSphere> readSpheres(const std::string& file) {
  throw InputError("this build reads no files of VTK", file, "give a CSV file, or build with VTK");
}

}  // namespace dovetail::scene
