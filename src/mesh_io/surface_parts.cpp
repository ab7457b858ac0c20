#include "surface_parts.hpp"

#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/farthest.hpp"

namespace dovetail::mesh_io {

std::string readWhole(const std::filesystem::path& path) {
  std::string bytes = io::readWhole(path, "a surface");
  if (bytes.empty()) throw InputError("the file is empty", path.string(), "give a file with a surface");
  return bytes;
}

void refuse(const std::filesystem::path& path, const std::string& place, const std::string& problem,
            const std::string& remedy) {
  throw InputError(problem, place.empty() ? path.string() : path.string() + ", " + place, remedy);
}

void requireFacets(const geometry::TriangleMesh& mesh, const std::filesystem::path& path) {
  if (mesh.facets.empty()) refuse(path, "", "the file holds no facets", "give a file with a surface of triangles");
  if (mesh.x.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    refuse(path, "", "the file holds too many vertices", "cut the surface into several files");
  for (std::size_t v = 0; v < mesh.x.size(); ++v)
    if (isTooFar(mesh.x[v]))
      refuse(path, "vertex " + std::to_string(v), "it lies farther than 1e15 m from the origin",
             "give coordinates in metres");
}

void addFan(const std::vector<int>& corners, geometry::TriangleMesh& mesh) {
  for (std::size_t k = 2; k < corners.size(); ++k) mesh.facets.push_back({corners[0], corners[k - 1], corners[k]});
}

}  // namespace dovetail::mesh_io
