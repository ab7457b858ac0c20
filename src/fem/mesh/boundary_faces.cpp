#include <algorithm>
#include <limits>

#include "dovetail/fem/mesh/cell_topology.hpp"

namespace dovetail::fem {

namespace {

/// A face of an element by its sorted corners, which name it whatever the order and side it is seen from.
struct Side {
  std::array<int, 4> key;
  std::size_t number;  // counts the faces of all elements
};

std::array<int, 4> keyOf(const Face& face) {
  std::array<int, 4> key{};
  key.fill(std::numeric_limits<int>::max());
  std::copy_n(face.node.begin(), cornersOf(face.shape), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

}  // namespace

std::vector<Face> boundaryFaces(const SolidMesh& mesh) {
  std::vector<Face> faces;
  std::vector<Side> sides;
  for (const ElementGroup& group : mesh.groups)
    for (std::size_t e = 0; e < group.size(); ++e)
      for (std::size_t side = 0; side < localFacesOf(group.shape).size(); ++side) {
        faces.push_back(faceOf(group, e, side));
        sides.push_back({keyOf(faces.back()), sides.size()});
      }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.key < b.key; });
  std::vector<char> outside(faces.size(), 0);
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    for (j = i; j < sides.size() && sides[j].key == sides[i].key;) ++j;
    if (j == i + 1) outside[sides[i].number] = 1;
  }
  std::vector<Face> boundary;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (outside[f]) boundary.push_back(faces[f]);
  return boundary;
}

}  // namespace dovetail::fem
