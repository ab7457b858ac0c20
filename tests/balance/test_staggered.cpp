// What does not conserve energy is booked: staggered steps and the paper's spread load.
#include <gtest/gtest.h>

#include "coupled_block.hpp"

namespace dovetail::surface {
namespace {

constexpr double duration = 0.1;

struct Case {
  bool skinLags, implicitSolid, smooth;
  int K;
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << (c.skinLags ? "skin lags" : "skin moves") << (c.implicitSolid ? ", implicit" : ", explicit")
             << (c.smooth ? ", smooth" : ", flat") << ", K = " << c.K;
}

class Staggered : public ::testing::TestWithParam<Case> {
protected:
  static Result run(double h) {
    const auto [skinLags, implicitSolid, smooth, K] = GetParam();
    const BlockSetup setup{.booksWork = true};
    const Scheme scheme{.booksCoupling = true, .skinLags = skinLags};
    return smooth ? runStaggered(smoothModel(setup), duration, h / K, K, implicitSolid, scheme)
                  : runStaggered(flatModel(setup), duration, h / K, K, implicitSolid, scheme);
  }
};

/// The lag makes energy to first order in the step, the books close to second.
TEST_P(Staggered, TheLedgerClosesWithWhatTheLagMade) {
  const Result coarse = run(4e-4), fine = run(5e-5);
  EXPECT_GT(std::abs(fine.made), 5e-4 * fine.initial);
  EXPECT_LT(fine.worstResidual, 0.02 * std::abs(fine.made));
  EXPECT_GT(std::log(coarse.worstResidual / fine.worstResidual) / std::log(8.0), 1.6);
}

INSTANTIATE_TEST_SUITE_P(Cases, Staggered,
                         ::testing::Values(Case{false, false, false, 1}, Case{false, false, false, 4},
                                           Case{false, true, false, 1}, Case{true, false, false, 1},
                                           Case{true, true, false, 4}, Case{false, false, true, 1},
                                           Case{true, true, true, 4}));

/// A block that answers the load as a spring takes energy from the lag, one that gives way as a mass is given some.
TEST(StaggeredOnASoftBlock, CreatesEnergy) {
  const BlockSetup setup{.youngsModulus = 1e4, .booksWork = true};
  const Scheme scheme{.booksCoupling = true};
  const Result coarse = runStaggered(flatModel(setup), duration, 2e-4, 1, false, scheme);
  const Result fine = runStaggered(flatModel(setup), duration, 1e-4, 1, false, scheme);
  EXPECT_GT(fine.made, 1e-3 * fine.initial);
  EXPECT_NEAR(coarse.made / fine.made, 2.0, 0.2);
  EXPECT_LT(fine.worstResidual, 0.02 * fine.made);
  EXPECT_LT(runExplicit(flatModel(setup), duration, 1e-4, 1).worstDrift, 0.02 * fine.made);
}

/// The spread load makes or takes energy whatever the step; the books close to second order.
TEST(Spread, TheLedgerClosesWithWhatTheTransferMade) {
  const BlockSetup setup{.width = 0.15, .spread = true, .booksWork = true};
  const Scheme scheme{.booksCoupling = true};
  for (int K : {1, 4})
    for (bool implicitSolid : {false, true}) {
      const auto run = [&](double h) {
        return implicitSolid ? runImplicit(flatModel(setup), duration, h / K, K, scheme)
                             : runExplicit(flatModel(setup), duration, h / K, K, scheme);
      };
      const Result coarse = run(8e-4), fine = run(1e-4);
      EXPECT_GT(std::abs(fine.made), 3e-3 * fine.initial);
      EXPECT_NEAR(fine.made, coarse.made, 0.1 * std::abs(fine.made)) << "no smaller step helps";
      EXPECT_LT(fine.worstResidual, 5e-3 * std::abs(fine.made));
      EXPECT_GT(std::log(coarse.worstResidual / fine.worstResidual) / std::log(8.0), 1.6);
    }
}

/// An adjoint pair makes nothing, and the books say so: to round-off where the skin is linear in the nodes, and to the
/// error of the trapezoidal rule where offsets turn with patches.
TEST(AdjointPair, MakesNothing) {
  const Scheme scheme{.booksCoupling = true};
  for (int K : {1, 4}) {
    for (const double width : {0.0, 0.15}) {
      const auto made = [&](double dt) {
        const Result result = runExplicit(flatModel({.width = width, .booksWork = true}), duration, dt, K, scheme);
        return std::abs(result.made) / result.initial;
      };
      EXPECT_LT(made(2e-4), width == 0.0 ? 1e-13 : 1e-10);
      EXPECT_LT(made(1e-4), width == 0.0 ? 1e-13 : 0.35 * made(2e-4));
    }
  }
}

}  // namespace
}  // namespace dovetail::surface
