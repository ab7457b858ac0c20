// Constraints without a solve: the penalty on the accumulated gap, and the dashpot on its increments.
#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/core/finite.hpp"
#include "pseudo_inverse.hpp"

namespace dovetail::arlequin {

namespace {

class Penalty final : public Constraint {
public:
  explicit Penalty(std::vector<double> stiffness) : stiffness_(std::move(stiffness)) {}
  void evaluate(const GapRates& rates, std::span<Vec3> lambda) const override {
    for (std::size_t r = 0; r < lambda.size(); ++r) lambda[r] = stiffness_[r] * rates.gap[r];
  }
  double storedEnergy(std::span<const Vec3> gap) const override {
    double sum = 0.0;
    for (std::size_t r = 0; r < gap.size(); ++r) sum += 0.5 * stiffness_[r] * squaredNorm(gap[r]);
    return sum;
  }
  void applyStiffness(std::span<const Vec3> gap, std::span<Vec3> lambda) const override {
    for (std::size_t r = 0; r < gap.size(); ++r) lambda[r] = stiffness_[r] * gap[r];
  }

private:
  std::vector<double> stiffness_;  // p V_i, N/m
};

class MetricPenalty final : public Constraint {
public:
  MetricPenalty(const GapOperator& gap, std::span<const double> volume, double penalty, double rankTolerance)
      : rows_(static_cast<Eigen::Index>(gap.rows())), metric_(Matrix::Zero(rows_, rows_)) {
    const cg::Projection& back = gap.particlesBack;
    for (int k = 0; k < back.rows(); ++k)
      for (int a = back.offsets[k]; a < back.offsets[k + 1]; ++a)
        for (int b = back.offsets[k]; b < back.offsets[k + 1]; ++b)
          metric_(back.column[a], back.column[b]) += back.weight[a] * back.weight[b] / volume[k];
    metric_ = penalty * pseudoInverse(metric_, rankTolerance);
  }
  void evaluate(const GapRates& rates, std::span<Vec3> lambda) const override { apply(rates.gap, lambda); }
  double storedEnergy(std::span<const Vec3> gap) const override {
    std::vector<Vec3> lambda(gap.size());
    apply(gap, lambda);
    double sum = 0.0;
    for (std::size_t r = 0; r < gap.size(); ++r) sum += 0.5 * dot(gap[r], lambda[r]);
    return sum;
  }
  void applyStiffness(std::span<const Vec3> gap, std::span<Vec3> lambda) const override { apply(gap, lambda); }

private:
  void apply(std::span<const Vec3> gap, std::span<Vec3> lambda) const {
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> in(&gap[0].x, rows_, 3);
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> out(&lambda[0].x, rows_, 3);
    out.noalias() = metric_ * in;
  }
  Eigen::Index rows_;
  Matrix metric_;  // N/m
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

std::unique_ptr<Constraint> makeMetricPenalty(const GapOperator& gap, std::span<const double> volume, double penalty,
                                              double rankTolerance) {
  requireFewRows(gap.rows(), "penalty with kernels");
  return std::make_unique<MetricPenalty>(gap, volume, requirePositive(penalty, "penalty"), rankTolerance);
}

std::unique_ptr<Constraint> makeDashpot(const GapOperator& gap, double penalty, bool consistent) {
  return std::make_unique<Dashpot>(gap, requirePositive(penalty, "penalty"), consistent);
}

double automaticPenalty(double youngsModulus, double elementSize) {
  return 20.0 * requirePositive(youngsModulus, "Young's modulus") /
         (requirePositive(elementSize, "element size") * elementSize);
}

}  // namespace dovetail::arlequin
