// Surfaces and meshes from files, those of VTK too.
#include <algorithm>
#include <cctype>

#include "build/parts.hpp"
#include "dovetail/io_vtk/spheres.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "dovetail/mesh_io_vtk/vtp.hpp"
#include "dovetail/solid_io/solid_files.hpp"
#include "dovetail/solid_io_vtk/solid_vtu.hpp"

namespace dovetail::scene {

namespace {

bool endsWith(const std::string& file, const std::string& ending) {
  std::string lower = file;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return lower.ends_with(ending);
}

}  // namespace

SurfaceOfFile readTriangles(const std::string& file) {
  SurfaceOfFile read;
  read.mesh = endsWith(file, ".vtp") ? mesh_io::readVtp(file) : mesh_io::readSurface(file, &read.notes);
  return read;
}
MeshOfFile readMesh(const std::string& file) {
  solid_io::SolidFile read = endsWith(file, ".vtu") ? solid_io::readVtu(file) : solid_io::readSolid(file);
  return {std::move(read.mesh), std::move(read.notes)};
}
std::vector<MovingSphere> readSpheres(const std::string& file) {
  const io::SphereTable table = io::readSpheres(file);
  std::vector<MovingSphere> spheres;
  for (std::size_t i = 0; i < table.position.size(); ++i)
    spheres.push_back({{table.position[i], table.radius[i]}, table.velocity.empty() ? Vec3{} : table.velocity[i], {}});
  return spheres;
}

}  // namespace dovetail::scene
