// hex8 with one dilatation per element: U = Σ weight W(F̄), F̄ = s F, s = (θ/J)^⅓, θ = Σ weight J / Σ weight
// (Simo, Taylor & Pister 1985, condensed). Force and tangent are the first and second derivative of U.
#include <cmath>

#include "cell_kernels.hpp"
#include "small_tensors.hpp"

namespace dovetail::fem::detail {

namespace {

constexpr int N = 8;
constexpr std::size_t Q = 8;
using Tensors = std::array<Lane, 9 * Q>;

DOVETAIL_INLINE Lane cubeRoot(Lane x) {
  Lane root;
  for (int lane = 0; lane < laneCount; ++lane) root[lane] = std::cbrt(x[lane]);
  return root;
}

/// Kinematics of a batch.
struct Dilatation {
  Tensors F, inverse, mixed;     ///< F, F⁻¹, F̄
  std::array<Lane, Q> J, scale;  ///< det F, s
  Lane theta, volume;
};

/// What follows from the stress at F̄.
struct Stresses {
  std::array<Lane, Q> trace;  ///< P̄ : F̄
  Tensors direct;             ///< −∂/∂F at fixed θ: s (P̄ − ⅓ (P̄:F) F⁻ᵀ)
  Lane pressure;              ///< ∂U/∂θ = Σ weight P̄:F̄ / (3θ)
};

class MeanDilatationSolid final : public SolidBase {
public:
  using SolidBase::SolidBase;

private:
  const Vec3* gradients(std::size_t q) const { return &rule_->gradient[N * q]; }
  const PointGeometry& point(std::size_t batch, std::size_t q) const { return geometry_[batch * Q + q]; }

  void kinematics(const BatchTask& task, Dilatation& d) const {
    Lane U[3 * N];
    gatherNodes<N>(cells_, task.batch, task.u, U);
    Lane moment{}, weights{};
    for (std::size_t q = 0; q < Q; ++q) {
      displacementGradient<N>(U, gradients(q), point(task.batch, q).map, &d.F[9 * q]);
      addIdentity(&d.F[9 * q]);
      d.J[q] = inverseOf(&d.F[9 * q], &d.inverse[9 * q]);
      moment += point(task.batch, q).weight * d.J[q];
      weights += point(task.batch, q).weight;
    }
    for (int lane = 0; lane < laneCount; ++lane)
      if (weights[lane] == 0.0) weights[lane] = moment[lane] = 1.0;  // lanes that repeat an element
    d.volume = weights;
    d.theta = moment / weights;
    for (std::size_t q = 0; q < Q; ++q) {
      d.scale[q] = cubeRoot(d.theta / d.J[q]);
      for (std::size_t k = 0; k < 9; ++k) d.mixed[9 * q + k] = d.scale[q] * d.F[9 * q + k];
    }
  }

  void deformation(const BatchTask& task, Lane* F) const override {
    Dilatation d;
    kinematics(task, d);
    std::copy(d.F.begin(), d.F.end(), F);
  }

  void derivatives(const BatchTask& task, const Dilatation& d, const Tensors& P, Stresses& s) const {
    s.pressure = Lane{};
    for (std::size_t q = 0; q < Q; ++q) {
      s.trace[q] = contraction(&P[9 * q], &d.mixed[9 * q]);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t J = 0; J < 3; ++J)
          s.direct[9 * q + 3 * i + J] =
              d.scale[q] * P[9 * q + 3 * i + J] - s.trace[q] / 3.0 * d.inverse[9 * q + 3 * J + i];
      s.pressure += point(task.batch, q).weight * s.trace[q] / (3.0 * d.theta);
    }
  }

  void forces(const BatchTask& task, BatchResult& result) override {
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
          total[3 * i + J] =
              s.direct[9 * q + 3 * i + J] + s.pressure / d.volume * d.J[q] * d.inverse[9 * q + 3 * J + i];
      addStressForces<N>(total, gradients(q), here, result.f.data());
      result.energy += here.weight * energy[q];
      result.dissipated += here.weight * dissipated[q];
    }
  }

