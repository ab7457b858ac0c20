#include "dovetail/geometry/predicates.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dovetail::geometry {

namespace {

/// A number as the exact sum of its terms, smallest first, which do not overlap; none = 0.
using Expansion = std::vector<double>;

struct Split {
  double value, error;  // value + error is exact
};

Split sum(double a, double b) {
  const double value = a + b, part = value - a;
  return {value, (a - (value - part)) + (b - part)};
}

Split product(double a, double b) {
  const double value = a * b;
  return {value, std::fma(a, b, -value)};
}

void add(Expansion& e, double b) {
  std::size_t kept = 0;
  for (const double term : e) {
    const Split s = sum(b, term);
    if (s.error != 0.0) e[kept++] = s.error;
    b = s.value;
  }
  e.resize(kept);
  if (b != 0.0) e.push_back(b);
}

Expansion difference(double a, double b) {
  const Split s = sum(a, -b);
  Expansion e;
  add(e, s.error);
  add(e, s.value);
  return e;
}

Expansion times(const Expansion& a, const Expansion& b, double sign = 1.0) {
  Expansion result;
  for (const double p : a)
    for (const double q : b) {
      const Split s = product(sign * p, q);
      add(result, s.error);
      add(result, s.value);
    }
  return result;
}

Expansion plus(Expansion a, const Expansion& b) {
  for (const double term : b) add(a, term);
  return a;
}

int sign(double value) { return value > 0.0 ? 1 : (value < 0.0 ? -1 : 0); }
/// The largest term decides, since the others do not overlap with it.
int sign(const Expansion& e) { return e.empty() ? 0 : sign(e.back()); }

int exactOrientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  std::array<std::array<Expansion, 3>, 3> row;
  const std::array<const Vec3*, 3> end{&b, &c, &d};
  for (std::size_t i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) row[i][static_cast<std::size_t>(k)] = difference((*end[i])[k], a[k]);
  Expansion total;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    const Expansion minor = plus(times(row[0][l], row[1][m]), times(row[0][m], row[1][l], -1.0));
    total = plus(std::move(total), times(minor, row[2][k]));
  }
  return sign(total);
}

/// p and q on one line with the ends a, b of a segment, seen along the axis: whether p lies between them.
bool between(const Vec3& p, const Vec3& a, const Vec3& b, int axis) {
  for (const int k : {(axis + 1) % 3, (axis + 2) % 3})
    if (p[k] < std::min(a[k], b[k]) || p[k] > std::max(a[k], b[k])) return false;
  return true;
}

/// Closed segments pq and ab, projected along the axis.
bool segmentsMeet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, int axis) {
  const int pa = orientation(p, q, a, axis), pb = orientation(p, q, b, axis);
  const int ap = orientation(a, b, p, axis), aq = orientation(a, b, q, axis);
  if (pa * pb < 0 && ap * aq < 0) return true;
  return (pa == 0 && between(a, p, q, axis)) || (pb == 0 && between(b, p, q, axis)) ||
         (ap == 0 && between(p, a, b, axis)) || (aq == 0 && between(q, a, b, axis));
}

/// Segment in the plane of the triangle.
bool coplanarSegmentMeets(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t) {
  int axis = 0, sense = 0;
  for (; axis < 3; ++axis)
    if ((sense = orientation(t[0], t[1], t[2], axis)) != 0) break;
  if (sense == 0) return false;  // no area
  bool inside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    if (segmentsMeet(p, q, t[k], t[(k + 1) % 3], axis)) return true;
    inside = inside && orientation(t[k], t[(k + 1) % 3], p, axis) == sense;
  }
  return inside;
}

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double value = dot(cross(u, v), w);
  const double size = std::abs(w.x) * (std::abs(u.y * v.z) + std::abs(u.z * v.y)) +
                      std::abs(w.y) * (std::abs(u.z * v.x) + std::abs(u.x * v.z)) +
                      std::abs(w.z) * (std::abs(u.x * v.y) + std::abs(u.y * v.x));
  // Seven roundings on the longest way to a term are below 8 × 2^-53 relative to the sum of the terms' sizes.
  constexpr double bound = 8.0 * 0x1p-53 * (1.0 + 1e-10);
  if (std::abs(value) > bound * size) return sign(value);
  return exactOrientation(a, b, c, d);
}

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
  const int k = (axis + 1) % 3, l = (axis + 2) % 3;
  const double first = (b[k] - a[k]) * (c[l] - a[l]), second = (b[l] - a[l]) * (c[k] - a[k]);
  constexpr double bound = 4.0 * 0x1p-53 * (1.0 + 1e-10);
  if (std::abs(first - second) > bound * (std::abs(first) + std::abs(second))) return sign(first - second);
  return sign(plus(times(difference(b[k], a[k]), difference(c[l], a[l])),
                   times(difference(b[l], a[l]), difference(c[k], a[k]), -1.0)));
}

bool areCollinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  return orientation(a, b, c, 0) == 0 && orientation(a, b, c, 1) == 0 && orientation(a, b, c, 2) == 0;
}

bool segmentMeetsTriangle(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t) {
  const int atP = orientation(t[0], t[1], t[2], p), atQ = orientation(t[0], t[1], t[2], q);
  if (atP * atQ > 0) return false;
  if (atP == 0 && atQ == 0) return coplanarSegmentMeets(p, q, t);
  const int first = orientation(p, q, t[0], t[1]), second = orientation(p, q, t[1], t[2]),
            third = orientation(p, q, t[2], t[0]);
  return (first >= 0 && second >= 0 && third >= 0) || (first <= 0 && second <= 0 && third <= 0);
}

bool trianglesMeet(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (segmentMeetsTriangle(a[k], a[(k + 1) % 3], b) || segmentMeetsTriangle(b[k], b[(k + 1) % 3], a)) return true;
  return false;
}

}  // namespace dovetail::geometry
