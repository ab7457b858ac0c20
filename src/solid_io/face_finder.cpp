#include "face_finder.hpp"

#include <algorithm>
#include <limits>

#include "dovetail/fem/mesh/cell_topology.hpp"

namespace dovetail::solid_io {

namespace {

std::array<int, 4> keyOf(std::span<const int> corners) {
  std::array<int, 4> key{};
  key.fill(std::numeric_limits<int>::max());
  std::copy(corners.begin(), corners.end(), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

/// Whether b runs around the same corners in the same sense as a.
bool sameSense(std::span<const int> a, std::span<const int> b) {
  if (a.size() == 2) return a[0] == b[0];
  const auto at = std::find(b.begin(), b.end(), a[0]);
  const auto next = static_cast<std::size_t>(at - b.begin() + 1) % b.size();
  return at != b.end() && b[next] == a[1];
}

}  // namespace

FaceFinder::FaceFinder(const fem::SolidMesh& mesh) : mesh_(mesh) {
  int number = 0;
  for (const fem::ElementGroup& group : mesh.groups)
    for (std::size_t e = 0; e < group.size(); ++e, ++number)
      for (std::size_t side = 0; side < fem::localFacesOf(group.shape).size(); ++side) {
        const fem::Face face = fem::faceOf(group, e, side);
        const auto corners = std::span(face.node).first(static_cast<std::size_t>(fem::cornersOf(face.shape)));
        entries_.push_back({keyOf(corners), {number, static_cast<int>(side)}});
      }
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.key < b.key; });
}

Side FaceFinder::find(std::span<const int> corners) const {
  const auto key = keyOf(corners);
  auto at = std::lower_bound(entries_.begin(), entries_.end(), key,
                             [](const Entry& entry, const auto& wanted) { return entry.key < wanted; });
  if (at == entries_.end() || at->key != key) return {-1, -1};
  const Side first = at->side;
  for (; at != entries_.end() && at->key == key; ++at) {
    const fem::Face candidate = face(at->side);
    if (sameSense(corners, std::span(candidate.node).first(corners.size()))) return at->side;
  }
  return first;
}

fem::Face FaceFinder::face(const Side& side) const {
  auto e = static_cast<std::size_t>(side.element);
  for (const fem::ElementGroup& group : mesh_.groups) {
    if (e < group.size()) return fem::faceOf(group, e, static_cast<std::size_t>(side.side));
    e -= group.size();
  }
  return {};
}

}  // namespace dovetail::solid_io
