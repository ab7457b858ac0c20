// Bricks and plane cells with a dilatation of their own: U = Σ weight W(F̄), F̄ = s F, s = (θ/J)^⅓, θ the element's L²
// projection of J on constants (hex8, quad4; Simo, Taylor & Pister 1985), on 1, ξ, η, ζ (hex20, hex27) or on 1, ξ, η
// (quad8). θ is condensed, force and tangent are the first and second derivative of U.
#include <cmath>

#include "dovetail/core/error.hpp"
#include "elements/kernels/cell_kernels.hpp"
#include "elements/lanes/small_tensors.hpp"

namespace dovetail::fem::detail {

namespace {

DOVETAIL_INLINE Lane cubeRoot(Lane x) {
  Lane root;
  for (int lane = 0; lane < laneCount; ++lane) root[lane] = std::cbrt(x[lane]);
  return root;
}

/// N nodes, Q points, L dilatation modes.
template <int N, std::size_t Q, std::size_t L>
class MeanDilatationSolid final : public SolidBase {
public:
  MeanDilatationSolid(SolidCells cells, std::unique_ptr<SolidPoints> points, const SolidOptions& options)
      : SolidBase(std::move(cells), std::move(points), options), projection_(cells_.batches()) {
    for (std::size_t b = 0; b < cells_.batches(); ++b) setProjection(b);
  }

private:
  using Tensors = std::array<Lane, 9 * Q>;
  using Gram = Lanes<L * L>;
  using Modes = std::array<Lane, L>;

  /// Kinematics of a batch.
  struct Dilatation {
    Tensors F, inverse, mixed;            ///< F, F⁻¹, F̄
    std::array<Lane, Q> J, scale, theta;  ///< det F, s, θ
  };
  /// What follows from the stress at F̄.
  struct Stresses {
    std::array<Lane, Q> trace;     ///< P̄ : F̄
    Tensors direct;                ///< ∂/∂F at fixed θ: s (P̄ − ⅓ (P̄:F) F⁻ᵀ)
    std::array<Lane, Q> pressure;  ///< what multiplies ∂J/∂F, Pa
  };

  std::size_t formulationMemory() const override { return projection_.capacity() * sizeof(Gram); }
  const Vec3* gradients(std::size_t q) const { return &rule_->gradient[N * q]; }
  const PointGeometry& point(std::size_t batch, std::size_t q) const { return geometry_[batch * Q + q]; }
  double mode(std::size_t l, std::size_t q) const { return l == 0 ? 1.0 : rule_->point[q][static_cast<int>(l) - 1]; }

  /// Inverse of Σ weight φ_k φ_l; identity in lanes that repeat an element.
  void setProjection(std::size_t b) {
    Gram gram{}, inverse{};
    for (std::size_t q = 0; q < Q; ++q)
      for (std::size_t k = 0; k < L; ++k)
        for (std::size_t l = 0; l < L; ++l) gram[L * k + l] += point(b, q).weight * (mode(k, q) * mode(l, q));
    for (std::size_t k = 0; k < L; ++k) {
      inverse[L * k + k] += 1.0;
      for (std::size_t lane = cells_.inUse(b); lane < laneCount; ++lane) gram[L * k + k][static_cast<int>(lane)] = 1.0;
    }
    for (std::size_t k = 0; k < L; ++k) {  // Gauss and Jordan; the matrix is positive definite
      const Lane pivot = 1.0 / gram[L * k + k];
      for (std::size_t c = 0; c < L; ++c) gram[L * k + c] *= pivot, inverse[L * k + c] *= pivot;
      for (std::size_t r = 0; r < L; ++r) {
        if (r == k) continue;
        const Lane factor = gram[L * r + k];
        for (std::size_t c = 0; c < L; ++c) {
          gram[L * r + c] -= factor * gram[L * k + c];
          inverse[L * r + c] -= factor * inverse[L * k + c];
        }
      }
    }
    projection_[b] = inverse;
  }

  /// The field at the points whose moments with the modes are given.
  std::array<Lane, Q> projected(std::size_t b, const Modes& moments) const {
    Modes fraction{};
    for (std::size_t k = 0; k < L; ++k)
      for (std::size_t l = 0; l < L; ++l) fraction[k] += projection_[b][L * k + l] * moments[l];
    std::array<Lane, Q> field{};
    for (std::size_t q = 0; q < Q; ++q)
      for (std::size_t k = 0; k < L; ++k) field[q] += mode(k, q) * fraction[k];
    return field;
  }

