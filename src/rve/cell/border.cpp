#include "border.hpp"

#include <algorithm>
#include <cmath>

namespace dovetail::rve {

namespace {

using geometry::Image;

/// Twice the area of a triangle, > 0 counter-clockwise; 0 for points in a row, as far as round-off tells.
double turn(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double area = cross(b - a, c - a).z;
  return std::abs(area) > 1e-12 * (squaredNorm(b - a) + squaredNorm(c - a)) ? area : 0.0;
}

bool isSimple(const std::vector<Vec3>& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 2; b < n; ++b) {
      if (a == 0 && b == n - 1) continue;
      const Vec3 &p = polygon[a], &q = polygon[a + 1], &r = polygon[b], &s = polygon[(b + 1) % n];
      if (turn(p, q, r) * turn(p, q, s) < 0.0 && turn(r, s, p) * turn(r, s, q) < 0.0) return false;
    }
  return true;
}

bool isInside(const std::vector<Vec3>& polygon, const Vec3& x) {
  bool inside = false;
  for (std::size_t a = 0, b = polygon.size() - 1; a < polygon.size(); b = a++) {
    const Vec3 &p = polygon[a], &q = polygon[b];
    if ((p.y > x.y) != (q.y > x.y) && x.x < p.x + (q.x - p.x) * (x.y - p.y) / (q.y - p.y)) inside = !inside;
  }
  return inside;
}

/// Grains that a line of the border cuts, by how far along it they lie.
struct Cut {
  double along;
  Placed placed;
};

Placed moved(const Placed& placed, std::size_t axis, int by) {
  Placed result = placed;
  result.image[axis] += by;
  return result;
}

std::vector<Placed> sorted(std::vector<Cut>& cuts) {
  std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.along < b.along; });
  std::vector<Placed> places;
  for (const Cut& cut : cuts) places.push_back(cut.placed);
  return places;
}

std::vector<Placed> sideOf(const Placed& corner, std::vector<Placed> along, bool backwards, std::size_t axis, int by) {
  if (backwards) std::reverse(along.begin(), along.end());
  std::vector<Placed> side{corner};
  for (const Placed& placed : along) side.push_back(moved(placed, axis, by));
  return side;
}

}  // namespace

Vec3 centreOf(const Rve& cell, const Placed& placed) {
  const auto i = static_cast<std::size_t>(placed.grain);
  return Vec3{cell.state.x[0][i], cell.state.x[1][i], 0.0} + cell.state.lattice.shift(placed.image);
}

std::optional<Border> borderThrough(const Rve& cell, int corner) {
  const geometry::Lattice& lattice = cell.state.lattice;
  // Counter-clockwise is from period a to period b.
  const bool turned = cross(lattice.period[0], lattice.period[1]).z < 0.0;
  const std::size_t a = turned ? 1 : 0, b = turned ? 0 : 1;
  const std::array<Vec3, 3> rows = geometry::inverse(lattice);
  const std::array<double, 3> widths = lattice.widths();
  const Vec3 origin = centreOf(cell, {corner, {}});
  std::vector<Cut> bottom, left;
  std::vector<Placed> others;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const int grain = static_cast<int>(i);
    if (grain == corner) continue;
    const Vec3 x = centreOf(cell, {grain, {}}) - origin;
    const double sa = dot(rows[a], x), sb = dot(rows[b], x);
    const bool onBottom = std::abs(sb - std::round(sb)) * widths[b] < cell.radius[i];
    const bool onLeft = std::abs(sa - std::round(sa)) * widths[a] < cell.radius[i];
    if (onBottom && onLeft) return {};
    Image image{};
    image[a] = -static_cast<int>(onLeft ? std::round(sa) : std::floor(sa));
    image[b] = -static_cast<int>(onBottom ? std::round(sb) : std::floor(sb));
    if (onBottom) bottom.push_back({sa + image[a], {grain, image}});
    if (onLeft) left.push_back({sb + image[b], {grain, image}});
    if (!onBottom && !onLeft) others.push_back({grain, image});
  }
  const std::vector<Placed> along = sorted(bottom), up = sorted(left);
  const Placed c{corner, {}};
  Border border{.side = {}, .sideways = a, .upwards = b, .inner = {}};
  border.side = {sideOf(c, along, false, b, 0), sideOf(moved(c, a, 1), up, false, a, 1),
                 sideOf(moved(moved(c, a, 1), b, 1), along, true, b, 1), sideOf(moved(c, b, 1), up, true, a, 0)};
  std::vector<Vec3> polygon;
  for (const std::vector<Placed>& side : border.side)
    for (const Placed& placed : side) polygon.push_back(centreOf(cell, placed));
  if (!isSimple(polygon)) return {};
  for (const Placed& placed : others) {
    bool found = false;
    for (int m = -1; m <= 1 && !found; ++m)
      for (int n = -1; n <= 1 && !found; ++n) {
        const Placed tried = moved(moved(placed, a, m), b, n);
        found = isInside(polygon, centreOf(cell, tried));
        if (found) border.inner.push_back(tried);
      }
    if (!found) return {};
  }
  return border;
}

}  // namespace dovetail::rve
