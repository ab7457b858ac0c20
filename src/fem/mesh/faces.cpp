#include "faces.hpp"

#include <algorithm>
#include <map>

#include "dovetail/core/error.hpp"

namespace dovetail::fem {

void requireFaces(std::span<const Face> faces, const SolidMesh& mesh, const char* where) {
  const std::size_t nodeCount = mesh.X.size();
  if (faces.empty()) throw InputError("there are no faces", where, "give at least one");
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (const int node : nodesOf(faces[i]))
      if (node < 0 || static_cast<std::size_t>(node) >= nodeCount)
        throw InputError("face " + std::to_string(i) + " names node " + std::to_string(node) + ", which does not exist",
                         where, "use 0 to " + std::to_string(nodeCount - 1));
    if (dimensionOf(faces[i].shape) != dimensionOf(mesh))
      throw InputError("face " + std::to_string(i) + " is a " + name(faces[i].shape) + ", the mesh is one of " +
                           (dimensionOf(mesh) == 2 ? "plane strain" : "three dimensions"),
                       where, "give faces of this mesh");
  }
}

std::vector<int> rimNodes(std::span<const Face> faces) {
  struct Edge {
    int count = 0, middle = -1;
  };
  std::map<std::pair<int, int>, Edge> edges;
  for (const Face& face : faces) {
    const int corners = cornersOf(face.shape);
    if (corners == 2) {
      for (int k = 0; k < corners; ++k) {
        const int end = face.node[static_cast<std::size_t>(k)];
        ++edges[{end, end}].count;
      }
      continue;
    }
    for (int k = 0; k < corners; ++k) {
      const auto [low, high] =
          std::minmax(face.node[static_cast<std::size_t>(k)], face.node[static_cast<std::size_t>((k + 1) % corners)]);
      Edge& edge = edges[{low, high}];
      ++edge.count;
      if (nodesOf(face.shape) > corners) edge.middle = face.node[static_cast<std::size_t>(corners + k)];
    }
  }
  std::vector<int> rim;
  for (const auto& [corners, edge] : edges) {
    if (edge.count == 2) continue;
    rim.insert(rim.end(), {corners.first, corners.second});
    if (edge.middle >= 0) rim.push_back(edge.middle);
  }
  std::sort(rim.begin(), rim.end());
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  return rim;
}

}  // namespace dovetail::fem
