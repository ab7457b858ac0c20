// What is computed for all points of an enhanced brick, in the version that fits the processor.
#include "cell_kernels.hpp"
#include "enhanced_modes.hpp"
#include "enhanced_tangent.hpp"

namespace dovetail::fem::detail::enhanced {

namespace {

DOVETAIL_INLINE void multiply(const Lane* a, const Lane* b, Lane* result) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      result[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
}

/// What of the state depends on u alone.
DOVETAIL_INLINE void displace(const EnhancedCells& cells, const Displacements& U, State& s) {
  for (Lane& entry : s.F0) entry = Lane{};
  for (std::size_t a = 0; a < N; ++a)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t J = 0; J < 3; ++J) s.F0[3 * i + J] += U[3 * a + i] * cells.centre.gradient[3 * a + J];
  addIdentity(s.F0);
  multiply(s.F0, cells.centre.left.data(), s.F0left);
  for (std::size_t q = 0; q < Q; ++q) {
    displacementGradient<N>(U.data(), cells.gradients(q), cells.point[q].map, &s.compatible[9 * q]);
    addIdentity(&s.compatible[9 * q]);
  }
}

/// F at all points for these modes.
DOVETAIL_INLINE void enhance(const EnhancedCells& cells, const Modes& alpha, State& s) {
  Lane rows[9], change[27];
  multiply(alpha.data(), cells.centre.map0.data(), rows);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t J = 0; J < 3; ++J) {
        s.enhancement[9 * i + 3 * r + J] = cells.centre.left[3 * r + i] * rows[3 * i + J];
        change[9 * i + 3 * r + J] = s.F0left[3 * r + i] * rows[3 * i + J];
      }
  for (std::size_t q = 0; q < Q; ++q) {
    const Lane x = cells.scale(q, 0), y = cells.scale(q, 1), z = cells.scale(q, 2);
    for (std::size_t k = 0; k < 9; ++k)
      s.F[9 * q + k] = s.compatible[9 * q + k] + (x * change[k] + y * change[9 + k] + z * change[18 + k]);
  }
}

DOVETAIL_INLINE void weigh(const EnhancedCells& cells, double fraction, double resolution, State& s, Modes& residual,
                           Modes& tolerance) {
  for (Lane& entry : s.stress) entry = Lane{};
  Lane size[9];
  for (Lane& entry : size) entry = Lane{};
  for (std::size_t q = 0; q < Q; ++q) {
    const Lane weight = cells.point[q].weight, x = weight * cells.scale(q, 0);
    const Lane y = weight * cells.scale(q, 1), z = weight * cells.scale(q, 2), all = magnitude(x);
    for (std::size_t k = 0; k < 9; ++k) {
      const Lane P = s.P[9 * q + k];
      s.stress[k] += x * P;
      s.stress[9 + k] += y * P;
      s.stress[18 + k] += z * P;
      size[k] += all * (fraction * magnitude(P) + resolution);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    Lane along[3], largest[3];
    for (std::size_t J = 0; J < 3; ++J) {
      const Lane a = s.F0left[i], b = s.F0left[3 + i], c = s.F0left[6 + i];
      along[J] = a * s.stress[9 * i + J] + b * s.stress[9 * i + 3 + J] + c * s.stress[9 * i + 6 + J];
      largest[J] = magnitude(a) * size[J] + magnitude(b) * size[3 + J] + magnitude(c) * size[6 + J];
    }
    for (std::size_t j = 0; j < 3; ++j) {
      const Lane* const row = &cells.centre.map0[3 * j];
      residual[3 * i + j] = along[0] * row[0] + along[1] * row[1] + along[2] * row[2];
      tolerance[3 * i + j] =
          largest[0] * magnitude(row[0]) + largest[1] * magnitude(row[1]) + largest[2] * magnitude(row[2]);
    }
  }
}

/// K += ∂r_m/∂α_n from the moduli of one point.
DOVETAIL_INLINE void addModeStiffness(const EnhancedCells& cells, const State& s, std::size_t q, const Lane* A,
                                      ModeMatrix& K) {
  Lane turned[81], both[81];
  alongModes(A, s, cells, turned);
  alongModes(turned, s, cells, both);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const Lane scale = cells.point[q].weight * cells.scale(q, i) * cells.scale(q, k);
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t l = 0; l < 3; ++l) {
          const std::size_t entry = M * (3 * i + j) + 3 * k + l;
          K[entry] += scale * both[entry];
        }
    }
}

