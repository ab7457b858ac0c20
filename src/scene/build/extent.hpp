// How far parts of a scene reach.
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/box.hpp"

namespace dovetail::scene {

/// A box that grows around places; empty at first.
struct Extent {
  static constexpr double nowhere = std::numeric_limits<double>::infinity();
  Vec3 lower{nowhere, nowhere, nowhere}, upper{-nowhere, -nowhere, -nowhere};

  void add(const Vec3& x) {
    for (int k = 0; k < 3; ++k) lower[k] = std::min(lower[k], x[k]), upper[k] = std::max(upper[k], x[k]);
  }
  void add(std::span<const Vec3> places) {
    for (const Vec3& x : places) add(x);
  }
  void widen(double by) { lower -= Vec3{by, by, by}, upper += Vec3{by, by, by}; }
  bool isEmpty() const { return lower.x > upper.x; }
  /// Diagonal, m.
  double size() const { return isEmpty() ? 0.0 : norm(upper - lower); }
};

inline bool meet(const geometry::Box& a, const geometry::Box& b) {
  for (int k = 0; k < 3; ++k)
    if (a.lower[k] > b.upper[k] || b.lower[k] > a.upper[k]) return false;
  return true;
}
/// Whether a box that moves meets another one within a time, s.
inline bool comesTo(const Extent& moving, const Vec3& velocity, const Extent& other, double time) {
  double begin = 0.0, end = time;
  for (int k = 0; k < 3; ++k) {
    const double before = other.lower[k] - moving.upper[k], behind = other.upper[k] - moving.lower[k];
    if (velocity[k] == 0.0) {
      if (before > 0.0 || behind < 0.0) return false;
      continue;
    }
    const double one = before / velocity[k], two = behind / velocity[k];
    begin = std::max(begin, std::min(one, two)), end = std::min(end, std::max(one, two));
  }
  return begin <= end;
}
inline bool holds(const geometry::Box& box, const Vec3& x) { return meet(box, {x, x}); }

}  // namespace dovetail::scene
