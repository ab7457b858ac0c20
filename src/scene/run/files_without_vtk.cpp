// Surfaces and meshes from files.
#include "build/parts.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "dovetail/solid_io/solid_files.hpp"

namespace dovetail::scene {

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