  void kinematics(const BatchTask& task, Dilatation& d) const {
    Lane U[3 * N];
    gatherNodes<N>(cells_, task.batch, task.u, U);
    Modes moments{};
    for (std::size_t q = 0; q < Q; ++q) {
      displacementGradient<N>(U, gradients(q), point(task.batch, q).map, &d.F[9 * q]);
      addIdentity(&d.F[9 * q]);
      d.J[q] = inverseOf(&d.F[9 * q], &d.inverse[9 * q]);
      for (std::size_t l = 0; l < L; ++l) moments[l] += point(task.batch, q).weight * d.J[q] * mode(l, q);
    }
    d.theta = projected(task.batch, moments);
    for (std::size_t q = 0; q < Q; ++q) {
      for (std::size_t lane = cells_.inUse(task.batch); lane < laneCount; ++lane)
        d.theta[q][static_cast<int>(lane)] = d.J[q][static_cast<int>(lane)];
      d.scale[q] = cubeRoot(d.theta[q] / d.J[q]);
      for (std::size_t k = 0; k < 9; ++k) d.mixed[9 * q + k] = d.scale[q] * d.F[9 * q + k];
    }
  }

  void deformation(const BatchTask& task, Lane* F) const override {
    Dilatation d;
    kinematics(task, d);
    std::copy(d.mixed.begin(), d.mixed.end(), F);
  }
  void compatibleDeformation(const BatchTask& task, Lane* F) const override {
    Dilatation d;
    kinematics(task, d);
    std::copy(d.F.begin(), d.F.end(), F);
  }

  void derivatives(const BatchTask& task, const Dilatation& d, const Tensors& P, Stresses& s) const {
    Modes moments{};
    for (std::size_t q = 0; q < Q; ++q) {
      s.trace[q] = contraction(&P[9 * q], &d.mixed[9 * q]);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t J = 0; J < 3; ++J)
          s.direct[9 * q + 3 * i + J] =
              d.scale[q] * P[9 * q + 3 * i + J] - s.trace[q] / 3.0 * d.inverse[9 * q + 3 * J + i];
      const Lane density = point(task.batch, q).weight * s.trace[q] / (3.0 * d.theta[q]);
      for (std::size_t l = 0; l < L; ++l) moments[l] += density * mode(l, q);
    }
    s.pressure = projected(task.batch, moments);
  }

  void forces(const BatchTask& task, BatchResult& result) override {
    withVectors([&] { forcesOf(task, result); });
  }
  void tangent(const BatchTask& task, Lane* K) override {
    withVectors([&] { tangentOf(task, K); });
  }

  void forcesOf(const BatchTask& task, BatchResult& result) {
    Dilatation d;
    Tensors P;
    Stresses s;
    std::array<Lane, Q> energy{}, dissipated{};
    kinematics(task, d);
    evaluate(task, d.mixed.data(), P.data(), nullptr, task.wantEnergy ? energy.data() : nullptr,
             task.wantDissipation ? dissipated.data() : nullptr);
    derivatives(task, d, P, s);
    for (std::size_t k = 0; k < 3 * N; ++k) result.f[k] = Lane{};
    result.energy = result.dissipated = Lane{};
    for (std::size_t q = 0; q < Q; ++q) {
      const PointGeometry& here = point(task.batch, q);
      Lane total[9];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t J = 0; J < 3; ++J)
          total[3 * i + J] = s.direct[9 * q + 3 * i + J] + s.pressure[q] * d.J[q] * d.inverse[9 * q + 3 * J + i];
      addStressForces<N>(total, gradients(q), here, result.f.data());
      result.energy += here.weight * energy[q];
      result.dissipated += here.weight * dissipated[q];
    }
  }

