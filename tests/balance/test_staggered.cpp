// What does not conserve energy is booked: loads that lag and the paper's spread load.
#include <gtest/gtest.h>

#include "coupled_block.hpp"

namespace dovetail::surface {
namespace {

constexpr double duration = 0.1;

struct Case {
  Lag lag;
  bool implicitSolid, smooth;
  int K;
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << (c.lag == Lag::loadAndSkin ? "skin lags" : "skin moves")
             << (c.implicitSolid ? ", implicit" : ", explicit") << (c.smooth ? ", smooth" : ", flat")
             << ", K = " << c.K;
}

class Staggered : public ::testing::TestWithParam<Case> {
protected:
  static Result run(double h) {
    const Case& c = GetParam();
    const auto stepping = c.implicitSolid ? Stepping::implicitSteps : Stepping::explicitSteps;
    return runFor({.stepping = stepping, .smooth = c.smooth}, duration, h, c.K, c.lag);
  }
};

/// The lag makes energy to first order in the step, the ledger close to second.
TEST_P(Staggered, TheLedgerClosesWithWhatTheLagMade) {
  const Result coarse = run(4e-4), fine = run(5e-5);
  EXPECT_GT(std::abs(fine.made), 5e-4 * fine.initial);
  EXPECT_LT(fine.worstResidual, 0.02 * std::abs(fine.made));
  EXPECT_GT(std::log(coarse.worstResidual / fine.worstResidual) / std::log(8.0), 1.6);
}

INSTANTIATE_TEST_SUITE_P(Cases, Staggered,
                         ::testing::Values(Case{Lag::load, false, false, 1}, Case{Lag::load, false, false, 4},
                                           Case{Lag::load, true, false, 1}, Case{Lag::loadAndSkin, false, false, 1},
                                           Case{Lag::loadAndSkin, true, false, 4}, Case{Lag::load, false, true, 1},
                                           Case{Lag::loadAndSkin, true, true, 4}));

/// A block that answers the load as a spring takes energy from the lag, one that gives way as a mass is given some.
TEST(StaggeredOnASoftBlock, CreatesEnergy) {
  const BlockSetup setup{.youngsModulus = 1e4};
  const Result coarse = runFor(setup, duration, 2e-4, 1, Lag::load);
  const Result fine = runFor(setup, duration, 1e-4, 1, Lag::load);
  EXPECT_GT(fine.made, 1e-3 * fine.initial);
  EXPECT_NEAR(coarse.made / fine.made, 2.0, 0.2);
  EXPECT_LT(fine.worstResidual, 0.02 * fine.made);
  EXPECT_LT(runFor(setup, duration, 1e-4, 1).worstDrift, 0.02 * fine.made);
}

/// The spread load makes or takes energy whatever the step; the ledger close to second order.
TEST(Spread, TheLedgerClosesWithWhatTheTransferMade) {
  for (const int K : {1, 4})
    for (const Stepping stepping : {Stepping::explicitSteps, Stepping::implicitSteps}) {
      const BlockSetup setup{.stepping = stepping, .width = 0.15, .spread = true, .booksWork = true};
      const Result coarse = runFor(setup, duration, 8e-4, K), fine = runFor(setup, duration, 1e-4, K);
      EXPECT_GT(std::abs(fine.made), 3e-3 * fine.initial);
      EXPECT_NEAR(fine.made, coarse.made, 0.1 * std::abs(fine.made)) << "no smaller step helps";
      EXPECT_LT(fine.worstResidual, 5e-3 * std::abs(fine.made));
      EXPECT_GT(std::log(coarse.worstResidual / fine.worstResidual) / std::log(8.0), 1.6);
    }
}

/// An adjoint pair makes nothing, and the ledger say so to round-off.
TEST(AdjointPair, MakesNothing) {
  for (const int K : {1, 4})
    for (const double width : {0.0, 0.15}) {
      const Result result = runFor({.width = width, .booksWork = true}, duration, K * 2e-4, K);
      EXPECT_LT(std::abs(result.made), 1e-13 * result.initial);
    }
}

}  // namespace
}  // namespace dovetail::surface
