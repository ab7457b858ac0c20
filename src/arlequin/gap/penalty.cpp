// Constraints without a solve: the penalty on the accumulated gap, and the dashpot on its increments.
#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/core/finite.hpp"
#include "gap_matrix.hpp"

namespace dovetail::arlequin {

namespace {

class Penalty final : public Constraint {
public:
  explicit Penalty(std::vector<double> stiffness) : stiffness_(std::move(stiffness)) {}
  void evaluate(const GapRates& rates, std::span<Vec3> lambda) const override {
    for (std::size_t r = 0; r < lambda.size(); ++r) lambda[r] = stiffness_[r] * rates.gap[r];
  }
  bool stores() const override { return true; }
  void applyStiffness(std::span<const Vec3> gap, std::span<Vec3> lambda) const override {
    for (std::size_t r = 0; r < gap.size(); ++r) lambda[r] = stiffness_[r] * gap[r];
  }

private:
  std::vector<double> stiffness_;  // p V_i, N/m
};

class MetricPenalty final : public Constraint {
public:
  MetricPenalty(const GapOperator& gap, std::span<const double> volume, double penalty)
      : penalty_(penalty), metric_(metricOf(gap, volume), gap.X) {}
  void evaluate(const GapRates& rates, std::span<Vec3> lambda) const override { apply(rates.gap, lambda); }
  bool stores() const override { return true; }
  void applyStiffness(std::span<const Vec3> gap, std::span<Vec3> lambda) const override { apply(gap, lambda); }

private:
  static linalg::SparseMatrix metricOf(const GapOperator& gap, std::span<const double> volume) {
    std::vector<double> inverse;
    for (const double v : volume) inverse.push_back(1.0 / v);
    const WeighedMap map{gap.particles, gap.particlesBack, inverse};
    return gapMatrix({&map, 1});
  }
  void apply(std::span<const Vec3> gap, std::span<Vec3> lambda) const {
    const std::size_t rows = gap.size();
    columns_.resize(3 * rows);
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < 3; ++c) columns_[c * rows + r] = penalty_ * gap[r][static_cast<int>(c)];
    metric_.solve(columns_, 3);
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < 3; ++c) lambda[r][static_cast<int>(c)] = columns_[c * rows + r];
  }
  double penalty_;
  GapInverse metric_;  // of Π D Πᵀ, m³
  mutable std::vector<double> columns_;
};

class Dashpot final : public Constraint {
public:
  Dashpot(const GapOperator& gap, double penalty, bool consistent)
      : products_(gap.volumeProducts), consistent_(consistent) {
    for (const double volume : gap.volume) stiffness_.push_back(penalty * volume);
    for (double& value : products_.weight) value *= penalty;
  }
  void evaluate(const GapRates& rates, std::span<Vec3> lambda) const override {
    if (consistent_)
      cg::apply(products_, rates.increment, lambda);
    else
      for (std::size_t r = 0; r < lambda.size(); ++r) lambda[r] = stiffness_[r] * rates.increment[r];
  }

private:
  cg::Projection products_;
  std::vector<double> stiffness_;
  bool consistent_;
};

}  // namespace

std::unique_ptr<Constraint> makePenalty(std::vector<double> stiffness) {
  for (const double value : stiffness) requirePositive(value, "penalty");
  return std::make_unique<Penalty>(std::move(stiffness));
}

std::unique_ptr<Constraint> makeMetricPenalty(const GapOperator& gap, std::span<const double> volume, double penalty) {
  return std::make_unique<MetricPenalty>(gap, volume, requirePositive(penalty, "penalty"));
}

std::unique_ptr<Constraint> makeDashpot(const GapOperator& gap, double penalty, bool consistent) {
  return std::make_unique<Dashpot>(gap, requirePositive(penalty, "penalty"), consistent);
}

double automaticPenalty(double youngsModulus, double elementSize) {
  return 20.0 * requirePositive(youngsModulus, "Young's modulus") /
         (requirePositive(elementSize, "element size") * elementSize);
}

}  // namespace dovetail::arlequin