/// Each lane's inverse, without pivoting: the matrix is close to a symmetric positive definite one.
DOVETAIL_INLINE void invert(ModeMatrix& A) {
  for (std::size_t k = 0; k < M; ++k) {
    const Lane pivot = 1.0 / A[M * k + k];
    A[M * k + k] = Lane{} + 1.0;
    for (std::size_t c = 0; c < M; ++c) A[M * k + c] *= pivot;
    for (std::size_t r = 0; r < M; ++r) {
      if (r == k) continue;
      const Lane factor = A[M * r + k];
      A[M * r + k] = Lane{};
      for (std::size_t c = 0; c < M; ++c) A[M * r + c] -= factor * A[M * k + c];
    }
  }
}

DOVETAIL_INLINE void modesOf(const EnhancedCells& cells, const State& s, const Moduli& A, ModeMatrix& inverse) {
  inverse.fill(Lane{});
  for (std::size_t q = 0; q < Q; ++q) addModeStiffness(cells, s, q, &A[81 * q], inverse);
  for (std::size_t lane = cells.inUse; lane < laneCount; ++lane)
    for (std::size_t m = 0; m < M; ++m) inverse[(M + 1) * m][static_cast<int>(lane)] = 1.0;
  invert(inverse);
}

DOVETAIL_INLINE void forcesOf(const EnhancedCells& cells, const State& s, Lane* f) {
  for (std::size_t k = 0; k < 3 * N; ++k) f[k] = Lane{};
  for (std::size_t q = 0; q < Q; ++q) addStressForces<N>(&s.P[9 * q], cells.gradients(q), cells.point[q], f);
  Lane moment[9] = {};  // Σ weight P Ĥᵀ
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t K = 0; K < 3; ++K)
        for (std::size_t J = 0; J < 3; ++J)
          moment[3 * r + K] += s.stress[9 * i + 3 * r + J] * s.enhancement[9 * i + 3 * K + J];
  const auto& g0 = cells.centre.gradient;
  for (std::size_t a = 0; a < N; ++a)
    for (std::size_t i = 0; i < 3; ++i)
      f[3 * a + i] += moment[3 * i] * g0[3 * a] + moment[3 * i + 1] * g0[3 * a + 1] + moment[3 * i + 2] * g0[3 * a + 2];
}

template <bool symmetric>
DOVETAIL_INLINE void tangentOf(const EnhancedCells& cells, const State& s, const Moduli& A, Lane* K) {
  for (std::size_t k = 0; k < 9 * N * N; ++k) K[k] = Lane{};
  ModeCouplings modes{};
  for (std::size_t q = 0; q < Q; ++q) {
    Lane g[3 * N];
    effectiveGradients(cells, s, q, g);
    addDisplacementTangent<symmetric>(&A[81 * q], cells.point[q].weight, g, K);
    addModeCouplings<symmetric>(cells, s, q, &A[81 * q], g, modes);
  }
  addModeRotation(cells, s, modes);
  ModeMatrix inverse;
  modesOf(cells, s, A, inverse);
  condense<symmetric>(inverse, modes, K);
  if (symmetric) mirror<N>(K);
}

}  // namespace

void setDisplacements(const EnhancedCells& cells, const Displacements& U, State& s) {
  withVectors([&] { displace(cells, U, s); });
}
void setModes(const EnhancedCells& cells, const Modes& alpha, State& s) {
  withVectors([&] { enhance(cells, alpha, s); });
}
void modeResidual(const EnhancedCells& cells, double fraction, double resolution, State& s, Modes& residual,
                  Modes& tolerance) {
  withVectors([&] { weigh(cells, fraction, resolution, s, residual, tolerance); });
}
void inverseOfModes(const EnhancedCells& cells, const State& s, const Moduli& A, ModeMatrix& inverse) {
  withVectors([&] { modesOf(cells, s, A, inverse); });
}
void modeStep(const ModeMatrix& inverse, const Modes& residual, Modes& step) {
  withVectors([&] {
    for (std::size_t r = 0; r < M; ++r) {
      Lane sum = inverse[M * r] * residual[0];
      for (std::size_t c = 1; c < M; ++c) sum += inverse[M * r + c] * residual[c];
      step[r] = sum;
    }
  });
}
void modeForces(const EnhancedCells& cells, const State& s, Lane* f) {
  withVectors([&] { forcesOf(cells, s, f); });
}
template <bool symmetric>
void condensedTangent(const EnhancedCells& cells, const State& s, const Moduli& A, Lane* K) {
  withVectors([&] { tangentOf<symmetric>(cells, s, A, K); });
}
template void condensedTangent<true>(const EnhancedCells&, const State&, const Moduli&, Lane*);
template void condensedTangent<false>(const EnhancedCells&, const State&, const Moduli&, Lane*);

}  // namespace dovetail::fem::detail::enhanced
