// When Newton's method keeps the factors that it has, by residuals that are written down.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "solve/newton.hpp"

namespace dovetail::fem::detail {
namespace {

/// Goes through the residuals given, whatever is asked of it.
class Written final : public NewtonProblem {
public:
  explicit Written(std::vector<double> norms, bool mixes = false) : norms_(std::move(norms)), mixes_(mixes) {}

  double evaluate() override { return norms_.at(at_++); }
  double tolerance() const override { return 1.0; }
  bool factored() const override { return true; }
  bool factor(bool) override {
    factorsAt.push_back(at_ - 1);
    return true;
  }
  bool direct(double) override { return true; }
  double slope() const override { return 0.0; }
  bool endMixing() override {
    if (mixes_) endedAt.push_back(at_ - 1);
    return std::exchange(mixes_, false);
  }
  void moveTo(double) override {}

  std::vector<std::size_t> factorsAt, endedAt;  ///< iterations

private:
  std::vector<double> norms_;
  std::size_t at_ = 0;
  bool mixes_;
};

using Iterations = std::vector<std::size_t>;

NewtonPolicy keeping(double contraction, std::size_t over) { return {50, LineSearch::never, 1000, contraction, over}; }

TEST(Newton, FactorsAreRenewedWhereOneIterationShrinksTheResidualTooLittle) {
  Written problem({100.0, 40.0, 30.0, 10.0, 4.0, 0.5});
  EXPECT_EQ(newton(problem, keeping(0.5, 1)).iterations, 5);
  EXPECT_EQ(problem.factorsAt, Iterations{2});
}

TEST(Newton, FactorsAreNotKeptAgainAfterTheWrongWay) {
  Written problem({100.0, 110.0, 30.0, 10.0, 0.5});
  EXPECT_EQ(newton(problem, keeping(0.5, 1)).iterations, 4);
  EXPECT_EQ(problem.factorsAt, (Iterations{1, 2, 3}));
}

TEST(Newton, MixedIncrementsAreJudgedTogether) {
  std::vector<double> norms{100.0};
  while (norms.back() > 1.0) norms.push_back(0.8 * norms.back());  // 0.33 in five
  Written problem(norms, true);
  EXPECT_EQ(newton(problem, keeping(0.5, 5)).iterations, static_cast<int>(norms.size()) - 1);
  EXPECT_TRUE(problem.factorsAt.empty());
  EXPECT_TRUE(problem.endedAt.empty());
}

TEST(Newton, TheWrongWayEndsMixingAndTheNextOneTheFactors) {
  Written problem({100.0, 60.0, 70.0, 50.0, 51.0, 45.0, 40.0, 35.0, 20.0, 0.5}, true);
  EXPECT_EQ(newton(problem, keeping(0.5, 5)).iterations, 9);
  EXPECT_EQ(problem.endedAt, Iterations{2});
  EXPECT_EQ(problem.factorsAt, Iterations{4});
}

TEST(Newton, StagnationEndsFactorsAlsoWhereIncrementsAreMixed) {
  Written problem({100.0, 99.0, 98.0, 97.0, 96.0, 95.0, 20.0, 5.0, 0.5}, true);
  EXPECT_EQ(newton(problem, keeping(0.5, 5)).iterations, 8);
  EXPECT_TRUE(problem.endedAt.empty());
  EXPECT_EQ(problem.factorsAt, Iterations{5});
}

}  // namespace
}  // namespace dovetail::fem::detail
