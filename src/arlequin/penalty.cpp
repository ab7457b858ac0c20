// Constraints without a solve: the penalty on the accumulated gap, and the dashpot on its increments.
#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::arlequin {

namespace {

class Penalty final : public Constraint {
public:
  Penalty(const GapOperator& gap, double penalty) : stiffness_(gap.volume) {
    for (double& value : stiffness_) value *= penalty;
  }
  void evaluate(const GapRates& rates, std::span<Vec3> lambda) const override {
    for (std::size_t r = 0; r < lambda.size(); ++r) lambda[r] = stiffness_[r] * rates.gap[r];
  }
  double storedEnergy(std::span<const Vec3> gap) const override {
    double sum = 0.0;
    for (std::size_t r = 0; r < gap.size(); ++r) sum += 0.5 * stiffness_[r] * squaredNorm(gap[r]);
    return sum;
  }
  double stiffness(std::size_t row) const override { return stiffness_[row]; }

private:
  std::vector<double> stiffness_;  // p V_i, N/m
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

std::unique_ptr<Constraint> makePenalty(const GapOperator& gap, double penalty) {
  return std::make_unique<Penalty>(gap, requirePositive(penalty, "penalty"));
}

std::unique_ptr<Constraint> makeDashpot(const GapOperator& gap, double penalty, bool consistent) {
  return std::make_unique<Dashpot>(gap, requirePositive(penalty, "penalty"), consistent);
}

double automaticPenalty(double youngsModulus, double elementSize) {
  return 5.0 * requirePositive(youngsModulus, "Young's modulus") /
         (requirePositive(elementSize, "element size") * elementSize);
}

}  // namespace dovetail::arlequin
