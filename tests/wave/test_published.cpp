#include <gtest/gtest.h>

#include "reference_curves.hpp"
#include "short_bar.hpp"

namespace dovetail::wave {
namespace {

double dissipatedInTheScheme(test::Words words) {
  words.insert(words.end(), {"--scheme", "paper", "--no-comparison"});
  const RunFigures f = run(test::settingsOf(words)).figures;
  EXPECT_TRUE(f.stable);
  return f.paperDissipatedFraction;
}

TEST(PublishedScheme, DissipatesWhatTheDepositedRunDoes) {
  ASSERT_EQ(publishedRuns[0].particlesPerEdge, 1);
  ASSERT_EQ(publishedRuns[0].cgWidth, 0.0);
  EXPECT_NEAR(dissipatedInTheScheme({}), publishedRuns[0].dissipatedFraction, 0.002);
}

TEST(PublishedScheme, WouldLoseLessWithOneRowPerNode) {
  const double fraction = dissipatedInTheScheme({"--rows", "per-node"});
  EXPECT_GT(fraction, 0.1);
  EXPECT_LT(fraction, publishedRuns[0].dissipatedFraction - 0.05);
}

}  // namespace
}  // namespace dovetail::wave
