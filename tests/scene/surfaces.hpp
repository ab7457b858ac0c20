// A block, and scenes with a solid that fills its surface.
#pragma once

#include <filesystem>
#include <string>

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "dovetail/mesh_io/surface_files.hpp"

namespace dovetail::scene::test {

inline constexpr double blockVolume = 0.4 * 0.2 * 0.1;  // m³

inline fem::SolidMesh block(fem::ElementShape shape, double perMetre = 1.0) {
  return fem::boxOf(shape, {1, 1, 1}, {}, perMetre * Vec3{0.4, 0.2, 0.1});
}
/// The boundary of bricks, two triangles per side.
inline geometry::TriangleMesh surfaceOf(const fem::SolidMesh& bricks) {
  geometry::TriangleMesh surface{bricks.X, {}};
  for (const fem::Face& f : fem::boundaryFaces(bricks)) {
    surface.facets.push_back({f.node[0], f.node[1], f.node[2]});
    surface.facets.push_back({f.node[0], f.node[2], f.node[3]});
  }
  return surface;
}
inline void writeBlock(const std::filesystem::path& file, double perMetre = 1.0) {
  const geometry::TriangleMesh surface = surfaceOf(block(fem::ElementShape::hex8, perMetre));
  mesh_io::writeStl(file, surface.x, surface.facets);
}

/// @param size  and further keys of the solid
inline std::string solidInside(const std::string& file, const std::string& size) {
  return R"("solids": [{"name": "b", "mesh": "tetrahedra", "file": ")" + file + R"(", "size": )" + size +
         R"(, "material": {"law": "neo-Hookean", "youngs_modulus": "1 MPa", "poisson_ratio": 0.3, "density": 1000},
         "sets": [{"name": "bottom", "place": "side", "side": "z-"}], "supports": [{"on": "bottom"}]}],)";
}

}  // namespace dovetail::scene::test
