// hex8 with enhanced deformation gradient: F = F_u + F₀ Ĥ, Ĥ = Σ α_ij (j₀/j) ξ_i q_i ⊗ q_j with q_j = J₀⁻ᵀ e_j and F₀
// that of the displacements at the centre (Glaser & Armero 1997, transposed Wilson modes). U = min over α of ∫W(F): α
// is solved for in every element, so force and tangent are the derivatives of U. The search begins at the committed α
// with the committed inverse of its matrix: what was asked in between does not matter.
#include <cstring>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/laws/material_probe.hpp"
#include "elements/kernels/cell_kernels.hpp"
#include "elements/kernels/enhanced_search.hpp"
#include "elements/lanes/small_tensors.hpp"

namespace dovetail::fem::detail {

namespace {

using namespace enhanced;

/// What is committed of a batch.
struct alignas(laneBytes) Committed {
  Modes alpha{};
  NarrowMatrix inverse{};  ///< of the matrix of the modes, at one of the states before
  bool hasInverse() const { return inverse[0] != 0.0f; }
};

/// What the last search has found; it holds for the same displacements and step.
struct alignas(laneBytes) Found {
  Displacements U{};
  Modes alpha{};
  double dt = 0.0;
  bool rateAtEnd = false;
  bool isValid = false;
  bool wasHard = false;  ///< the kept inverse did not do
};

class EnhancedSolid final : public SolidBase {
public:
  EnhancedSolid(SolidCells cells, std::unique_ptr<SolidPoints> points, const SolidOptions& options)
      : SolidBase(std::move(cells), std::move(points), options),
        confined_(points_->moduliAtRest().confined),
        resolution_(16.0 * std::numeric_limits<double>::epsilon() * confined_) {
    const std::vector<PointGeometry> centre = geometryAt(cells_, centreRule(ElementShape::hex8));
    enhanced_.resize(cells_.batches());
    for (std::size_t b = 0; b < cells_.batches(); ++b) setGeometry(b, centre[b]);
    committed_.resize(cells_.batches());
    found_.resize(cells_.batches());
  }

  double commit(const Nodes& nodes, const Instant& now) override {
    requireSameNodes(nodes);
    const double dissipated = SolidBase::commit(nodes, now);
    parallelFor(cells_.batches(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b)
        adopt({b, nodes.u.data(), nullptr, now.dt, false, false, now.rateAtEnd});
    });
    return dissipated;
  }
  Sample sample(const Nodes& nodes, const Instant& now) override {
    energy(nodes, now);  // finds the modes
    return SolidBase::sample(nodes, now);
  }
  std::size_t formulationMemory() const override {
    return enhanced_.capacity() * sizeof(EnhancedGeometry) + committed_.capacity() * sizeof(Committed) +
           found_.capacity() * sizeof(Found);
  }

  void save(ByteWriter& archive) const override {
    SolidBase::save(archive);
    std::vector<double> values;
    for (const Committed& batch : committed_) {
      for (const Lane& mode : batch.alpha)
        for (int lane = 0; lane < laneCount; ++lane) values.push_back(mode[lane]);
      values.insert(values.end(), batch.inverse.begin(), batch.inverse.end());
    }
    archive(values);
  }
  std::vector<StateShape> stateShapes() const override {
    std::vector<StateShape> shapes = SolidBase::stateShapes();
    shapes.push_back({M + M * M, 1});
    return shapes;
  }
  void load(ByteReader& archive) override {
    SolidBase::load(archive);
    const std::vector<double> values = readNumbers(archive, committed_.size() * (M + M * M) * laneCount, options_.name);
    std::size_t next = 0;
    for (Committed& batch : committed_) {
      for (Lane& mode : batch.alpha)
        for (int lane = 0; lane < laneCount; ++lane) mode[lane] = values[next++];
      for (float& entry : batch.inverse) entry = static_cast<float>(values[next++]);
    }
    for (Found& found : found_) found.isValid = false;
  }

private:
  const PointGeometry& point(std::size_t batch, std::size_t q) const { return geometry_[batch * Q + q]; }
  EnhancedCells cellsOf(std::size_t b) const { return {*rule_, &geometry_[b * Q], enhanced_[b], cells_.inUse(b)}; }

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
    setMean(b, g);
    for (std::size_t a = 0; a < N; ++a) {
      const Vec3& parent = centreRule(ElementShape::hex8).gradient[a];
      for (std::size_t J = 0; J < 3; ++J)
        g.gradient[3 * a + J] = parent.x * g.map0[J] + parent.y * g.map0[3 + J] + parent.z * g.map0[6 + J];
    }
  }

