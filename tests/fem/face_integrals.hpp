// Areas and enclosed volumes of faces of all shapes, by shape functions written down here a second time.
#pragma once

#include <cmath>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::fem {

struct FaceIntegrals {
  Vec3 area;            ///< ∫n dA, m²
  double volume = 0.0;  ///< ⅓ ∫X·n dA, in a plane ½, m³
  double length = 0.0;  ///< of lines, m
};

/// Polynomial basis of a face in its parent coordinates, quads on (−1, 1)², triangles on the unit triangle, lines on
/// (−1, 1).
inline std::vector<double> faceBasis(FaceShape shape, double r, double s) {
  const double q = 1.0 - r - s;
  switch (shape) {
    case FaceShape::line2:
      return {(1 - r) / 2, (1 + r) / 2};
    case FaceShape::line3:
      return {r * (r - 1) / 2, r * (r + 1) / 2, 1 - r * r};
    case FaceShape::tri3:
      return {q, r, s};
    case FaceShape::tri6:
      return {q * (2 * q - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * q * r, 4 * r * s, 4 * s * q};
    case FaceShape::quad4:
      return {(1 - r) * (1 - s) / 4, (1 + r) * (1 - s) / 4, (1 + r) * (1 + s) / 4, (1 - r) * (1 + s) / 4};
    case FaceShape::quad8: {
      std::vector<double> N = faceBasis(FaceShape::quad4, r, s);
      const double mid[] = {(1 - r * r) * (1 - s) / 2, (1 + r) * (1 - s * s) / 2, (1 - r * r) * (1 + s) / 2,
                            (1 - r) * (1 - s * s) / 2};
      for (std::size_t k = 0; k < 4; ++k) N[k] -= 0.5 * (mid[k] + mid[(k + 3) % 4]);
      N.insert(N.end(), mid, mid + 4);
      return N;
    }
    case FaceShape::quad9: {
      const auto line = [](int k, double x) { return k < 0 ? x * (x - 1) / 2 : k > 0 ? x * (x + 1) / 2 : 1 - x * x; };
      std::vector<double> N;
      for (const auto& [i, j] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}, {0, 0}})
        N.push_back(line(i, r) * line(j, s));
      return N;
    }
  }
  return {};
}

inline Vec3 facePoint(const SolidMesh& mesh, const Face& face, double r, double s) {
  const std::vector<double> N = faceBasis(face.shape, r, s);
  Vec3 X;
  for (std::size_t k = 0; k < N.size(); ++k) X += N[k] * mesh.X[static_cast<std::size_t>(face.node[k])];
  return X;
}

/// Six Gauss points in each direction (triangles by collapsing a square), tangents by differences that are exact for
/// quadratics: exact for all shapes.
inline FaceIntegrals integrateFaces(const SolidMesh& mesh, const std::vector<Face>& faces) {
  const double point[] = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
  const double weight[] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
  FaceIntegrals sum;
  for (const Face& face : faces) {
    const bool triangle = face.shape == FaceShape::tri3 || face.shape == FaceShape::tri6;
    const bool line = dimensionOf(face.shape) == 2;
    for (int i = 0; i < 36; ++i) {
      const auto a = static_cast<std::size_t>(i % 3), b = static_cast<std::size_t>(i / 12);
      const double x = (i / 3 % 2 ? 1 : -1) * point[a], y = (i / 6 % 2 ? 1 : -1) * point[b];
      const double r = triangle ? (1 + x) * (1 - y) / 4 : x, s = triangle ? (1 + y) / 2 : y;
      const double w = weight[a] * weight[b] * (triangle ? (1 - y) / 8 : 1.0), h = 0.5;
      const Vec3 t1 = facePoint(mesh, face, r + h, s) - facePoint(mesh, face, r - h, s);
      const Vec3 t2 =
          line ? Vec3{0, 0, 0.5 * mesh.thickness} : facePoint(mesh, face, r, s + h) - facePoint(mesh, face, r, s - h);
      const Vec3 dA = w * cross(t1, t2);
      sum.area += dA;
      if (line) sum.length += norm(dA) / mesh.thickness;
      sum.volume += dot(facePoint(mesh, face, r, s), dA) / (line ? 2.0 : 3.0);
    }
  }
  return sum;
}

}  // namespace dovetail::fem
