#include <algorithm>

#include "dovetail/fem/mesh/cell_topology.hpp"
#include "face_key.hpp"

namespace dovetail::fem {

namespace {

/// A face of an element.
struct Side {
  FaceKey key;
  std::size_t number;  // counts the faces of all elements
};

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