  /// Whether the fraction of an element is the same at all its nodes: the mean is then zero, to the last bit.
  bool isUniform(std::size_t e) const {
    const auto fractionOf = [&](std::size_t a) {
      return cells_.fraction[static_cast<std::size_t>(cells_.nodeOf(e, a))];
    };
    for (std::size_t a = 1; a < N; ++a)
      if (fractionOf(a) != fractionOf(0)) return false;
    return true;
  }

  void setMean(std::size_t b, EnhancedGeometry& g) const {
    if (cells_.fraction.empty()) return;
    for (std::size_t lane = 0; lane < cells_.inUse(b); ++lane) {
      if (isUniform(laneCount * b + lane)) continue;
      const int l = static_cast<int>(lane);
      for (std::size_t i = 0; i < 3; ++i) {
        double moment = 0.0, sum = 0.0;
        for (std::size_t q = 0; q < Q; ++q) {
          const double fraction = point(b, q).weight[l] * g.ratio[q][l];
          moment += fraction * rule_->point[q][static_cast<int>(i)];
          sum += fraction;
        }
        g.mean[i][l] = moment / sum;
      }
    }
  }

  bool isFound(const BatchTask& task, const Displacements& U) const {
    const Found& found = found_[task.batch];
    return found.isValid && found.dt == task.dt && found.rateAtEnd == task.rateAtEnd &&
           std::memcmp(found.U.data(), U.data(), sizeof U) == 0;
  }

  /// The state of the batch with the modes in equilibrium; NaN in the stress of elements without one, which solvers
  /// notice.
  void settle(const BatchTask& task, State& s) {
    Found& found = found_[task.batch];
    Displacements U;
    gatherNodes<N>(cells_, task.batch, task.u, U.data());
    const bool isKnown = isFound(task, U);
    if (!isKnown) {
      if (!committed_[task.batch].hasInverse()) keepInverse(task, Displacements{});
      found = {U, committed_[task.batch].alpha, task.dt, task.rateAtEnd, true, false};
    }
    setDisplacements(cellsOf(task.batch), U, s);
    Unbalanced r;
    balance(task, found.alpha, s, nullptr, r);
    if (!isKnown && r.open != 0) found.isValid = seek(task, s, found, r);
  }

  /// @return false if there are elements without equilibrium
  bool seek(const BatchTask& task, State& s, Found& found, Unbalanced& r) {
    Search search;
    if (chord(task, s, found, search, r)) return true;
    found.wasHard = true;
    if (newton(task, s, found.alpha, search, r)) return true;
    copyLanes(r.open, Modes{}, found.alpha);
    if (newton(task, s, found.alpha, search, r)) return true;
    for (const double guard : guards) {
      copyLanes(r.open, committed_[task.batch].alpha, found.alpha);
      if (learning(task, s, found.alpha, guard, r)) return true;
    }
    copyLanes(r.open, Modes{}, found.alpha);
    for (Lane& stress : s.P)
      for (int lane = 0; lane < laneCount; ++lane)
        if (r.open >> lane & 1) stress[lane] = std::numeric_limits<double>::quiet_NaN();
    return false;
  }

  /// The state for these modes; moduli in A if it is not null.
  void balance(const BatchTask& task, const Modes& alpha, State& s, Moduli* A, Unbalanced& r) {
    const EnhancedCells cells = cellsOf(task.batch);
    Modes tolerance;
    setModes(cells, alpha, s);
    evaluate(task, s.F.data(), s.P.data(), A == nullptr ? nullptr : A->data(), nullptr, nullptr);
    modeResidual(cells, relativeTolerance, resolution_, s, r.residual, tolerance);
    r.open = openLanes(r.residual, tolerance);
  }

