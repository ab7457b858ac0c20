// hex8 with one point, at the element's mean gradient, and stiffness against hourglassing.
//
// Mean gradients and hourglass vectors γ after Flanagan & Belytschko (1981): γ is orthogonal to every linear field, so
// q_α = Σ_a γ_αa u_a vanishes for affine motion, rotates with the element, and ½ k Σ |q_α|² is objective.
#include "elements/kernels/cell_kernels.hpp"

namespace dovetail::fem::detail {

namespace {

constexpr int N = 8;
// ηζ, ζξ, ξη, ξηζ at the corners.
constexpr std::array<std::array<double, 8>, 4> hourglassModes = {{{1, 1, -1, -1, -1, -1, 1, 1},
                                                                  {1, -1, -1, 1, -1, 1, 1, -1},
                                                                  {1, -1, 1, -1, 1, -1, 1, -1},
                                                                  {-1, 1, -1, 1, 1, -1, 1, -1}}};

struct alignas(laneBytes) ReducedGeometry {
  std::array<Lane, 3 * N> gradient;  ///< mean of ∂ψ_a/∂X, [3 a + J], 1/m
  std::array<Lane, 4 * N> gamma;     ///< [8 α + a]
  Lane volume, stiffness;            ///< m³; N/m, 0 in lanes that repeat
};

class ReducedSolid final : public SolidBase {
public:
  ReducedSolid(SolidCells cells, std::unique_ptr<SolidPoints> points, const SolidOptions& options)
      : SolidBase(std::move(cells), std::move(points), options) {
    setGeometry();
    rule_ = &centreRule(ElementShape::hex8);
    std::vector<PointGeometry> centre(cells_.batches());
    for (std::size_t b = 0; b < cells_.batches(); ++b) centre[b].weight = reduced_[b].volume;
    geometry_ = std::move(centre);
    openPoints();
    const double modulus = options.hourglassFraction * points_->moduliAtRest().shear;
    for (ReducedGeometry& r : reduced_) r.stiffness *= modulus;
  }

  double hourglassEnergy(const Nodes& nodes) override {
    requireSameNodes(nodes);
    double sum = 0.0;
    for (std::size_t b = 0; b < cells_.batches(); ++b) {
      Lane U[3 * N], energy{};
      gatherNodes<N>(cells_, b, nodes.u.data(), U);
      eachMode(b, U, [&](std::size_t, std::size_t, const Lane& q) { energy += 0.5 * reduced_[b].stiffness * q * q; });
      for (int lane = 0; lane < laneCount; ++lane) sum += energy[lane];
    }
    return sum;
  }

private:
  void setGeometry() {
    reduced_.resize(cells_.batches());
    for (std::size_t b = 0; b < cells_.batches(); ++b) {
      ReducedGeometry& r = reduced_[b];
      for (std::size_t q = 0; q < 8; ++q) {
        const PointGeometry& point = geometry_[8 * b + q];
        r.volume += point.weight;
        for (std::size_t a = 0; a < N; ++a) {
          const Vec3& g = rule_->gradient[N * q + a];
          for (std::size_t J = 0; J < 3; ++J)
            r.gradient[3 * a + J] +=
                point.weight * (g.x * point.map[J] + g.y * point.map[3 + J] + g.z * point.map[6 + J]);
        }
      }
      setModes(b, r);
    }
  }

  void setModes(std::size_t b, ReducedGeometry& r) const {
    Lane squares{};
    Lane divisor = r.volume;
    for (int lane = 0; lane < laneCount; ++lane)
      if (divisor[lane] == 0.0) divisor[lane] = 1.0;
    for (Lane& g : r.gradient) {
      g /= divisor;
      squares += g * g;
    }
    // Divides so that fraction 1 is the energy of the exact shear strain in a cube; times the modulus, later.
    r.stiffness = 1.0 / 72.0 * r.volume * squares;
    for (std::size_t mode = 0; mode < 4; ++mode) {
      Lane moment[3] = {};
      for (std::size_t a = 0; a < N; ++a)
        for (std::size_t lane = 0; lane < laneCount; ++lane) {
          const Vec3& X = cells_.X[static_cast<std::size_t>(cells_.batchNode[N * b + a][lane])];
          for (int i = 0; i < 3; ++i) moment[i][static_cast<int>(lane)] += hourglassModes[mode][a] * X[i];
        }
      for (std::size_t a = 0; a < N; ++a)
        r.gamma[N * mode + a] =
            hourglassModes[mode][a] -
            (moment[0] * r.gradient[3 * a] + moment[1] * r.gradient[3 * a + 1] + moment[2] * r.gradient[3 * a + 2]);
    }
  }

