// Surfaces and meshes from files, those of VTK too.
#include "dovetail/io_vtk/spheres.hpp"
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
std::vector<MovingSphere> readSpheres(const std::string& file) {
  const io::SphereTable table = io::readSpheres(file);
  std::vector<MovingSphere> spheres;
  for (std::size_t i = 0; i < table.position.size(); ++i)
    spheres.push_back({{table.position[i], table.radius[i]}, table.velocity.empty() ? Vec3{} : table.velocity[i]});
  return spheres;
}

}  // namespace dovetail::scene
