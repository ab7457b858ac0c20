// Displacement elements of all shapes.
#include "dovetail/core/error.hpp"
#include "elements/kernels/cell_kernels.hpp"
#include "elements/kernels/conserving.hpp"

namespace dovetail::fem::detail {

namespace {

template <int N, int Q>
class StandardSolid final : public SolidBase {
public:
  StandardSolid(SolidCells cells, std::unique_ptr<SolidPoints> points, const SolidOptions& options)
      : SolidBase(std::move(cells), std::move(points), options, isHex8) {
    const auto law = isHex8 && points_->law() ? points_->law()->brickLaw() : std::nullopt;
    law ? useKernels(*law, false) : needGeometry();
  }

private:
  static constexpr bool isHex8 = N == 8 && Q == 8;
  using Tensors = std::array<Lane, 9 * Q>;

  const Vec3* gradients(std::size_t q) const { return &rule_->gradient[N * q]; }

  void deformationOf(std::size_t batch, const Vec3* u, Lane* F) const {
    Lane U[3 * N];
    gatherNodes<N>(cells_, batch, u, U);
    for (std::size_t q = 0; q < Q; ++q) {
      displacementGradient<N>(U, gradients(q), geometry_[batch * Q + q].map, F + 9 * q);
      addIdentity(F + 9 * q);
    }
  }

  void deformation(const BatchTask& task, Lane* F) const override {
    withVectors([&] { deformationOf(task.batch, task.u, F); });
  }
  bool conserves() const override { return points_->isElastic(); }

  void forces(const BatchTask& task, BatchResult& result) override {
    withVectors([&] { forcesOf(task, result); });
  }
  void tangent(const BatchTask& task, Lane* K) override {
    withVectors([&] { tangentOf(task, K); });
  }

  void forcesOf(const BatchTask& task, BatchResult& result) {
    Tensors F, P;
    deformationOf(task.batch, task.u, F.data());
    std::array<Lane, Q> energy{}, dissipated{};
    if (task.start != nullptr)
      conservingStress(task, F, P, nullptr);
    else
      evaluate(task, F.data(), P.data(), nullptr, task.wantEnergy ? energy.data() : nullptr,
               task.wantDissipation ? dissipated.data() : nullptr);
    for (std::size_t k = 0; k < 3 * N; ++k) result.f[k] = Lane{};
    result.energy = result.dissipated = Lane{};
    for (std::size_t q = 0; q < Q; ++q) {
      const PointGeometry& point = geometry_[task.batch * Q + q];
      addStressForces<N>(&P[9 * q], gradients(q), point, result.f.data());
      result.energy += point.weight * energy[q];
      result.dissipated += point.weight * dissipated[q];
    }
  }

  void tangentOf(const BatchTask& task, Lane* K) {
    Tensors F, P;
    std::array<Lane, 81 * Q> A;
    deformationOf(task.batch, task.u, F.data());
    if (task.start != nullptr)
      conservingStress(task, F, P, A.data());
    else
      evaluate(task, F.data(), P.data(), A.data(), nullptr, nullptr);
    std::fill(K, K + 9 * N * N, Lane{});
    const bool symmetric = points_->isSymmetric() && task.start == nullptr;
    Lane parent[81];
    for (std::size_t q = 0; q < Q; ++q) {
      parentModuli(&A[81 * q], geometry_[task.batch * Q + q], parent);
      if (symmetric)
        addParentTangent<N, true>(parent, gradients(q), K);
      else
        addParentTangent<N, false>(parent, gradients(q), K);
    }
    if (symmetric) mirror<N>(K);
  }

  /// Metrics C₀ + fraction ΔC of all points as deformation gradients.
  static void metricsBetween(const Tensors& C0, const Tensors& C1, double fraction, Tensors& U) {
    for (std::size_t q = 0; q < Q; ++q) {
      Lane C[9];
      for (std::size_t k = 0; k < 9; ++k) C[k] = C0[9 * q + k] + fraction * (C1[9 * q + k] - C0[9 * q + k]);
      factorMetric(C, &U[9 * q]);
    }
  }
  /// S on the path between two metrics.
  void stressBetween(const BatchTask& task, const Tensors& C0, const Tensors& C1, double fraction, Tensors& S) {
    Tensors U, P;
    metricsBetween(C0, C1, fraction, U);
    evaluate(task, U.data(), P.data(), nullptr, nullptr, nullptr);
    for (std::size_t q = 0; q < Q; ++q) secondStress(&U[9 * q], &P[9 * q], &S[9 * q]);
  }