  template <class Visit>
  void eachMode(std::size_t b, const Lane* U, Visit&& visit) const {
    for (std::size_t mode = 0; mode < 4; ++mode)
      for (std::size_t i = 0; i < 3; ++i) {
        Lane q{};
        for (std::size_t a = 0; a < N; ++a) q += reduced_[b].gamma[N * mode + a] * U[3 * a + i];
        visit(mode, i, q);
      }
  }

  std::size_t pointCount() const override { return 1; }
  std::size_t formulationMemory() const override { return reduced_.capacity() * sizeof(ReducedGeometry); }

  void meanDeformation(std::size_t b, const Lane* U, Lane* F) const {
    for (std::size_t k = 0; k < 9; ++k) F[k] = Lane{};
    for (std::size_t a = 0; a < N; ++a)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t J = 0; J < 3; ++J) F[3 * i + J] += U[3 * a + i] * reduced_[b].gradient[3 * a + J];
    addIdentity(F);
  }

  void deformation(const BatchTask& task, Lane* F) const override {
    withVectors([&] {
      Lane U[3 * N];
      gatherNodes<N>(cells_, task.batch, task.u, U);
      meanDeformation(task.batch, U, F);
    });
  }

  void forces(const BatchTask& task, BatchResult& result) override {
    withVectors([&] { forcesOf(task, result); });
  }
  void tangent(const BatchTask& task, Lane* K) override {
    withVectors([&] { tangentOf(task, K); });
  }

  void forcesOf(const BatchTask& task, BatchResult& result) {
    const ReducedGeometry& r = reduced_[task.batch];
    Lane U[3 * N], F[9], P[9], energy{}, dissipated{};
    gatherNodes<N>(cells_, task.batch, task.u, U);
    meanDeformation(task.batch, U, F);
    evaluate(task, F, P, nullptr, task.wantEnergy ? &energy : nullptr, task.wantDissipation ? &dissipated : nullptr);
    for (std::size_t a = 0; a < N; ++a)
      for (std::size_t i = 0; i < 3; ++i)
        result.f[3 * a + i] = r.volume * (P[3 * i] * r.gradient[3 * a] + P[3 * i + 1] * r.gradient[3 * a + 1] +
                                          P[3 * i + 2] * r.gradient[3 * a + 2]);
    result.energy = r.volume * energy;
    result.dissipated = r.volume * dissipated;
    eachMode(task.batch, U, [&](std::size_t mode, std::size_t i, const Lane& q) {
      for (std::size_t a = 0; a < N; ++a) result.f[3 * a + i] += r.stiffness * q * r.gamma[N * mode + a];
      result.energy += 0.5 * r.stiffness * q * q;
    });
  }

  void tangentOf(const BatchTask& task, Lane* K) {
    const ReducedGeometry& r = reduced_[task.batch];
    Lane U[3 * N], F[9], P[9], A[81];
    gatherNodes<N>(cells_, task.batch, task.u, U);
    meanDeformation(task.batch, U, F);
    evaluate(task, F, P, A, nullptr, nullptr);
    for (std::size_t a = 0; a < N; ++a)
      for (std::size_t b = 0; b < N; ++b) {
        Lane hourglass{};
        for (std::size_t mode = 0; mode < 4; ++mode) hourglass += r.gamma[N * mode + a] * r.gamma[N * mode + b];
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t k = 0; k < 3; ++k) {
            Lane sum{};
            for (std::size_t J = 0; J < 3; ++J)
              for (std::size_t L = 0; L < 3; ++L)
                sum += r.gradient[3 * a + J] * A[9 * (3 * i + J) + 3 * k + L] * r.gradient[3 * b + L];
            K[3 * N * (3 * a + i) + 3 * b + k] = r.volume * sum;
            if (i == k) K[3 * N * (3 * a + i) + 3 * b + k] += r.stiffness * hourglass;
          }
      }
  }

  std::vector<ReducedGeometry> reduced_;
};

}  // namespace

std::shared_ptr<Solid> makeReducedSolid(SolidCells cells, std::unique_ptr<SolidPoints> points,
                                        const SolidOptions& options) {
  return std::make_shared<ReducedSolid>(std::move(cells), std::move(points), options);
}

}  // namespace dovetail::fem::detail
