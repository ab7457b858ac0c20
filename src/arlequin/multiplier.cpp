#include <algorithm>
#include <string>

#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/core/error.hpp"
#include "pseudo_inverse.hpp"

namespace dovetail::arlequin {

namespace {

/// A for one component; nodes that are held in it do not yield.
Matrix compliance(const GapOperator& gap, const Overlap& overlap, std::span<const double> particleMass,
                  const fem::ModelMass& solid, int component) {
  const auto rows = static_cast<Eigen::Index>(gap.rows());
  Matrix A = Matrix::Zero(rows, rows);
  const cg::Projection& back = gap.particlesBack;
  for (int k = 0; k < back.rows(); ++k) {
    const double yield = 1.0 / particleMass[overlap.particle[k]];
    for (int a = back.offsets[k]; a < back.offsets[k + 1]; ++a)
      for (int b = back.offsets[k]; b < back.offsets[k + 1]; ++b)
        A(back.column[a], back.column[b]) += yield * back.weight[a] * back.weight[b];
  }
  std::vector<Vec3> response(static_cast<std::size_t>(gap.nodes.columns));
  for (Eigen::Index row = 0; row < rows; ++row) {
    std::fill(response.begin(), response.end(), Vec3{});
    for (int k = gap.nodes.offsets[row]; k < gap.nodes.offsets[row + 1]; ++k)
      response[gap.nodes.column[k]][component] = gap.nodes.weight[k];
    solid.solve(response);
    for (Eigen::Index other = 0; other < rows; ++other)
      for (int k = gap.nodes.offsets[other]; k < gap.nodes.offsets[other + 1]; ++k)
        A(other, row) += gap.nodes.weight[k] * response[gap.nodes.column[k]][component];
  }
  return 0.5 * (A + A.transpose());
}

class Multiplier final : public Constraint {
public:
  Multiplier(const GapOperator& gap, const Overlap& overlap, std::span<const double> particleMass,
             const fem::ModelMass& solid, double rankTolerance)
      : rows_(gap.rows()) {
    const std::span<const int> row = solid.dofs().freeRow();
    const auto sameHeld = [&](std::size_t a, std::size_t b) {
      for (std::size_t dof = 0; dof < row.size(); dof += 3)
        if ((row[dof + a] < 0) != (row[dof + b] < 0)) return false;
      return true;
    };
    for (std::size_t c = 0; c < 3; ++c) {
      std::size_t first = 0;
      while (first < c && !sameHeld(first, c)) ++first;
      systemOf_[c] = first < c ? systemOf_[first] : systems_.size();
      if (first == c)
        systems_.push_back(
            pseudoInverse(compliance(gap, overlap, particleMass, solid, static_cast<int>(c)), rankTolerance));
    }
  }
  void evaluate(const GapRates& rates, std::span<Vec3> lambda) const override {
    std::vector<Vec3> load(rows_);
    for (std::size_t r = 0; r < rows_; ++r) load[r] = rates.acceleration[r] + (1.0 / rates.dt) * rates.velocity[r];
    for (std::size_t s = 0; s < systems_.size(); ++s)
      for (std::size_t r = 0; r < rows_; ++r) {
        const double* row = systems_[s].data() + r * rows_;
        Vec3 sum;
        for (std::size_t j = 0; j < rows_; ++j) sum += row[j] * load[j];
        for (std::size_t c = 0; c < 3; ++c)
          if (systemOf_[c] == s) lambda[r][static_cast<int>(c)] = sum[static_cast<int>(c)];
      }
  }
  bool needsRates() const override { return true; }

private:
  std::size_t rows_;
  std::vector<Matrix> systems_;  // A⁺ of the distinct sets of held nodes
  std::array<std::size_t, 3> systemOf_{};
};

}  // namespace

std::unique_ptr<Constraint> makeMultiplier(const GapOperator& gap, const Overlap& overlap,
                                           std::span<const double> particleMass, const fem::ModelMass& solid,
                                           double rankTolerance) {
  requireFewRows(gap.rows(), "multiplier");
  return std::make_unique<Multiplier>(gap, overlap, particleMass, solid, rankTolerance);
}

}  // namespace dovetail::arlequin
