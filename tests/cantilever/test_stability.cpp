#include <gtest/gtest.h>

#include <algorithm>

#include "model.hpp"
#include "short_run.hpp"

namespace dovetail::cantilever {
namespace {

using test::refusal;
using test::runUntil;
using test::settingsOf;
using test::Words;

testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << '"' << part << "\" is not in \"" << text << '"';
}

/// Every sampled figure of the run but the times it took.
void expectSameBits(const RunResult& a, const RunResult& b) {
  ASSERT_EQ(a.series.names(), b.series.names());
  ASSERT_EQ(a.series.rows(), b.series.rows());
  ASSERT_GE(a.series.rows(), 10u);
  for (std::size_t c = 0; c < a.series.names().size(); ++c)
    EXPECT_TRUE(std::ranges::equal(a.series.column(c), b.series.column(c))) << a.series.names()[c];
  EXPECT_EQ(a.figures.energyDrift, b.figures.energyDrift);
  EXPECT_EQ(a.figures.momentResidual, b.figures.momentResidual);
}

TEST(Repeatability, ThreadsAndRepetitionDoNotChangeABit) {
  for (const char* width : {"0", "6"})
    for (const char* surface : {"flat", "smooth"}) {
      SCOPED_TRACE(testing::Message() << "width " << width << ", surface " << surface);
      const RunResult one = runUntil(0.25, {"--cg-width", width, "--surface", surface});
      expectSameBits(one, runUntil(0.25, {"--cg-width", width, "--surface", surface}));
      expectSameBits(one, runUntil(0.25, {"--cg-width", width, "--surface", surface, "--threads", "2"}));
    }
}

TEST(Repeatability, AnObserverSeesTheRunAndDoesNotChangeIt) {
  Settings settings = settingsOf({"--until", "0.3"});
  settings.outputInterval = 0.05;
  std::vector<double> times;
  const RunResult watched = run(settings, [&](const Frame& frame) { times.push_back(frame.time); });
  expectSameBits(watched, run(settings));
  ASSERT_GE(times.size(), 6u);
  EXPECT_EQ(times.front(), 0.0);
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_NEAR(times[i] - times[i - 1], 0.05, 1e-3);
}

TEST(CriticalStep, TheLimitThatTheMessageGivesIsTaken) {
  for (const char* width : {"0", "10"}) {
    const Words words{"--cg-width", width, "--dt-factor"};
    const auto with = [&](double factor) {
      Words all = words;
      all.push_back(std::to_string(factor));
      return refusal(all);
    };
    const std::string message = with(5.0), before = "give at most ";
    ASSERT_TRUE(contains(message, before));
    const double most = std::stod(message.substr(message.find(before) + before.size()));
    EXPECT_EQ(with(most), "");
    EXPECT_NE(with(1.002 * most), "");
  }
}

TEST(CriticalStep, JustBelowItEveryVariantIsStable) {
  for (const Words& variant : {Words{},
                               {"--element", "hybrid8"},
                               {"--mesh", "4,60,4"},
                               {"--stiffness-ratio", "10"},
                               {"--cg-width", "10"},
                               {"--surface", "smooth"},
                               {"--metric", "deformed"},
                               {"--fem", "newmark"}}) {
    SCOPED_TRACE(variant.empty() ? "" : variant.back());
    Words words = variant;
    words.insert(words.end(), {"--dt-fraction", "0.99"});
    const RunFigures f = runUntil(0.5, words).figures;
    EXPECT_TRUE(f.stable) << f.failure << ", energy over available " << f.largestExcess;
    EXPECT_DOUBLE_EQ(f.dt, 0.99 * f.criticalDt);
  }
}

TEST(CriticalStep, TwiceTheLimitBreaksDownAtOnceAndSaysWhereAndWhen) {
  for (const char* element : {"hex8", "hybrid8"}) {
    RunResult result = runUntil(10.0, {"--dt-fraction", "2", "--insist", "--element", element});
    const RunFigures& f = result.figures;
    EXPECT_FALSE(f.finished || f.stable);
    const bool names =
        contains(f.failure, "particle ") || contains(f.failure, "node ") || contains(f.failure, "element ");
    EXPECT_TRUE(names) << f.failure;
    EXPECT_TRUE(contains(f.failure, "t = "));
    EXPECT_TRUE(contains(f.failure, "step "));
    EXPECT_LT(f.endTime, 1.0);
    EXPECT_GT(f.steps, 0);
    ASSERT_FALSE(result.samples.empty());  // the state so far
    EXPECT_NO_THROW(compare(result));
  }
}

TEST(Settings, TheLockingFactorIsThatOfTheMesh) {
  const auto factor = [](const Words& words) { return lockingFactor(settingsOf(words)); };
  EXPECT_DOUBLE_EQ(factor({}), 1.125);  // 1 + 1/(2 n²) for n = 2 cubes
  EXPECT_DOUBLE_EQ(factor({"--refine", "2"}), 1.03125);
  EXPECT_DOUBLE_EQ(factor({"--mesh", "2,15,1"}), 1.5);
  EXPECT_DOUBLE_EQ(factor({"--mesh", "2,30,1"}), 1.125);  // bricks half as long as high
  EXPECT_EQ(factor({"--mesh", "2,30,1", "--element", "hybrid8"}), 1.0);
}

TEST(Settings, TheCappedStepIsAThirdOfTheCriticalOnAFineMesh) {
  const Settings settings = settingsOf({}), asked = settingsOf({"--dt-factor", "0.05"});
  const double wanted = settings.dtFactor * contactTime();
  EXPECT_EQ(chooseStep(settings, {4.0 * wanted, "an element"}), wanted);
  EXPECT_EQ(chooseStep(settings, {1.5 * wanted, "an element"}), 0.5 * wanted);
  EXPECT_THROW(chooseStep(asked, {0.3 * wanted, "an element"}), InputError);
}

TEST(Settings, TheContactTimeIsThatOfThePaper) { EXPECT_NEAR(contactTime(), 4.5465e-3, 5e-8); }

}  // namespace
}  // namespace dovetail::cantilever