  /// Second derivative by F at fixed θ, plus pressure/volume ∂²J/∂F². A holds ∂P̄/∂F̄ and is overwritten.
  static void pointModuli(const Lane* P, const Lane* inverse, Lane scale, Lane trace, Lane J, Lane pressure, Lane* A) {
    Lane F[9];
    inverseOf(inverse, F);
    Lane T[9];  // F⁻ᵀ
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) T[3 * i + k] = inverse[3 * k + i];
    Lane AF[9], FA[9];
    apply(A, F, AF);
    applyTransposed(A, F, FA);
    const Lane FAF = contraction(F, AF);
    const Lane square = scale * scale;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t Jx = 0; Jx < 3; ++Jx)
        for (std::size_t k = 0; k < 3; ++k)
          for (std::size_t L = 0; L < 3; ++L) {
            const std::size_t p = 3 * i + Jx, q = 3 * k + L;
            const Lane crossed = inverse[3 * L + i] * inverse[3 * Jx + k];
            const Lane projected = A[9 * p + q] - (T[p] * FA[q] + AF[p] * T[q]) / 3.0 + FAF / 9.0 * T[p] * T[q];
            A[9 * p + q] = square * projected - scale / 3.0 * (P[p] * T[q] + T[p] * P[q]) + trace / 9.0 * T[p] * T[q] +
                           trace / 3.0 * crossed + pressure * J * (T[p] * T[q] - crossed);
          }
  }

  void tangent(const BatchTask& task, Lane* K) override {
    Dilatation d;
    Tensors P;
    Stresses s;
    std::array<Lane, 81 * Q> A;
    kinematics(task, d);
    evaluate(task, d.mixed.data(), P.data(), A.data(), nullptr, nullptr);
    derivatives(task, d, P, s);
    std::fill(K, K + 9 * N * N, Lane{});
    Lane right[3 * N] = {}, left[3 * N] = {}, slope[3 * N] = {};  // ∂²U/∂u∂θ both ways, ∂θ/∂u
    Lane curvature{};                                             // ∂²U/∂θ²
    Lane parent[81];
    for (std::size_t q = 0; q < Q; ++q) {
      const PointGeometry& here = point(task.batch, q);
      const Lane *const mixed = &d.mixed[9 * q], *const inverse = &d.inverse[9 * q];
      Lane AF[9], FA[9], rightStress[9], leftStress[9], slopeStress[9];
      apply(&A[81 * q], mixed, AF);
      applyTransposed(&A[81 * q], mixed, FA);
      const Lane FAF = contraction(mixed, AF), third = 1.0 / (3.0 * d.theta);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t J = 0; J < 3; ++J) {
          const std::size_t k = 3 * i + J;
          const Lane T = inverse[3 * J + i];
          const auto projected = [&](const Lane* S) { return d.scale[q] * S[k] - FAF / 3.0 * T; };
          rightStress[k] = third * (s.direct[9 * q + k] + projected(AF));
          leftStress[k] = third * (s.direct[9 * q + k] + projected(FA));
          slopeStress[k] = d.J[q] / d.volume * T;
        }
      addStressForces<N>(rightStress, gradients(q), here, right);
      addStressForces<N>(leftStress, gradients(q), here, left);
      addStressForces<N>(slopeStress, gradients(q), here, slope);
      curvature += here.weight * (FAF - 2.0 * s.trace[q]) * third * third;
      pointModuli(&P[9 * q], inverse, d.scale[q], s.trace[q], d.J[q], s.pressure / d.volume, &A[81 * q]);
      parentModuli(&A[81 * q], here, parent);
      addParentTangent<N, false>(parent, gradients(q), K);
    }
    for (std::size_t r = 0; r < 3 * N; ++r)
      for (std::size_t c = 0; c < 3 * N; ++c)
        K[3 * N * r + c] += right[r] * slope[c] + slope[r] * left[c] + curvature * slope[r] * slope[c];
  }
};

}  // namespace

std::shared_ptr<Solid> makeMeanDilatationSolid(SolidCells cells, std::shared_ptr<const PointMaterial> material,
                                               const SolidOptions& options) {
  return std::make_shared<MeanDilatationSolid>(std::move(cells), std::move(material), options);
}

}  // namespace dovetail::fem::detail
