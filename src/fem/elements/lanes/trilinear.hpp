// Gradients of trilinear fields at the 2×2×2 Gauss points by sums along the edges, and their transpose.
//
// ∂u/∂ξ does not depend on ξ, so each direction has four values, indexed by the Gauss points of the face across it:
// bit 0 is the sign of the first of the other two coordinates, bit 1 that of the second.
#pragma once

#include <utility>

#include "elements/bricks/brick.hpp"
#include "lane.hpp"

namespace dovetail::fem::detail::bricks {

using Tensor = std::array<std::array<Lane, 3>, 3>;
/// [component][direction][point of the face]
using PlanarField = std::array<std::array<std::array<Lane, 4>, 3>, 3>;

/// Place of Gauss point p in the face across direction 0, 1, 2.
template <int P>
inline constexpr std::array<std::size_t, 3> inFace = {P >> 1 & 3, (P & 1) | (P >> 1 & 2), P & 3};

/// Calls body(std::integral_constant<int, p>) for p = 0 … 7, unrolled.
template <class Body>
DOVETAIL_INLINE void forEachPoint(Body&& body) {
  [&]<int... P>(std::integer_sequence<int, P...>) __attribute__((always_inline)) {
    (body(std::integral_constant<int, P>{}), ...);
  }
  (std::make_integer_sequence<int, 8>{});
}

/// s ((a + g b) ± g (c + g d)) and s ((a − g b) ± g (c − g d)).
DOVETAIL_INLINE void faceValues(Lane a, Lane b, Lane c, Lane d, Lane scale, std::array<Lane, 4>& out) {
  const Lane lower = scale * (a - gaussDistance * b), upper = scale * (a + gaussDistance * b);
  const Lane scaled = scale * gaussDistance;
  const Lane slopeLower = c - gaussDistance * d, slopeUpper = c + gaussDistance * d;
  out[0] = lower - scaled * slopeLower;
  out[1] = upper - scaled * slopeUpper;
  out[2] = lower + scaled * slopeLower;
  out[3] = upper + scaled * slopeUpper;
}

/// scale_j · 8 ∂u/∂ξ_j of one component from its eight corner values.
DOVETAIL_INLINE void gradientOf(const std::array<Lane, 8>& u, const std::array<Lane, 3>& scale,
                                std::array<std::array<Lane, 4>, 3>& out) {
  const Lane d0 = u[1] - u[0], d1 = u[3] - u[2], d2 = u[5] - u[4], d3 = u[7] - u[6];
  const Lane s0 = u[1] + u[0], s1 = u[3] + u[2], s2 = u[5] + u[4], s3 = u[7] + u[6];
  const Lane dp = d0 + d1, dq = d2 + d3, dr = d1 - d0, dt = d3 - d2;
  const Lane sr = s1 - s0, st = s3 - s2;
  const Lane x = dp + dq, zx = dq - dp, xy = dr + dt, xyz = dt - dr;
  const Lane y = sr + st, yz = st - sr, z = (s2 + s3) - (s0 + s1);
  faceValues(x, xy, zx, xyz, scale[0], out[0]);
  faceValues(y, xy, yz, xyz, scale[1], out[1]);
  faceValues(z, zx, yz, xyz, scale[2], out[2]);
}

/// Transpose of faceValues.
DOVETAIL_INLINE void addFaceMoments(const std::array<Lane, 4>& r, Lane scale, Lane& a, Lane& b, Lane& c, Lane& d) {
  const Lane scaled = scale * gaussDistance, twice = scaled * gaussDistance;
  const Lane lower = r[0] + r[2], upper = r[1] + r[3], slopeLower = r[2] - r[0], slopeUpper = r[3] - r[1];
  a += scale * (lower + upper);
  b += scaled * (upper - lower);
  c += scaled * (slopeLower + slopeUpper);
  d += twice * (slopeUpper - slopeLower);
}

/// Transpose of gradientOf: eight corner values from the face values summed along each direction.
DOVETAIL_INLINE void transposedGradient(const std::array<std::array<Lane, 4>, 3>& r, const std::array<Lane, 3>& scale,
                                        std::array<Lane, 8>& out) {
  Lane x{}, y{}, z{}, xy{}, yz{}, zx{}, xyz{};
  addFaceMoments(r[0], scale[0], x, xy, zx, xyz);
  addFaceMoments(r[1], scale[1], y, xy, yz, xyz);
  addFaceMoments(r[2], scale[2], z, zx, yz, xyz);
  const Lane p = x - zx, q = x + zx, a = xy - xyz, b = xy + xyz;
  const Lane d0 = p - a, d1 = p + a, d2 = q - b, d3 = q + b;
  const Lane e = y - yz, g = y + yz;
  const Lane s0 = -z - e, s1 = e - z, s2 = z - g, s3 = z + g;
  out = {s0 - d0, s0 + d0, s1 - d1, s1 + d1, s2 - d2, s2 + d2, s3 - d3, s3 + d3};
}

DOVETAIL_INLINE void gatherCorners(const Batch& batch, const Vec3* u, std::array<std::array<Lane, 8>, 3>& out) {
  for (std::size_t a = 0; a < 8; ++a) {
    const auto& n = batch.node[a];
    const Vec3 &u0 = u[n[0]], &u1 = u[n[1]], &u2 = u[n[2]], &u3 = u[n[3]];
    out[0][a] = Lane{u0.x, u1.x, u2.x, u3.x};
    out[1][a] = Lane{u0.y, u1.y, u2.y, u3.y};
    out[2][a] = Lane{u0.z, u1.z, u2.z, u3.z};
  }
}

DOVETAIL_INLINE void planarGradient(const Batch& batch, const Vec3* u, const std::array<Lane, 3>& scale,
                                    PlanarField& out) {
  std::array<std::array<Lane, 8>, 3> corners;
  gatherCorners(batch, u, corners);
  for (std::size_t c = 0; c < 3; ++c) gradientOf(corners[c], scale, out[c]);
}

DOVETAIL_INLINE void planarForces(const PlanarField& sums, const std::array<Lane, 3>& scale, BatchForces& out) {
  for (std::size_t c = 0; c < 3; ++c) transposedGradient(sums[c], scale, out.f[c]);
}

/// The gradient at Gauss point P.
template <int P>
DOVETAIL_INLINE Tensor valueAt(const PlanarField& field) {
  Tensor value;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) value[i][j] = field[i][j][inFace<P>[j]];
  return value;
}

/// parent · map.
DOVETAIL_INLINE Tensor mapped(const Tensor& parent, const std::array<Lane, 9>& map) {
  Tensor H;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      H[i][j] = parent[i][0] * map[j] + parent[i][1] * map[3 + j] + parent[i][2] * map[6 + j];
  return H;
}

/// Scale of gradientOf for ∂/∂ξ.
DOVETAIL_INLINE std::array<Lane, 3> parentScale() {
  constexpr double eighth = 0.125;
  const Lane scale = {eighth, eighth, eighth, eighth};
  return {scale, scale, scale};
}

}  // namespace dovetail::fem::detail::bricks
