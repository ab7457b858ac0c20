#include "dovetail/fem/mesh/mesh_places.hpp"

#include <algorithm>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "faces.hpp"

namespace dovetail::fem {

namespace {

void requireSome(bool empty, const SolidMesh& mesh, const char* what, const char* where) {
  if (!empty) return;
  std::string reach;
  for (int c = 0; c < 3; ++c) {
    const auto along = [c](const Vec3& X) { return X[c]; };
    const auto [least, most] = std::ranges::minmax(mesh.X, {}, along);
    reach +=
        std::string(c > 0 ? ", " : "") + "xyz"[c] + " from " + formatNumber(least[c]) + " to " + formatNumber(most[c]);
  }
  throw InputError(std::string("there are no ") + what + " in this place", where,
                   "widen it or move it: the mesh has " + reach + " m");
}

}  // namespace

Place inBox(Vec3 lower, Vec3 upper, double margin) {
  return [=](const Vec3& X) {
    for (int c = 0; c < 3; ++c)
      if (!(X[c] >= lower[c] - margin && X[c] <= upper[c] + margin)) return false;
    return true;
  };
}

std::vector<int> nodesWhere(const SolidMesh& mesh, const Place& place) {
  std::vector<int> found;
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    if (place(mesh.X[n])) found.push_back(static_cast<int>(n));
  requireSome(found.empty(), mesh, "nodes", "node set");
  return found;
}

std::vector<Face> facesWhere(const SolidMesh& mesh, const Place& place) {
  std::vector<Face> faces = boundaryFaces(mesh);
  std::erase_if(faces, [&](const Face& face) {
    return !std::ranges::all_of(nodesOf(face), [&](int n) { return place(mesh.X[static_cast<std::size_t>(n)]); });
  });
  requireSome(faces.empty(), mesh, "faces", "face set");
  return faces;
}

}  // namespace dovetail::fem
