#include "dovetail/fem/mesh/mesh_thickness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "dovetail/fem/mesh/cell_topology.hpp"

namespace dovetail::fem {

namespace {

/// Elements by number, and who lies behind each of their faces.
class Walker {
public:
  explicit Walker(const SolidMesh& mesh) : mesh_(mesh) {
    for (std::size_t g = 0; g < mesh.groups.size(); ++g)
      for (std::size_t e = 0; e < mesh.groups[g].size(); ++e) place_.push_back({g, e});
    struct Keyed {
      std::array<int, 4> key;
      std::size_t element, side;
    };
    std::vector<Keyed> sides;
    for (std::size_t number = 0; number < place_.size(); ++number)
      for (std::size_t k = 0; k < sidesOf(number); ++k) {
        const Face face = faceAt(number, k);
        Keyed& one = sides.emplace_back(Keyed{{}, number, k});
        one.key.fill(std::numeric_limits<int>::max());
        std::copy_n(face.node.begin(), cornersOf(face.shape), one.key.begin());
        std::sort(one.key.begin(), one.key.end());
      }
    std::stable_sort(sides.begin(), sides.end(), [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
    behind_.assign(6 * place_.size(), -1);
    for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
      for (j = i + 1; j < sides.size() && sides[j].key == sides[i].key; ++j) {
      }
      if (j == i + 1) boundary_.push_back({sides[i].element, sides[i].side});
      if (j != i + 2) continue;
      behind_[6 * sides[i].element + sides[i].side] = static_cast<int>(sides[i + 1].element);
      behind_[6 * sides[i + 1].element + sides[i + 1].side] = static_cast<int>(sides[i].element);
    }
    std::ranges::sort(boundary_);
  }

  using Side = std::pair<std::size_t, std::size_t>;  // element, local face
  const std::vector<Side>& boundary() const { return boundary_; }
  ElementShape shapeOf(std::size_t number) const { return mesh_.groups[place_[number].first].shape; }
  Face faceAt(std::size_t number, std::size_t side) const {
    return faceOf(mesh_.groups[place_[number].first], place_[number].second, side);
  }
  Vec3 corner(const Face& face, int k) const {
    return mesh_.X[static_cast<std::size_t>(face.node[static_cast<std::size_t>(k)])];
  }
  /// ∫ outward normal dA of the flat image, m².
  Vec3 areaOf(const Face& face) const {
    const Vec3 a = corner(face, 0), b = corner(face, 1), c = corner(face, 2);
    if (cornersOf(face.shape) == 3) return 0.5 * cross(b - a, c - a);
    return 0.5 * cross(c - a, corner(face, 3) - b);
  }
  /// Off the middle: lines through it would meet edges of regular meshes.
  Vec3 pointOn(const Face& face) const {
    constexpr std::array<double, 4> ofFour{0.27, 0.26, 0.22, 0.25}, ofThree{0.37, 0.34, 0.29, 0.0};
    const int corners = cornersOf(face.shape);
    Vec3 point;
    for (int k = 0; k < corners; ++k)
      point += (corners == 4 ? ofFour : ofThree)[static_cast<std::size_t>(k)] * corner(face, k);
    return point;
  }

  struct Line {
    double length = 0.0, extent = 0.0;  // in the mesh, m; sum of the extents along it of the elements crossed
    std::vector<std::pair<double, std::size_t>> left;  // where elements end, and which
    Side end;
    double meanExtent() const { return extent / static_cast<double>(left.size()); }
  };
  /// From a point in or on an element; nothing if the line gets lost at an edge.
  std::optional<Line> walk(std::size_t element, const Vec3& from, const Vec3& along) const {
    constexpr std::size_t longest = 20000;
    Line line;
    while (line.left.size() < longest) {
      const double extent = extentOf(element, along);
      double out = -1.0;
      std::size_t side = 0;
      for (std::size_t k = 0; k < sidesOf(element); ++k)
        if (const double hit = lastHit(faceAt(element, k), from, along); hit > out) out = hit, side = k;
      if (!(out >= line.length - 1e-9 * extent)) return std::nullopt;
      line.length = std::max(line.length, out);
      line.extent += extent;
      line.left.emplace_back(line.length, element);
      line.end = {element, side};
      const int next = behind_[6 * element + side];
      if (next < 0) return line;
      element = static_cast<std::size_t>(next);
    }
    return std::nullopt;
  }

private:
  std::size_t sidesOf(std::size_t number) const { return localFacesOf(shapeOf(number)).size(); }
  double extentOf(std::size_t number, const Vec3& along) const {
    const ElementGroup& group = mesh_.groups[place_[number].first];
    const std::size_t first = place_[number].second * static_cast<std::size_t>(nodesOf(group.shape));
    double least = INFINITY, most = -INFINITY;
    for (std::size_t k = 0; k < static_cast<std::size_t>(cornersOf(group.shape)); ++k) {
      const double at = dot(mesh_.X[static_cast<std::size_t>(group.node[first + k])], along);
      least = std::min(least, at), most = std::max(most, at);
    }
    return most - least;
  }
  /// The largest s ≥ 0 with from + s along on the triangles of a face; −1 without.
  double lastHit(const Face& face, const Vec3& from, const Vec3& along) const {
    const int corners = cornersOf(face.shape);
    if (corners == 3) return hit(corner(face, 0), corner(face, 1), corner(face, 2), from, along);
    Vec3 middle;
    for (int k = 0; k < 4; ++k) middle += 0.25 * corner(face, k);
    double last = -1.0;
    for (int k = 0; k < 4; ++k)
      last = std::max(last, hit(middle, corner(face, k), corner(face, (k + 1) % 4), from, along));
    return last;
  }
  static double hit(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& from, const Vec3& along) {
    constexpr double slack = 1e-9;
    const Vec3 ab = b - a, ac = c - a, p = cross(along, ac);
    const double det = dot(ab, p);
    if (std::abs(det) <= 1e-12 * norm(ab) * norm(ac)) return -1.0;
    const Vec3 r = from - a, q = cross(r, ab);
    const double u = dot(r, p) / det, v = dot(along, q) / det;
    if (u < -slack || v < -slack || u + v > 1.0 + slack) return -1.0;
    return dot(ac, q) / det;
  }

  const SolidMesh& mesh_;
  std::vector<std::pair<std::size_t, std::size_t>> place_;  // group, number in it
  std::vector<int> behind_;
  std::vector<Side> boundary_;
};

/// Along the longest of some lines through a point across `normal`.
void measureLength(const Walker& walker, std::size_t element, const Vec3& from, MeshThickness& place) {
  constexpr int directions = 12;
  const Vec3 helper = std::abs(place.normal.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 first = normalized(helper - dot(helper, place.normal) * place.normal);
  const Vec3 second = cross(place.normal, first);
  for (int k = 0; k < directions; ++k) {
    const double angle = std::acos(-1.0) * k / directions;
    const Vec3 along = std::cos(angle) * first + std::sin(angle) * second;
    const auto there = walker.walk(element, from, along), back = walker.walk(element, from, -along);
    if (!there || !back || there->length + back->length <= place.length) continue;
    place.length = there->length + back->length;
    place.elementLength = (there->extent + back->extent) / static_cast<double>(there->left.size() + back->left.size());
  }
}

std::optional<MeshThickness> thicknessAt(const Walker& walker, const Walker::Side& side) {
  const Face face = walker.faceAt(side.first, side.second);
  const Vec3 outwards = walker.areaOf(face);
  if (norm(outwards) == 0.0) return std::nullopt;
  MeshThickness place{.shape = walker.shapeOf(side.first),
                      .X = walker.pointOn(face),
                      .normal = -normalized(outwards),
                      .face = face,
                      .opposite = face,
                      .area = norm(outwards),
                      .elements = {}};
  const auto line = walker.walk(side.first, place.X, place.normal);
  if (!line || line->length == 0.0) return std::nullopt;
  place.opposite = walker.faceAt(line->end.first, line->end.second);
  if (dot(walker.areaOf(place.opposite), place.normal) < 0.866 * norm(walker.areaOf(place.opposite)))
    return std::nullopt;
  place.thickness = line->length;
  for (const auto& [where, element] : line->left) place.elements.push_back(element);
  place.layers = line->length / line->meanExtent();
  const double half = 0.497 * line->length;  // no layer ends there in regular meshes
  const auto middle = std::ranges::find_if(line->left, [&](const auto& end) { return end.first > half; });
  measureLength(walker, middle->second, place.X + half * place.normal, place);
  return place;
}

}  // namespace

std::vector<MeshThickness> measureThickness(const SolidMesh& mesh, std::size_t most) {
  std::vector<MeshThickness> places;
  if (mesh.groups.empty() || dimensionOf(mesh) == 2) return places;
  const Walker walker(mesh);
  const std::size_t stride = std::max<std::size_t>(1, walker.boundary().size() / std::max<std::size_t>(most, 1));
  for (std::size_t k = 0; k < walker.boundary().size(); k += stride)
    if (const auto place = thicknessAt(walker, walker.boundary()[k])) places.push_back(*place);
  return places;
}

}  // namespace dovetail::fem