  /// Second derivative by F at fixed θ, plus pressure ∂²J/∂F². A holds ∂P̄/∂F̄ and is overwritten.
  DOVETAIL_INLINE static void pointModuli(const Lane* P, const Lane* F, const Lane* inverse, Lane scale, Lane trace,
                                          Lane J, Lane pressure, Lane* A) {
    Lane T[9], AF[9], FA[9];  // T = F⁻ᵀ
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) T[3 * i + k] = inverse[3 * k + i];
    apply(A, F, AF);
    applyTransposed(A, F, FA);
    const Lane FAF = contraction(F, AF), square = scale * scale;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t Jx = 0; Jx < 3; ++Jx)
        for (std::size_t k = 0; k < 3; ++k)
          for (std::size_t M = 0; M < 3; ++M) {
            const std::size_t p = 3 * i + Jx, q = 3 * k + M;
            const Lane crossed = inverse[3 * M + i] * inverse[3 * Jx + k];
            const Lane deviator = A[9 * p + q] - (T[p] * FA[q] + AF[p] * T[q]) / 3.0 + FAF / 9.0 * T[p] * T[q];
            A[9 * p + q] = square * deviator - scale / 3.0 * (P[p] * T[q] + T[p] * P[q]) + trace / 9.0 * T[p] * T[q] +
                           trace / 3.0 * crossed + pressure * J * (T[p] * T[q] - crossed);
          }
  }

  /// Derivatives of U by u and the modes of θ.
  struct Mixed {
    std::array<Lane, 3 * N * L> right{}, left{}, slope{};  ///< ∂²U/∂u∂θ both ways, moments of ∂J/∂u; [3 N l + 3 a + i]
    Gram curvature{};                                      ///< ∂²U/∂θ²
  };

  void addMixed(const BatchTask& task, const Dilatation& d, const Stresses& s, const Lane* A, std::size_t q,
                Mixed& m) const {
    const PointGeometry& here = point(task.batch, q);
    const Lane *const mixed = &d.mixed[9 * q], *const inverse = &d.inverse[9 * q];
    Lane AF[9], FA[9], rightStress[9], leftStress[9], slopeStress[9];
    apply(A, mixed, AF);
    applyTransposed(A, mixed, FA);
    const Lane FAF = contraction(mixed, AF), third = 1.0 / (3.0 * d.theta[q]);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t J = 0; J < 3; ++J) {
        const std::size_t k = 3 * i + J;
        const Lane T = inverse[3 * J + i];
        rightStress[k] = third * (s.direct[9 * q + k] + d.scale[q] * AF[k] - FAF / 3.0 * T);
        leftStress[k] = third * (s.direct[9 * q + k] + d.scale[q] * FA[k] - FAF / 3.0 * T);
        slopeStress[k] = d.J[q] * T;
      }
    const Lane curvature = here.weight * (FAF - 2.0 * s.trace[q]) * third * third;
    for (std::size_t l = 0; l < L; ++l) {
      PointGeometry weighted = here;
      weighted.weight *= mode(l, q);
      addStressForces<N>(rightStress, gradients(q), weighted, &m.right[3 * N * l]);
      addStressForces<N>(leftStress, gradients(q), weighted, &m.left[3 * N * l]);
      addStressForces<N>(slopeStress, gradients(q), weighted, &m.slope[3 * N * l]);
      for (std::size_t k = 0; k < L; ++k) m.curvature[L * l + k] += curvature * (mode(l, q) * mode(k, q));
    }
  }

  void tangentOf(const BatchTask& task, Lane* K) {
    Dilatation d;
    Tensors P;
    Stresses s;
    std::array<Lane, 81 * Q> A;
    kinematics(task, d);
    evaluate(task, d.mixed.data(), P.data(), A.data(), nullptr, nullptr);
    derivatives(task, d, P, s);
    std::fill(K, K + 9 * N * N, Lane{});
    Mixed m;
    Lane parent[81];
    for (std::size_t q = 0; q < Q; ++q) {
      addMixed(task, d, s, &A[81 * q], q, m);
      pointModuli(&P[9 * q], &d.F[9 * q], &d.inverse[9 * q], d.scale[q], s.trace[q], d.J[q], s.pressure[q], &A[81 * q]);
      parentModuli(&A[81 * q], point(task.batch, q), parent);
      addParentTangent<N, false>(parent, gradients(q), K);
    }
    std::array<Lane, 3 * N * L> theta{};  // ∂θ_l/∂u
    for (std::size_t l = 0; l < L; ++l)
      for (std::size_t k = 0; k < L; ++k)
        for (std::size_t r = 0; r < 3 * N; ++r)
          theta[3 * N * l + r] += projection_[task.batch][L * l + k] * m.slope[3 * N * k + r];
    for (std::size_t l = 0; l < L; ++l) {
      const Lane *const right = &m.right[3 * N * l], *const left = &m.left[3 * N * l], *const t = &theta[3 * N * l];
      for (std::size_t r = 0; r < 3 * N; ++r) {
        Lane bent{};
        for (std::size_t k = 0; k < L; ++k) bent += m.curvature[L * k + l] * theta[3 * N * k + r];
        for (std::size_t c = 0; c < 3 * N; ++c) K[3 * N * r + c] += (right[r] + bent) * t[c] + t[r] * left[c];
      }
    }
  }

  std::vector<Gram> projection_;
};

}  // namespace

std::shared_ptr<Solid> makeMeanDilatationSolid(SolidCells cells, std::unique_ptr<SolidPoints> points,
                                               const SolidOptions& options) {
  switch (cells.shape) {
    case ElementShape::hex8:
      return std::make_shared<MeanDilatationSolid<8, 8, 1>>(std::move(cells), std::move(points), options);
    case ElementShape::hex20:
      return std::make_shared<MeanDilatationSolid<20, 27, 4>>(std::move(cells), std::move(points), options);
    case ElementShape::hex27:
      return std::make_shared<MeanDilatationSolid<27, 27, 4>>(std::move(cells), std::move(points), options);
    case ElementShape::quad4:
      return std::make_shared<MeanDilatationSolid<4, 4, 1>>(std::move(cells), std::move(points), options);
    case ElementShape::quad8:
      return std::make_shared<MeanDilatationSolid<8, 9, 3>>(std::move(cells), std::move(points), options);
    default:
      break;
  }
  throw InputError(std::string("mean dilatation is for bricks and plane cells, not for ") + name(cells.shape),
                   "elements", "take the standard formulation, or a mesh of bricks");
}

}  // namespace dovetail::fem::detail
