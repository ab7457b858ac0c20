// Surfaces and meshes from files.
#include "dovetail/mesh_io/surface_files.hpp"
#include "dovetail/solid_io/solid_files.hpp"
#include "parts.hpp"

namespace dovetail::scene {

geometry::TriangleMesh readTriangles(const std::string& file) { return mesh_io::readSurface(file); }
MeshOfFile readMesh(const std::string& file) {
  solid_io::SolidFile read = solid_io::readSolid(file);
  return {std::move(read.mesh), std::move(read.notes)};
}
std::vector<MovingSphere> readSpheres(const std::string& file) {
  throw InputError("this build reads no files of VTK", file, "give a CSV file, or build with VTK");
}

}  // namespace dovetail::scene
