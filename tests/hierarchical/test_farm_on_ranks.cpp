// Farms on the ranks of MPI. Rank 0 runs the tests, the others serve.
#include <gtest/gtest.h>

#include <csignal>
#include <iostream>

#include "dovetail/hierarchical/farm.hpp"
#include "dovetail/ranks/session.hpp"
#include "farm_bodies.hpp"

namespace dovetail::hierarchical {
namespace {

TEST(FarmOnRanks, LoadStepsHaveTheDigitsOfOneProcess) {
  const auto field = cellField(threeCells(), QuasiStaticCells{});
  EXPECT_EQ(inLoadSteps(field), inLoadSteps(fieldHere(threeCells(), QuasiStaticCells{})));
  if (const FarmReport* const report = farmReport(*field))
    std::cout << report->points.size() << " ranks, " << report->moves << " moves\n";
}

TEST(FarmOnRanks, ExplicitStepsAndStatesHaveTheDigitsOfOneProcess) {
  EXPECT_EQ(inExplicitSteps(cellField(threeCells(), DynamicCells{}), 10, 20),
            inExplicitSteps(fieldHere(threeCells(), DynamicCells{}), 10, 20));
}

TEST(FarmOnRanks, ThreadsOfItDoNotChangeADigit) {
  const auto outcomes = [](int threads) {
    return onThreads(threads, [] { return inLoadSteps(cellField(threeCells(), QuasiStaticCells{})); });
  };
  EXPECT_EQ(outcomes(1), outcomes(2));
}

TEST(FarmOnRanks, LettersLongerThanABufferArrive) {
  const int points = 600;  // some 10 MB of states
  Asked farm(cellField(threeCells(), DynamicCells{}), points), here(fieldHere(threeCells(), DynamicCells{}), points);
  ByteWriter one, other;
  farm.field().save(one), here.field().save(other);
  EXPECT_TRUE(one.bytes() == other.bytes());
  ByteReader back(one.bytes());
  farm.field().load(back);
  const Eigen::Matrix3d F = rve::plane(1.0, 1e-4, 0.0, 0.9999);
  farm(F, true), here(F, true);
  EXPECT_TRUE(farm.tangent == here.tangent);
}

volatile std::sig_atomic_t noted = 0;
void note(int signal) { noted = signal; }

TEST(FarmOnRanks, SignalsStayWithTheProgram) {
  ranks::start();
  std::raise(SIGTERM);
  EXPECT_EQ(noted, SIGTERM);
}

}  // namespace
}  // namespace dovetail::hierarchical

int main(int argc, char** argv) {
  std::signal(SIGTERM, dovetail::hierarchical::note);
  if (dovetail::hierarchical::serveFarm()) return 0;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