  /// P = F̄ S_alg for the step from task.start to F; its moduli if A is not null.
  void conservingStress(const BatchTask& task, const Tensors& F1, Tensors& P, Lane* A) {
    Tensors F0, C0, C1, U, meanP, Sa{}, Sb{};
    std::array<Lane, Q> W0{}, W1{};
    deformationOf(task.batch, task.start, F0.data());
    bool anyShort = false, anyLong = false;
    for (std::size_t q = 0; q < Q; ++q) {
      rightCauchyGreen(&F0[9 * q], &C0[9 * q]);
      rightCauchyGreen(&F1[9 * q], &C1[9 * q]);
      const Lane square = squaredChange(&C0[9 * q], &C1[9 * q]);
      for (int lane = 0; lane < laneCount; ++lane) (square[lane] < shortPath * shortPath ? anyShort : anyLong) = true;
    }
    if (anyLong) {
      evaluate(task, F0.data(), P.data(), nullptr, W0.data(), nullptr);
      evaluate(task, F1.data(), P.data(), nullptr, W1.data(), nullptr);
    }
    if (anyShort) {
      stressBetween(task, C0, C1, pathPoints[0], Sa);
      stressBetween(task, C0, C1, pathPoints[1], Sb);
    }
    metricsBetween(C0, C1, 0.5, U);
    evaluate(task, U.data(), meanP.data(), A, nullptr, nullptr);
    for (std::size_t q = 0; q < Q; ++q) {
      Lane S[9], meanS[9], mean[9];
      for (std::size_t k = 0; k < 9; ++k) mean[k] = 0.5 * (F0[9 * q + k] + F1[9 * q + k]);
      secondStress(&U[9 * q], &meanP[9 * q], meanS);
      for (std::size_t k = 0; k < 9; ++k) S[k] = meanS[k];
      correctStress(&C0[9 * q], &C1[9 * q], W0[q], W1[q], &Sa[9 * q], &Sb[9 * q], S);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t J = 0; J < 3; ++J)
          P[9 * q + 3 * i + J] = mean[3 * i] * S[J] + mean[3 * i + 1] * S[3 + J] + mean[3 * i + 2] * S[6 + J];
      if (A != nullptr) conservingModuli(&U[9 * q], mean, &F1[9 * q], meanS, S, A + 81 * q);
    }
  }
};

}  // namespace

std::shared_ptr<Solid> makeStandardSolid(SolidCells cells, std::unique_ptr<SolidPoints> points,
                                         const SolidOptions& options) {
  switch (cells.shape) {
    case ElementShape::hex8:
      return std::make_shared<StandardSolid<8, 8>>(std::move(cells), std::move(points), options);
    case ElementShape::hex20:
      return std::make_shared<StandardSolid<20, 27>>(std::move(cells), std::move(points), options);
    case ElementShape::hex27:
      return std::make_shared<StandardSolid<27, 27>>(std::move(cells), std::move(points), options);
    case ElementShape::tet4:
      return std::make_shared<StandardSolid<4, 1>>(std::move(cells), std::move(points), options);
    case ElementShape::tet10:
      return std::make_shared<StandardSolid<10, 4>>(std::move(cells), std::move(points), options);
    case ElementShape::quad4:
      return std::make_shared<StandardSolid<4, 4>>(std::move(cells), std::move(points), options);
    case ElementShape::quad8:
      if (options.formulation == Formulation::reduced)
        return std::make_shared<StandardSolid<8, 4>>(std::move(cells), std::move(points), options);
      return std::make_shared<StandardSolid<8, 9>>(std::move(cells), std::move(points), options);
  }
  throw InputError("the shape of the elements is not known", "elements", "use one of ElementShape");
}

}  // namespace dovetail::fem::detail
