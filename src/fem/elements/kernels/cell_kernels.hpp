// From displacements of four elements to deformation gradients, and from stresses and moduli to forces and tangents.
#pragma once

#include "dovetail/core/vector_code.hpp"
#include "elements/solids/solid_base.hpp"

namespace dovetail::fem::detail {

/// Displacements of the nodes of a batch, [3 a + i].
template <int N>
DOVETAIL_INLINE void gatherNodes(const SolidCells& cells, std::size_t batch, const Vec3* u, Lane* U) {
  for (std::size_t a = 0; a < N; ++a) {
    const auto& n = cells.batchNode[N * batch + a];
    const Vec3 &u0 = u[n[0]], &u1 = u[n[1]], &u2 = u[n[2]], &u3 = u[n[3]];
    U[3 * a] = Lane{u0.x, u1.x, u2.x, u3.x};
    U[3 * a + 1] = Lane{u0.y, u1.y, u2.y, u3.y};
    U[3 * a + 2] = Lane{u0.z, u1.z, u2.z, u3.z};
  }
}

/// H = ∂u/∂X, from ∂u/∂ξ · ∂ξ/∂X.
template <int N>
DOVETAIL_INLINE void displacementGradient(const Lane* U, const Vec3* gradient, const std::array<Lane, 9>& map,
                                          Lane* H) {
  Lane parent[9] = {};
  for (std::size_t a = 0; a < N; ++a) {
    const double g[3] = {gradient[a].x, gradient[a].y, gradient[a].z};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) parent[3 * i + j] += U[3 * a + i] * g[j];
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t J = 0; J < 3; ++J)
      H[3 * i + J] = parent[3 * i] * map[J] + parent[3 * i + 1] * map[3 + J] + parent[3 * i + 2] * map[6 + J];
}

/// f_a += weight P ∂ψ_a/∂X.
template <int N>
DOVETAIL_INLINE void addStressForces(const Lane* P, const Vec3* gradient, const PointGeometry& point, Lane* f) {
  Lane parent[9];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      parent[3 * i + j] = point.weight * (P[3 * i] * point.map[3 * j] + P[3 * i + 1] * point.map[3 * j + 1] +
                                          P[3 * i + 2] * point.map[3 * j + 2]);
  for (std::size_t a = 0; a < N; ++a) {
    const double g[3] = {gradient[a].x, gradient[a].y, gradient[a].z};
    for (std::size_t i = 0; i < 3; ++i)
      f[3 * a + i] += parent[3 * i] * g[0] + parent[3 * i + 1] * g[1] + parent[3 * i + 2] * g[2];
  }
}

/// The moduli along the parent axes: Â_ijkl = weight Σ_JL ∂ξ_j/∂X_J A_iJkL ∂ξ_l/∂X_L.
DOVETAIL_INLINE void parentModuli(const Lane* A, const PointGeometry& point, Lane* parent) {
  const auto& m = point.map;
  Lane half[81];
  for (std::size_t iJ = 0; iJ < 9; ++iJ)
    for (std::size_t k = 0; k < 3; ++k) {
      const Lane* const row = A + 9 * iJ + 3 * k;
      for (std::size_t l = 0; l < 3; ++l)
        half[9 * iJ + 3 * k + l] = point.weight * (row[0] * m[3 * l] + row[1] * m[3 * l + 1] + row[2] * m[3 * l + 2]);
    }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t kl = 0; kl < 9; ++kl)
        parent[9 * (3 * i + j) + kl] =
            m[3 * j] * half[27 * i + kl] + m[3 * j + 1] * half[27 * i + 9 + kl] + m[3 * j + 2] * half[27 * i + 18 + kl];
}

/// K_ab += ∂ψ_a/∂ξ · Â · ∂ψ_b/∂ξ, of the blocks a ≤ b if the moduli are symmetric.
template <int N, bool symmetric>
DOVETAIL_INLINE void addParentTangent(const Lane* parent, const Vec3* gradient, Lane* K) {
  for (std::size_t b = 0; b < N; ++b) {
    const double h[3] = {gradient[b].x, gradient[b].y, gradient[b].z};
    Lane T[27];  // [9 i + 3 k + j]
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t k = 0; k < 3; ++k) {
          const Lane* const row = parent + 9 * (3 * i + j) + 3 * k;
          T[9 * i + 3 * k + j] = row[0] * h[0] + row[1] * h[1] + row[2] * h[2];
        }
    const std::size_t last = symmetric ? b + 1 : N;
    for (std::size_t a = 0; a < last; ++a) {
      const double g[3] = {gradient[a].x, gradient[a].y, gradient[a].z};
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
          const Lane* const t = T + 9 * i + 3 * k;
          K[3 * N * (3 * a + i) + 3 * b + k] += t[0] * g[0] + t[1] * g[1] + t[2] * g[2];
        }
    }
  }
}

/// Copies the blocks a < b to b > a, transposed.
template <int N>
DOVETAIL_INLINE void mirror(Lane* K) {
  for (std::size_t r = 0; r < 3 * N; ++r)
    for (std::size_t c = 0; c < 3 * (r / 3); ++c) K[3 * N * r + c] = K[3 * N * c + r];
}

DOVETAIL_INLINE void addIdentity(Lane* H) { H[0] += 1.0, H[4] += 1.0, H[8] += 1.0; }

}  // namespace dovetail::fem::detail