  /// Steps with the kept inverse. @return false if it does not do; lanes still open are then where it was of use
  bool chord(const BatchTask& task, State& s, Found& found, Search& search, Unbalanced& r) {
    const ModeMatrix inverse = widened(committed_[task.batch].inverse);
    Lane limit = Lane{} + std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < maxIterations; ++iteration) {
      Modes step;
      modeStep(inverse, r.residual, step);
      const Lane size = largest(step);
      if ((r.open & ~lanesBelow(size, limit)) != 0) {
        if (iteration > 0) copyLanes(r.open & ~lanesBelow(size, search.size), search.base, found.alpha);
        return false;
      }
      search.go(r.open, step, found.alpha);
      limit = goodContraction * search.size;
      balance(task, found.alpha, s, nullptr, r);
      if (r.open == 0) return true;
      found.wasHard = iteration + 2 >= fewIterations;
    }
    return false;
  }

  /// Newton's steps, and half of one after which the next is no smaller. @return false if lanes are open still
  bool newton(const BatchTask& task, State& s, Modes& alpha, Search& search, Unbalanced& r) {
    Moduli A;
    ModeMatrix inverse;
    for (int iteration = 0; iteration < maxIterations; ++iteration) {
      balance(task, alpha, s, &A, r);
      if (r.open == 0) return true;
      Modes step;
      unsigned tooFar = 0;
      if (iteration > 0) {
        modeStep(inverse, r.residual, step);
        tooFar = r.open & ~lanesBelow(largest(step), search.size);
      }
      ModeMatrix here;
      inverseOfModes(cellsOf(task.batch), s, A, here);
      copyLanes(r.open & ~tooFar, here, inverse);
      modeStep(inverse, r.residual, step);
      search.go(r.open & ~tooFar, step, alpha);
      search.halve(tooFar, alpha);
    }
    balance(task, alpha, s, nullptr, r);
    return r.open == 0;
  }

  /// Broyden's (1965) steps from A + guard · (confined modulus at rest) 1: they learn from the way what the moduli are
  /// between two places, which Newton's method cannot where what flows has none, or other ones beyond an edge.
  /// @return false if lanes are open still
  bool learning(const BatchTask& task, State& s, Modes& alpha, double guard, Unbalanced& r) {
    Moduli A;
    balance(task, alpha, s, &A, r);
    for (std::size_t q = 0; q < Q; ++q)
      for (std::size_t k = 0; k < 9; ++k) A[81 * q + 10 * k] += guard * confined_;
    ModeMatrix inverse;
    inverseOfModes(cellsOf(task.batch), s, A, inverse);
    for (int iteration = 0; iteration < maxLearningSteps; ++iteration) {
      Modes step;
      modeStep(inverse, r.residual, step);
      Modes next;
      for (std::size_t m = 0; m < M; ++m) next[m] = alpha[m] - step[m];
      copyLanes(r.open, next, alpha);
      Unbalanced there;
      balance(task, alpha, s, nullptr, there);
      learn(r.residual, there.residual, step, inverse);
      r = there;
      if (r.open == 0) return true;
    }
    return false;
  }

  void keepInverse(const BatchTask& task, const Displacements& U) {
    State s;
    Moduli A;
    ModeMatrix inverse;
    Unbalanced unused;
    Committed& kept = committed_[task.batch];
    setDisplacements(cellsOf(task.batch), U, s);
    balance(task, kept.alpha, s, &A, unused);
    inverseOfModes(cellsOf(task.batch), s, A, inverse);
    kept.inverse = narrowed(inverse);
  }

  /// The step is accepted with these displacements.
  void adopt(const BatchTask& task) {
    Found& found = found_[task.batch];
    Displacements U;
    gatherNodes<N>(cells_, task.batch, task.u, U.data());
    if (State s; !isFound(task, U)) settle(task, s);
    committed_[task.batch].alpha = found.alpha;
    if (found.wasHard) keepInverse(task, U);
    found.isValid = false;
  }

  void deformation(const BatchTask& task, Lane* F) const override {
    Displacements U;
    State s;
    gatherNodes<N>(cells_, task.batch, task.u, U.data());
    setDisplacements(cellsOf(task.batch), U, s);
    setModes(cellsOf(task.batch), found_[task.batch].alpha, s);
    std::copy(s.F.begin(), s.F.end(), F);
  }

  void forces(const BatchTask& task, BatchResult& result) override {
    State s;
    settle(task, s);
    modeForces(cellsOf(task.batch), s, result.f.data());
    result.energy = result.dissipated = Lane{};
    if (!task.wantEnergy && !task.wantDissipation) return;
    Lanes<Q> energy{}, dissipated{};
    Tensors unused;
    evaluate(task, s.F.data(), unused.data(), nullptr, task.wantEnergy ? energy.data() : nullptr,
             task.wantDissipation ? dissipated.data() : nullptr);
    for (std::size_t q = 0; q < Q; ++q) {
      result.energy += point(task.batch, q).weight * energy[q];
      result.dissipated += point(task.batch, q).weight * dissipated[q];
    }
  }

  void tangent(const BatchTask& task, Lane* K) override {
    State s;
    Moduli A;
    settle(task, s);
    evaluate(task, s.F.data(), s.P.data(), A.data(), nullptr, nullptr);
    if (points_->isSymmetric())
      condensedTangent<true>(cellsOf(task.batch), s, A, K);
    else
      condensedTangent<false>(cellsOf(task.batch), s, A, K);
  }

  std::vector<EnhancedGeometry> enhanced_;
  std::vector<Committed> committed_;
  std::vector<Found> found_;
  double confined_;    // modulus at rest, Pa
  double resolution_;  // of stress, Pa: what round-off of F does
};

}  // namespace

std::shared_ptr<Solid> makeEnhancedSolid(SolidCells cells, std::unique_ptr<SolidPoints> points,
                                         const SolidOptions& options) {
  return std::make_shared<EnhancedSolid>(std::move(cells), std::move(points), options);
}

}  // namespace dovetail::fem::detail
