#include <gtest/gtest.h>

#include "reference_curves.hpp"
#include "short_bar.hpp"

namespace dovetail::wave {
namespace {

double dissipatedInTheScheme(Settings settings) {
  settings.quiet = true;
  settings.compare = false;
  const RunFigures f = run(settings).figures;
  EXPECT_TRUE(f.stable);
  return f.paperDissipatedShare;
}

TEST(PublishedScheme, DissipatesWhatTheDepositedRunDoes) {
  Settings settings;
  applyScheme(settings, Scheme::paper);
  ASSERT_EQ(publishedRuns[0].particlesPerEdge, 1);
  ASSERT_EQ(publishedRuns[0].cgWidth, 0.0);
  EXPECT_NEAR(dissipatedInTheScheme(settings), publishedRuns[0].dissipatedShare, 0.02);
}

TEST(PublishedScheme, WouldLoseLessWithOneRowPerNode) {
  Settings settings;
  applyScheme(settings, Scheme::paper);
  settings.rows = Rows::perNode;
  const double share = dissipatedInTheScheme(settings);
  EXPECT_GT(share, 0.1);
  EXPECT_LT(share, publishedRuns[0].dissipatedShare - 0.05);
}

TEST(PublishedScheme, PartsThatWereNotChangedAreThoseOfTheScheme) {
  Settings settings;
  applyScheme(settings, Scheme::paper);
  applyScheme(settings, Scheme::conservative);
  EXPECT_EQ(describe(settings), describe(Settings{}));
}

}  // namespace
}  // namespace dovetail::wave
