// Lagrange multipliers: conjugate gradients on A = Π M_DE⁻¹ Πᵀ + B M_FE⁻¹ Bᵀ, which is not formed, led by the factors
// of the same matrix with lumped masses.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "compliance.hpp"
#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "gap_matrix.hpp"

namespace dovetail::arlequin {

namespace {

constexpr std::size_t chunkSize = 1024;

double product(std::span<const Vec3> a, std::span<const Vec3> b) {
  return parallelSum(a.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t r = begin; r < end; ++r) sum += dot(a[r], b[r]);
    return sum;
  });
}

class Multiplier final : public Constraint {
public:
  Multiplier(const GapOperator& gap, const Overlap& overlap, std::span<const double> particleMass,
             const fem::ModelMass& solid, Multiplier* before)
      : compliance_(gap, overlap, particleMass, solid) {
    for (auto* v : {&residual_, &step_, &led_, &image_}) v->resize(gap.rows());
    std::vector<LumpedNodes> nodes;
    for (std::size_t c = 0; c < 3; ++c) {
      LumpedNodes next = lumpedNodes(gap, solid, static_cast<int>(c));
      const auto same = std::ranges::find(nodes, next);
      systemOf_[c] = static_cast<std::size_t>(same - nodes.begin());
      if (same == nodes.end()) nodes.push_back(std::move(next));
    }
    for (const LumpedNodes& of : nodes) {
      const WeighedMap maps[] = {{gap.particles, gap.particlesBack, compliance_.yield()}, {of.map, of.back, of.yield}};
      const std::size_t place = systems_.size();
      systems_.emplace_back(gapMatrix(maps), gap.X,
                            before && place < before->systems_.size() ? &before->systems_[place] : nullptr);
    }
  }

  /// λ comes in with a guess.
  void evaluate(const GapRates& rates, std::span<Vec3> lambda) const override {
    constexpr double tolerance = 1e-12;
    constexpr double seen = 1e-2;
    constexpr int largestIterations = 5000;
    for (std::size_t r = 0; r < lambda.size(); ++r)
      residual_[r] = rates.acceleration[r] + (1.0 / rates.dt) * rates.velocity[r];
    const double size = sizeOf(residual_);
    if (!std::isfinite(size)) return fail("the rates of the gap are not finite");
    if (size == 0.0) return std::fill(lambda.begin(), lambda.end(), Vec3{});
    compliance_.apply(lambda, image_);
    for (std::size_t r = 0; r < lambda.size(); ++r) residual_[r] -= image_[r];
    double before = 0.0;
    for (int iteration = 0;; ++iteration) {
      const double left = sizeOf(residual_);
      if (left <= tolerance * tolerance * size || (iteration > 0 && left <= resolution(lambda))) return;
      if (iteration == largestIterations || !std::isfinite(left))
        return fail("conjugate gradients leave " + std::to_string(std::sqrt(left / size)) + " of the load");
      lead();
      const double now = product(residual_, led_);
      const double weight = iteration == 0 ? 0.0 : now / before;
      for (std::size_t r = 0; r < lambda.size(); ++r) step_[r] = led_[r] + weight * step_[r];
      compliance_.apply(step_, image_);
      const double curvature = product(step_, image_);
      if (curvature < seen * now) return;  // what is left is round-off of loads that no force on the rows can answer
      const double length = now / curvature;
      for (std::size_t r = 0; r < lambda.size(); ++r) {
        lambda[r] += length * step_[r];
        residual_[r] -= length * image_[r];
      }
      before = now;
    }
  }
  bool needsRates() const override { return true; }

private:
  static void fail(const std::string& what) {
    throw NumericalError(what, "multipliers", "take a narrower kernel, a smaller step, or the penalty");
  }
  /// Squared, of a load.
  double sizeOf(std::span<const Vec3> load) const {
    return parallelSum(load.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
      double sum = 0.0;
      for (std::size_t r = begin; r < end; ++r)
        for (int c = 0; c < 3; ++c) {
          const double scaled = systems_[systemOf_[static_cast<std::size_t>(c)]].scale()[r] * load[r][c];
          sum += scaled * scaled;
        }
      return sum;
    });
  }
  /// Squared, of the smallest load that round-off leaves of A λ: Π, B and masses are positive.
  double resolution(std::span<const Vec3> lambda) const {
    constexpr double roundOff = 4.0 * std::numeric_limits<double>::epsilon();
    for (std::size_t r = 0; r < lambda.size(); ++r)
      led_[r] = {std::abs(lambda[r].x), std::abs(lambda[r].y), std::abs(lambda[r].z)};
    compliance_.apply(led_, image_);
    return roundOff * roundOff * sizeOf(image_);
  }
  /// led ← (A of lumped masses)⁻¹ residual.
  void lead() const {
    const std::size_t rows = led_.size();
    for (std::size_t s = 0; s < systems_.size(); ++s) {
      columns_.clear();
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t r = 0; r < rows && systemOf_[c] == s; ++r)
          columns_.push_back(residual_[r][static_cast<int>(c)]);
      systems_[s].solve(columns_, static_cast<int>(columns_.size() / rows));
      std::size_t place = 0;
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t r = 0; r < rows && systemOf_[c] == s; ++r) led_[r][static_cast<int>(c)] = columns_[place++];
    }
  }

  Compliance compliance_;
  std::vector<GapInverse> systems_;  // of the distinct sets of free nodes
  std::array<std::size_t, 3> systemOf_{};
  mutable std::vector<double> columns_;
  mutable std::vector<Vec3> residual_, step_, led_, image_;
};

}  // namespace

std::unique_ptr<Constraint> makeMultiplier(const GapOperator& gap, const Overlap& overlap,
                                           std::span<const double> particleMass, const fem::ModelMass& solid,
                                           std::unique_ptr<Constraint> before) {
  return std::make_unique<Multiplier>(gap, overlap, particleMass, solid, dynamic_cast<Multiplier*>(before.get()));
}

}  // namespace dovetail::arlequin
