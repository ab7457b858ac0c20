// Triangles: normal, area, and the point of a triangle closest to a given point.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "dovetail/core/vec3.hpp"

namespace dovetail::geometry {

/// The part of a triangle a closest point lies on; edge0 = v0v1, edge1 = v1v2, edge2 = v2v0.
enum class Feature : std::uint8_t { face, edge0, edge1, edge2, vertex0, vertex1, vertex2 };

constexpr bool isEdge(Feature f) { return f >= Feature::edge0 && f <= Feature::edge2; }
constexpr bool isVertex(Feature f) { return f >= Feature::vertex0; }

struct ClosestPoint {
  std::array<double, 3> barycentric;  ///< weights of v0, v1, v2; each ≥ 0, sum 1, zero off the feature
  Vec3 point;                         ///< m
  Feature feature;
};

/// A triangle whose height is below this fraction of its longest edge is treated as its three edges: there the edges
/// and the face give the same point to 1e-8 of the longest edge, while the face's weights would drown in round-off.
inline constexpr double flatTriangleHeight = 1e-8;

/// (b − a) × (c − a): twice the area (m²) times the unit normal, which points to the side from which a, b, c run
/// counter-clockwise.
inline Vec3 triangleAreaNormal(const Vec3& a, const Vec3& b, const Vec3& c) { return cross(b - a, c - a); }

/// m²
inline double triangleArea(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * norm(triangleAreaNormal(a, b, c));
}

/// Unit normal; the zero vector where the area vanishes.
inline Vec3 triangleNormal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = triangleAreaNormal(a, b, c);
  const double length = norm(n);
  return length > 0.0 ? n / length : Vec3{};
}

/// Longest edge squared, m².
inline double longestEdgeSquared(const Vec3& a, const Vec3& b, const Vec3& c) {
  return std::max({squaredNorm(b - a), squaredNorm(c - b), squaredNorm(a - c)});
}

namespace detail {

inline ClosestPoint atVertex(int k, const Vec3& v) {
  ClosestPoint r{{0.0, 0.0, 0.0}, v, static_cast<Feature>(static_cast<int>(Feature::vertex0) + k)};
  r.barycentric[static_cast<std::size_t>(k)] = 1.0;
  return r;
}

/// Point from + t (to − from) on edge k, 0 ≤ t ≤ 1.
inline ClosestPoint onEdge(int k, double t, const Vec3& from, const Vec3& to) {
  ClosestPoint r{{0.0, 0.0, 0.0}, from + t * (to - from), static_cast<Feature>(static_cast<int>(Feature::edge0) + k)};
  r.barycentric[static_cast<std::size_t>(k)] = 1.0 - t;
  r.barycentric[static_cast<std::size_t>((k + 1) % 3)] = t;
  return r;
}

/// Closest point on the three edges alone; an edge without length counts as its first vertex.
inline ClosestPoint closestPointOnEdges(const Vec3& p, const std::array<Vec3, 3>& v) {
  ClosestPoint best{};
  double bestDistance = 0.0;
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3;
    const Vec3 &from = v[static_cast<std::size_t>(k)], &to = v[static_cast<std::size_t>(l)];
    const double along = dot(p - from, to - from), length2 = squaredNorm(to - from);
    const ClosestPoint candidate = !(along > 0.0)     ? atVertex(k, from)
                                   : along >= length2 ? atVertex(l, to)
                                                      : onEdge(k, along / length2, from, to);
    const double distance = squaredNorm(p - candidate.point);
    if (k == 0 || distance < bestDistance) {
      best = candidate;
      bestDistance = distance;
    }
  }
  return best;
}

}  // namespace detail

/// The point of the triangle (a, b, c) closest to p, and the face, edge or vertex it lies on.
///
/// The Voronoi regions of the vertices and edges are told apart by the signs of projections on the edges and of the
/// barycentric coordinates (Ericson, Real-Time Collision Detection, 2005, sec. 5.1.5). The latter are taken from cross
/// products, whose round-off grows as 1/height where that of products of projections grows as 1/height².
/// Zero-area, repeated-vertex and needle triangles behave as their edges or vertices; finite input never gives NaN.
inline ClosestPoint closestPointOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Vec3 n = cross(ab, ac);
  const double ab2 = squaredNorm(ab), ac2 = squaredNorm(ac), bc2 = squaredNorm(c - b), n2 = squaredNorm(n);
  const double longest2 = std::max({ab2, ac2, bc2});
  if (!(n2 > flatTriangleHeight * flatTriangleHeight * longest2 * longest2))
    return detail::closestPointOnEdges(p, {a, b, c});

  const double abp = dot(ab, ap), acp = dot(ac, ap);  // projections of p from a
  if (abp <= 0.0 && acp <= 0.0) return detail::atVertex(0, a);
  const Vec3 bp = p - b;
  const double abFromB = dot(ab, bp), acFromB = dot(ac, bp);
  if (abFromB >= 0.0 && acFromB <= abFromB) return detail::atVertex(1, b);
  const double wc = dot(n, cross(ab, ap));
  if (wc <= 0.0 && abp >= 0.0 && abFromB <= 0.0) return detail::onEdge(0, std::min(1.0, abp / ab2), a, b);
  const Vec3 cp = p - c;
  const double abFromC = dot(ab, cp), acFromC = dot(ac, cp);
  if (acFromC >= 0.0 && abFromC <= acFromC) return detail::atVertex(2, c);
  const double wb = dot(n, cross(ap, ac));
  if (wb <= 0.0 && acp >= 0.0 && acFromC <= 0.0) return detail::onEdge(2, std::min(1.0, -acFromC / ac2), c, a);
  const double wa = n2 - wb - wc;
  const double fromB = acFromB - abFromB, fromC = abFromC - acFromC;  // along bc from b, along cb from c
  if (wa <= 0.0 && fromB >= 0.0 && fromC >= 0.0) return detail::onEdge(1, std::min(1.0, fromB / bc2), b, c);

  // Round-off at the border of a region can leave a tiny negative weight; it must not leak out.
  const double ka = std::max(wa, 0.0), kb = std::max(wb, 0.0), kc = std::max(wc, 0.0), scale = 1.0 / (ka + kb + kc);
  const double v = kb * scale, w = kc * scale;
  return {{ka * scale, v, w}, a + v * ab + w * ac, Feature::face};
}

}  // namespace dovetail::geometry
