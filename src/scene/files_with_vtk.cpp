// Surfaces and meshes from files, those of VTK too.
#include "dovetail/mesh_io/surface_files.hpp"
#include "dovetail/mesh_io_vtk/vtp.hpp"
#include "dovetail/solid_io/solid_files.hpp"
#include "dovetail/solid_io_vtk/solid_vtu.hpp"
#include "parts.hpp"

namespace dovetail::scene {

geometry::TriangleMesh readTriangles(const std::string& file) {
  return file.ends_with(".vtp") ? mesh_io::readVtp(file) : mesh_io::readSurface(file);
}
fem::SolidMesh readMesh(const std::string& file) {
  return file.ends_with(".vtu") ? solid_io::readVtu(file).mesh : solid_io::readSolid(file).mesh;
}

}  // namespace dovetail::scene
