// hex8 with enhanced deformation gradient: F = F_u + F₀ Ĥ, Ĥ = Σ α_ij (j₀/j) ξ_i q_i ⊗ q_j with q_j = J₀⁻ᵀ e_j and F₀
// that of the displacements at the centre (Glaser & Armero 1997, transposed Wilson modes). U = min over α of ∫W(F): α
// is solved for in every element, so force and tangent are the derivatives of U.
#include <cmath>
#include <limits>

#include "../laws/material_probe.hpp"
#include "cell_kernels.hpp"
#include "dovetail/core/error.hpp"
#include "enhanced_modes.hpp"
#include "small_tensors.hpp"

namespace dovetail::fem::detail {

namespace {

using namespace enhanced;

class EnhancedSolid final : public SolidBase {
public:
  EnhancedSolid(SolidCells cells, std::shared_ptr<const PointMaterial> material, const SolidOptions& options)
      : SolidBase(std::move(cells), std::move(material), options), stiffness_(moduliAtRest(*material_).confined) {
    const std::vector<PointGeometry> centre = geometryAt(cells_, centreRule(CellShape::hex8));
    enhanced_.resize(cells_.batches());
    for (std::size_t b = 0; b < cells_.batches(); ++b) setGeometry(b, centre[b]);
    alpha_.resize(cells_.batches());
  }

  void save(ByteWriter& archive) const override {
    SolidBase::save(archive);
    std::vector<double> values;
    for (const Modes& modes : alpha_)
      for (const Lane& mode : modes)
        for (int lane = 0; lane < laneCount; ++lane) values.push_back(mode[lane]);
    archive(values);
  }
  void load(ByteReader& archive) override {
    SolidBase::load(archive);
    const std::vector<double> values = readNumbers(archive, alpha_.size() * M * laneCount);
    std::size_t next = 0;
    for (Modes& modes : alpha_)
      for (Lane& mode : modes)
        for (int lane = 0; lane < laneCount; ++lane) mode[lane] = values[next++];
  }

private:
  const Vec3* gradients(std::size_t q) const { return &rule_->gradient[N * q]; }
  const PointGeometry& point(std::size_t batch, std::size_t q) const { return geometry_[batch * Q + q]; }

  void setGeometry(std::size_t b, const PointGeometry& centre) {
    EnhancedGeometry& g = enhanced_[b];
    g.map0 = centre.map;
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t i = 0; i < 3; ++i) g.left[3 * r + i] = g.map0[3 * i + r];
    Lane J0[9];
    const Lane inverseJ0 = inverseOf(centre.map.data(), J0);
    for (std::size_t q = 0; q < Q; ++q) {
      Lane unused[9];
      g.ratio[q] = inverseOf(point(b, q).map.data(), unused) / inverseJ0;
    }
    for (std::size_t a = 0; a < N; ++a) {
      const Vec3& parent = centreRule(CellShape::hex8).gradient[a];
      for (std::size_t J = 0; J < 3; ++J)
        g.gradient[3 * a + J] = parent.x * g.map0[J] + parent.y * g.map0[3 + J] + parent.z * g.map0[6 + J];
    }
  }

