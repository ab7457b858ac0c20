// Multipliers of many rows: conjugate gradients on A = Π M_DE⁻¹ Πᵀ + B M_FE⁻¹ Bᵀ.
#include <cmath>
#include <string>

#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::arlequin {

namespace {

constexpr std::size_t grain = 1024;

double product(std::span<const Vec3> a, std::span<const Vec3> b) {
  return parallelSum(a.size(), grain, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t r = begin; r < end; ++r) sum += dot(a[r], b[r]);
    return sum;
  });
}

class IterativeMultiplier final : public Constraint {
public:
  IterativeMultiplier(const GapOperator& gap, const Overlap& overlap, std::span<const double> particleMass,
                      const fem::ModelMass& solid)
      : gap_(gap), solid_(solid), diagonal_(gap.rows()), ofNodes_(static_cast<std::size_t>(gap.nodes.columns)) {
    for (const int i : overlap.particle) yield_.push_back(1.0 / particleMass[static_cast<std::size_t>(i)]);
    ofParticles_.resize(yield_.size());
    for (auto* v : {&residual_, &step_, &scaled_, &image_}) v->resize(gap.rows());
    std::vector<Vec3> unit(ofNodes_.size(), Vec3{1.0, 1.0, 1.0});
    solid.solve(unit);  // of a lumped mass the inverse; near enough to scale by for others
    for (std::size_t r = 0; r < gap.rows(); ++r) {
      for (int k = gap.particles.offsets[r]; k < gap.particles.offsets[r + 1]; ++k) {
        const double own = gap.particles.weight[k] * gap.particles.weight[k] * yield_[gap.particles.column[k]];
        diagonal_[r] += Vec3{own, own, own};
      }
      for (int k = gap.nodes.offsets[r]; k < gap.nodes.offsets[r + 1]; ++k) {
        const Vec3& u = unit[static_cast<std::size_t>(gap.nodes.column[k])];
        diagonal_[r] += gap.nodes.weight[k] * gap.nodes.weight[k] * Vec3{std::abs(u.x), std::abs(u.y), std::abs(u.z)};
      }
    }
  }

  /// λ comes in with a guess.
  void evaluate(const GapRates& rates, std::span<Vec3> lambda) const override {
    constexpr double tolerance = 1e-12;
    constexpr int largestIterations = 5000;
    for (std::size_t r = 0; r < lambda.size(); ++r)
      residual_[r] = rates.acceleration[r] + (1.0 / rates.dt) * rates.velocity[r];
    scale();
    const double size = product(residual_, scaled_);
    if (!std::isfinite(size)) return fail("the rates of the gap are not finite");
    if (size == 0.0) return std::fill(lambda.begin(), lambda.end(), Vec3{});
    apply(lambda, image_);
    for (std::size_t r = 0; r < lambda.size(); ++r) residual_[r] -= image_[r];
    scale();
    std::copy(scaled_.begin(), scaled_.end(), step_.begin());
    double left = product(residual_, scaled_);
    for (int iteration = 0; left > tolerance * tolerance * size; ++iteration) {
      if (iteration == largestIterations)
        return fail("conjugate gradients leave " + std::to_string(std::sqrt(left / size)) + " of the load");
      apply(step_, image_);
      const double length = left / product(step_, image_);
      for (std::size_t r = 0; r < lambda.size(); ++r) {
        lambda[r] += length * step_[r];
        residual_[r] -= length * image_[r];
      }
      scale();
      const double before = left;
      left = product(residual_, scaled_);
      for (std::size_t r = 0; r < lambda.size(); ++r) step_[r] = scaled_[r] + (left / before) * step_[r];
    }
  }
  bool needsRates() const override { return true; }

private:
  static void fail(const std::string& what) {
    throw NumericalError(what, "multipliers", "take a narrower kernel, a smaller step, or the penalty");
  }
  void scale() const {
    for (std::size_t r = 0; r < scaled_.size(); ++r)
      for (int c = 0; c < 3; ++c) scaled_[r][c] = diagonal_[r][c] > 0.0 ? residual_[r][c] / diagonal_[r][c] : 0.0;
  }
  void apply(std::span<const Vec3> in, std::span<Vec3> out) const {
    cg::apply(gap_.particlesBack, in, ofParticles_);
    for (std::size_t k = 0; k < ofParticles_.size(); ++k) ofParticles_[k] *= yield_[k];
    std::fill(ofNodes_.begin(), ofNodes_.end(), Vec3{});
    pullNodes(gap_, in, ofNodes_);
    solid_.solve(ofNodes_);
    parallelFor(out.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t r = begin; r < end; ++r)
        out[r] = cg::applyRow(gap_.particles, static_cast<int>(r), ofParticles_) +
                 cg::applyRow(gap_.nodes, static_cast<int>(r), ofNodes_);
    });
  }

  GapOperator gap_;
  const fem::ModelMass& solid_;
  std::vector<double> yield_;   // 1/kg
  std::vector<Vec3> diagonal_;  // 1/kg
  mutable std::vector<Vec3> ofParticles_, ofNodes_, residual_, step_, scaled_, image_;
};

}  // namespace

std::unique_ptr<Constraint> makeIterativeMultiplier(const GapOperator& gap, const Overlap& overlap,
                                                    std::span<const double> particleMass, const fem::ModelMass& solid) {
  return std::make_unique<IterativeMultiplier>(gap, overlap, particleMass, solid);
}

}  // namespace dovetail::arlequin
