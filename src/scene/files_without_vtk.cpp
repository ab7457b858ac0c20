// Surfaces and meshes from files.
#include "dovetail/mesh_io/surface_files.hpp"
#include "dovetail/solid_io/solid_files.hpp"
#include "parts.hpp"

namespace dovetail::scene {

geometry::TriangleMesh readTriangles(const std::string& file) { return mesh_io::readSurface(file); }
fem::SolidMesh readMesh(const std::string& file) { return solid_io::readSolid(file).mesh; }
std::vector<MovingSphere> readSpheres(const std::string& file) {
  throw InputError("this build reads no files of VTK", file, "give a CSV file, or build with VTK");
}

}  // namespace dovetail::scene