  /// F at all points from u and α.
  void kinematics(std::size_t b, const Lane* U, const Modes& alpha, State& s) const {
    const EnhancedGeometry& g = enhanced_[b];
    for (std::size_t k = 0; k < 9; ++k) s.F0[k] = Lane{};
    for (std::size_t a = 0; a < N; ++a)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t J = 0; J < 3; ++J) s.F0[3 * i + J] += U[3 * a + i] * g.gradient[3 * a + J];
    addIdentity(s.F0);
    multiply(s.F0, g.left.data(), s.F0left);
    for (std::size_t q = 0; q < Q; ++q) {
      Lane *const F = &s.F[9 * q], *const H = s.enhancement + 9 * q;
      displacementGradient<N>(U, gradients(q), point(b, q).map, F);
      addIdentity(F);
      const Vec3& xi = rule_->point[q];
      Lane parent[9];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) parent[3 * i + j] = g.ratio[q] * xi[static_cast<int>(i)] * alpha[3 * i + j];
      Lane half[9], change[9];
      multiply(g.left.data(), parent, half);
      multiply(half, g.map0.data(), H);
      multiply(s.F0, H, change);
      for (std::size_t k = 0; k < 9; ++k) F[k] += change[k];
    }
  }

  static void multiply(const Lane* a, const Lane* b, Lane* result) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        result[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
  }

  /// ∂F/∂α_ij at a point: column i of F₀J₀⁻ᵀ times row j of J₀⁻¹, scaled.
  void modeTensor(const EnhancedGeometry& g, const State& s, std::size_t q, std::size_t mode, Lane* B) const {
    const std::size_t i = mode / 3, j = mode % 3;
    const Lane scale = g.ratio[q] * rule_->point[q][static_cast<int>(i)];
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t J = 0; J < 3; ++J) B[3 * r + J] = scale * s.F0left[3 * r + i] * g.map0[3 * j + J];
  }

  /// r_m = Σ weight P : ∂F/∂α_m, and what of it counts as zero.
  void modeResidual(std::size_t b, const State& s, Modes& residual, Modes& tolerance) const {
    const EnhancedGeometry& g = enhanced_[b];
    const double resolution = 16.0 * std::numeric_limits<double>::epsilon() * stiffness_;
    for (std::size_t m = 0; m < M; ++m) {
      residual[m] = tolerance[m] = Lane{};
      for (std::size_t q = 0; q < Q; ++q) {
        Lane B[9];
        modeTensor(g, s, q, m, B);
        for (std::size_t k = 0; k < 9; ++k) {
          const Lane work = point(b, q).weight * s.P[9 * q + k] * B[k], size = point(b, q).weight * B[k];
          residual[m] += work;
          tolerance[m] += relativeTolerance * magnitude(work) + resolution * magnitude(size);
        }
      }
    }
  }

  static Lane magnitude(Lane x) {
    for (int lane = 0; lane < laneCount; ++lane) x[lane] = std::abs(x[lane]);
    return x;
  }

  /// ∂r_m/∂α_n; ones on the diagonal of lanes that repeat an element.
  void modeStiffness(std::size_t b, const State& s, const Lane* A, std::array<Lane, M * M>& K) const {
    K.fill(Lane{});
    for (std::size_t q = 0; q < Q; ++q)
      for (std::size_t n = 0; n < M; ++n) {
        Lane B[9], AB[9];
        modeTensor(enhanced_[b], s, q, n, B);
        apply(A + 81 * q, B, AB);
        for (std::size_t m = 0; m < M; ++m) {
          modeTensor(enhanced_[b], s, q, m, B);
          K[M * m + n] += point(b, q).weight * contraction(B, AB);
        }
      }
    for (std::size_t lane = cells_.inUse(b); lane < laneCount; ++lane)
      for (std::size_t m = 0; m < M; ++m)
        for (std::size_t n = 0; n < M; ++n) K[M * m + n][static_cast<int>(lane)] = m == n ? 1.0 : 0.0;
  }

  /// Solves for α of the batch; on return s is its state, with the moduli in A if it is not null.
  void equilibrate(const BatchTask& task, const Lane* U, State& s, Lane* A) {
    Modes& alpha = alpha_[task.batch];
    std::array<Lane, 81 * Q> own;
    Modes residual, tolerance;
    Search search;
    bool restarted = false;
    for (int iteration = 0;; ++iteration) {
      kinematics(task.batch, U, alpha, s);
      Lane* const moduli = A != nullptr ? A : (iteration > 0 ? own.data() : nullptr);
      evaluate(task, s.F.data(), s.P.data(), moduli, nullptr, nullptr);
      modeResidual(task.batch, s, residual, tolerance);
      const Lane now = excess(residual, tolerance);
      const unsigned open = openLanes(now);
      if (open == 0) return;
      if (iteration >= maxIterations || (iteration == 0 && !restarted && hasNaN(now))) {
        if (restarted) return giveUp(open, alpha, s);
        restarted = true;
        iteration = -1;
        setLanes(open, alpha);
        continue;
      }
      if (moduli == nullptr) evaluate(task, s.F.data(), s.P.data(), own.data(), nullptr, nullptr);
      std::array<Lane, M * M> K;
      modeStiffness(task.batch, s, moduli == nullptr ? own.data() : moduli, K);
      solveModes(K, residual);
      search.advance(alpha, residual, now, open, iteration);
    }
  }

  static void setLanes(unsigned lanes, Modes& alpha) {
    for (Lane& mode : alpha)
      for (int lane = 0; lane < laneCount; ++lane)
        if (lanes >> lane & 1) mode[lane] = 0.0;
  }

  /// Elements without equilibrium answer with NaN, which solvers notice.
  static void giveUp(unsigned open, Modes& alpha, State& s) {
    setLanes(open, alpha);
    for (Lane& stress : s.P)
      for (int lane = 0; lane < laneCount; ++lane)
        if (open >> lane & 1) stress[lane] = std::numeric_limits<double>::quiet_NaN();
  }

  void deformation(const BatchTask& task, Lane* F) const override {
    Lane U[3 * N];
    State s;
    gatherNodes<N>(cells_, task.batch, task.u, U);
    kinematics(task.batch, U, alpha_[task.batch], s);
    std::copy(s.F.begin(), s.F.end(), F);
  }

  void forces(const BatchTask& task, BatchResult& result) override {
    Lane U[3 * N];
    State s;
    gatherNodes<N>(cells_, task.batch, task.u, U);
    equilibrate(task, U, s, nullptr);
    std::array<Lane, Q> energy{}, dissipated{};
    if (task.wantEnergy || task.wantDissipation) {
      Tensors P;
      evaluate(task, s.F.data(), P.data(), nullptr, task.wantEnergy ? energy.data() : nullptr,
               task.wantDissipation ? dissipated.data() : nullptr);
    }
    for (std::size_t k = 0; k < 3 * N; ++k) result.f[k] = Lane{};
    result.energy = result.dissipated = Lane{};
    Lane moment[9] = {};  // Σ weight P Ĥᵀ
    for (std::size_t q = 0; q < Q; ++q) {
      const PointGeometry& here = point(task.batch, q);
      addStressForces<N>(&s.P[9 * q], gradients(q), here, result.f.data());
      const Lane *const P = &s.P[9 * q], *const H = s.enhancement + 9 * q;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t K = 0; K < 3; ++K)
          moment[3 * i + K] +=
              here.weight * (P[3 * i] * H[3 * K] + P[3 * i + 1] * H[3 * K + 1] + P[3 * i + 2] * H[3 * K + 2]);
      result.energy += here.weight * energy[q];
      result.dissipated += here.weight * dissipated[q];
    }
    const auto& g0 = enhanced_[task.batch].gradient;
    for (std::size_t a = 0; a < N; ++a)
      for (std::size_t i = 0; i < 3; ++i)
        result.f[3 * a + i] +=
            moment[3 * i] * g0[3 * a] + moment[3 * i + 1] * g0[3 * a + 1] + moment[3 * i + 2] * g0[3 * a + 2];
  }

  /// ∂ψ_a/∂X + Ĥᵀ ∂ψ_a/∂X at the centre: δF = Σ δu_a ⊗ g_a at fixed α.
  void effectiveGradients(const BatchTask& task, const State& s, std::size_t q, Lane* g) const {
    const auto& map = point(task.batch, q).map;
    const auto& g0 = enhanced_[task.batch].gradient;
    const Lane* const H = s.enhancement + 9 * q;
    for (std::size_t a = 0; a < N; ++a) {
      const Vec3& parent = gradients(q)[a];
      for (std::size_t J = 0; J < 3; ++J)
        g[3 * a + J] = parent.x * map[J] + parent.y * map[3 + J] + parent.z * map[6 + J] + H[J] * g0[3 * a] +
                       H[3 + J] * g0[3 * a + 1] + H[6 + J] * g0[3 * a + 2];
    }
  }

  void tangent(const BatchTask& task, Lane* K) override {
    Lane U[3 * N];
    State s;
    std::array<Lane, 81 * Q> A;
    gatherNodes<N>(cells_, task.batch, task.u, U);
    equilibrate(task, U, s, A.data());
    std::fill(K, K + 9 * N * N, Lane{});
    std::array<Lane, 3 * N * M> toModes{}, fromModes{};  // ∂r_m/∂u [24 m + 3a + i], ∂f/∂α_m [9 (3a + i) + m]
    for (std::size_t q = 0; q < Q; ++q) addPoint(task, s, &A[81 * q], q, K, toModes.data(), fromModes.data());
    std::array<Lane, M * M> modes;
    modeStiffness(task.batch, s, A.data(), modes);
    Modes unused{};
    solveModes(modes, unused, 3 * N, toModes.data());
    for (std::size_t r = 0; r < 3 * N; ++r)
      for (std::size_t m = 0; m < M; ++m)
        for (std::size_t c = 0; c < 3 * N; ++c) K[3 * N * r + c] -= fromModes[M * r + m] * toModes[3 * N * m + c];
  }

  void addPoint(const BatchTask& task, const State& s, const Lane* A, std::size_t q, Lane* K, Lane* toModes,
                Lane* fromModes) const {
    const Lane weight = point(task.batch, q).weight;
    const auto& g0 = enhanced_[task.batch].gradient;
    Lane g[3 * N];
    effectiveGradients(task, s, q, g);
    for (std::size_t b = 0; b < N; ++b) {
      Lane T[27];  // A · g_b, [9 i + 3 k + J]
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t J = 0; J < 3; ++J)
          for (std::size_t k = 0; k < 3; ++k) {
            const Lane* const row = A + 9 * (3 * i + J) + 3 * k;
            T[9 * i + 3 * k + J] = weight * (row[0] * g[3 * b] + row[1] * g[3 * b + 1] + row[2] * g[3 * b + 2]);
          }
      for (std::size_t a = 0; a < N; ++a)
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t k = 0; k < 3; ++k) {
            const Lane* const t = T + 9 * i + 3 * k;
            K[3 * N * (3 * a + i) + 3 * b + k] += t[0] * g[3 * a] + t[1] * g[3 * a + 1] + t[2] * g[3 * a + 2];
          }
    }
    for (std::size_t m = 0; m < M; ++m) {
      Lane B[9], right[9], left[9], G[9], geometric[9];
      modeTensor(enhanced_[task.batch], s, q, m, B);
      apply(A, B, right);
      applyTransposed(A, B, left);
      const std::size_t i0 = m / 3, j0 = m % 3;  // G = ∂Ĥ/∂α_m
      const EnhancedGeometry& e = enhanced_[task.batch];
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t J = 0; J < 3; ++J)
          G[3 * r + J] = e.ratio[q] * rule_->point[q][static_cast<int>(i0)] * e.left[3 * r + i0] * e.map0[3 * j0 + J];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
          geometric[3 * i + k] = s.P[9 * q + 3 * i] * G[3 * k] + s.P[9 * q + 3 * i + 1] * G[3 * k + 1] +
                                 s.P[9 * q + 3 * i + 2] * G[3 * k + 2];
      for (std::size_t a = 0; a < N; ++a)
        for (std::size_t i = 0; i < 3; ++i) {
          Lane fromStress{}, toStress{}, both{};
          for (std::size_t J = 0; J < 3; ++J) {
            fromStress += right[3 * i + J] * g[3 * a + J];
            toStress += left[3 * i + J] * g[3 * a + J];
            both += geometric[3 * i + J] * g0[3 * a + J];
          }
          fromModes[M * (3 * a + i) + m] += weight * (fromStress + both);
          toModes[3 * N * m + 3 * a + i] += weight * (toStress + both);
        }
    }
  }

  std::vector<EnhancedGeometry> enhanced_;
  std::vector<Modes> alpha_;
  double stiffness_;  // Pa, at rest
};

}  // namespace

std::shared_ptr<Solid> makeEnhancedSolid(SolidCells cells, std::shared_ptr<const PointMaterial> material,
                                         const SolidOptions& options) {
  return std::make_shared<EnhancedSolid>(std::move(cells), std::move(material), options);
}

}  // namespace dovetail::fem::detail
