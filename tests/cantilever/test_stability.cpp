#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "model.hpp"
#include "short_run.hpp"

namespace dovetail::cantilever {
namespace {

using test::refusal;
using test::shortSettings;
using ::testing::AssertionResult;

AssertionResult contains(const std::string& text, const std::string& part) {
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
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t i = 0; i < a.samples.size(); ++i)
    for (int p = 0; p < 2; ++p) EXPECT_EQ(norm(a.samples[i].x[p] - b.samples[i].x[p]), 0.0);
  EXPECT_EQ(a.figures.energyDrift, b.figures.energyDrift);
  EXPECT_EQ(a.figures.momentResidual, b.figures.momentResidual);
}

TEST(Repeatability, ThreadsAndRepetitionDoNotChangeABit) {
  for (double width : {0.0, 6.0})
    for (Surface surface : {Surface::flat, Surface::smooth}) {
      SCOPED_TRACE(testing::Message() << "width " << width << ", surface " << static_cast<int>(surface));
      Settings settings = shortSettings(0.25);
      settings.cgWidth = width;
      settings.surface = surface;
      const RunResult one = run(settings), again = run(settings);
      settings.threads = 2;
      const RunResult two = run(settings);
      expectSameBits(one, again);
      expectSameBits(one, two);
    }
}

TEST(Repeatability, AnObserverSeesTheRunAndDoesNotChangeIt) {
  Settings settings = shortSettings(0.3);
  settings.outputInterval = 0.05;
  std::vector<double> times;
  const RunResult watched = run(settings, [&](const Frame& frame) {
    times.push_back(frame.time);
    EXPECT_EQ(frame.particles.size(), 2u);
    EXPECT_EQ(frame.cellScalars.at(0).second.size(), frame.mesh->elementCount());
    EXPECT_EQ(frame.nodeVectors.at(0).second.size(), frame.nodes->X.size());
  });
  expectSameBits(watched, run(settings));
  ASSERT_GE(times.size(), 6u);
  EXPECT_EQ(times.front(), 0.0);
  for (std::size_t i = 1; i < times.size(); ++i) EXPECT_NEAR(times[i] - times[i - 1], 0.05, 1e-3);
}

TEST(Repeatability, AnEndlessIntervalBetweenFramesShowsTheStartOnly) {
  Settings settings = shortSettings(0.02);
  settings.outputInterval = 1e300;
  int frames = 0;
  run(settings, [&](const Frame&) { ++frames; });
  EXPECT_EQ(frames, 1);
}

TEST(CriticalStep, AboveItTheRunIsRefusedWithTheLimitAndItsCause) {
  Settings settings = shortSettings(0.01);
  settings.dtFactor = 5.0;
  std::string message = refusal(settings);
  EXPECT_TRUE(contains(message, "--dt-factor 5"));
  EXPECT_TRUE(contains(message, "element "));
  EXPECT_TRUE(contains(message, "give at most 0."));
  EXPECT_TRUE(contains(message, "--dt auto"));
  settings.fem = FemStepper::newmark;
  EXPECT_TRUE(contains(refusal(settings), "contact of a particle with the skin"));
  settings.fem = FemStepper::explicitDifferences;
  settings.dtFactor = 0.05;
  settings.femEvery = 1000;
  EXPECT_TRUE(contains(refusal(settings), "stepped every 1000"));
}

TEST(CriticalStep, TheLimitThatTheMessageGivesIsTaken) {
  for (double width : {0.0, 10.0}) {
    Settings settings = shortSettings(0.01);
    settings.cgWidth = width;
    settings.dtFactor = 5.0;
    const std::string message = refusal(settings), before = "give at most ";
    ASSERT_TRUE(contains(message, before));
    settings.dtFactor = std::stod(message.substr(message.find(before) + before.size()));
    EXPECT_EQ(refusal(settings), "");
    settings.dtFactor *= 1.002;
    EXPECT_NE(refusal(settings), "");
  }
}

TEST(CriticalStep, JustBelowItEveryVariantIsStable) {
  const auto check = [](const char* name, auto change) {
    SCOPED_TRACE(name);
    Settings settings = shortSettings(0.5);
    settings.shareOfCritical = 0.99;
    change(settings);
    const RunFigures f = run(settings).figures;
    EXPECT_TRUE(f.stable) << f.failure << ", energy over available " << f.largestExcess;
    EXPECT_DOUBLE_EQ(f.dt, 0.99 * f.criticalDt);
  };
  check("hex8", [](Settings&) {});
  check("hybrid8", [](Settings& s) { s.element = "hybrid8"; });
  check("fine mesh", [](Settings& s) { s.mesh = {4, 60, 4}; });
  check("stiff contact", [](Settings& s) { s.stiffnessRatio = 10.0; });
  check("wide kernel", [](Settings& s) { s.cgWidth = 10.0; });
  check("smooth", [](Settings& s) { s.surface = Surface::smooth; });
  check("deformed metric", [](Settings& s) { s.metric = Metric::deformed; });
  check("implicit beam", [](Settings& s) { s.fem = FemStepper::newmark; });
}

TEST(CriticalStep, TwiceTheLimitBreaksDownAtOnceAndSaysWhereAndWhen) {
  Settings settings = shortSettings(10.0);
  settings.shareOfCritical = 2.0;
  settings.beyondCritical = true;
  for (const char* element : {"hex8", "hybrid8"}) {
    settings.element = element;
    const RunResult result = run(settings);
    const RunFigures& f = result.figures;
    EXPECT_FALSE(f.finished);
    EXPECT_FALSE(f.stable);
    const bool names =
        contains(f.failure, "particle ") || contains(f.failure, "node ") || contains(f.failure, "element ");
    EXPECT_TRUE(names) << f.failure;
    EXPECT_TRUE(contains(f.failure, "t = "));
    EXPECT_TRUE(contains(f.failure, "step "));
    EXPECT_LT(f.endTime, 1.0);
    EXPECT_GT(f.steps, 0);
    EXPECT_GT(f.wallSeconds, 0.0);
    ASSERT_FALSE(result.samples.empty());  // the state so far
  }
}

TEST(CriticalStep, ABrokenRunCanBeComparedAllTheSame) {
  Settings settings = shortSettings(10.0);
  settings.shareOfCritical = 2.0;
  settings.beyondCritical = true;
  RunResult result = run(settings);
  EXPECT_NO_THROW(compare(result));
}

TEST(Settings, TheLockingFactorIsThatOfTheMesh) {
  Settings settings;
  EXPECT_DOUBLE_EQ(lockingFactor(settings), 1.125);  // 1 + 1/(2 n²) for n = 2 cubes
  settings.refine = 2;
  EXPECT_DOUBLE_EQ(lockingFactor(settings), 1.03125);
  settings.refine = 1;
  settings.mesh = {2, 15, 1};
  EXPECT_DOUBLE_EQ(lockingFactor(settings), 1.5);
  settings.mesh = {2, 30, 1};  // bricks half as long as high
  EXPECT_DOUBLE_EQ(lockingFactor(settings), 1.125);
  settings.element = "hybrid8";
  EXPECT_EQ(lockingFactor(settings), 1.0);
}

TEST(Settings, ImpossibleOnesAreRefusedByTheirOptions) {
  const auto check = [](const char* option, auto change) {
    Settings settings = shortSettings(0.01);
    change(settings);
    EXPECT_TRUE(contains(refusal(settings), option));
  };
  check("--element", [](Settings& s) { s.element = "hex20"; });
  check("--mesh", [](Settings& s) { s.mesh = {2000, 2000, 2000}; });
  check("--restitution", [](Settings& s) { s.restitution = 0.0; });
  check("--output-interval", [](Settings& s) { s.outputInterval = 0.0; });
  check("--kernel-correction", [](Settings& s) {
    s.transfer = Transfer::spread;
    s.correction = Correction::symmetric;
  });
  check("--surface", [](Settings& s) {
    applyScheme(s, Scheme::paper);
    s.transfer = Transfer::adjoint;
    s.surface = Surface::smooth;
  });
}

TEST(Settings, TheCappedStepIsAThirdOfTheCriticalOnAFineMesh) {
  Settings settings;
  settings.dtCapped = true;
  const double wanted = settings.dtFactor * contactTime(Case{});
  EXPECT_EQ(chooseStep(settings, {4.0 * wanted, "an element"}), wanted);
  EXPECT_EQ(chooseStep(settings, {1.5 * wanted, "an element"}), 0.5 * wanted);
  EXPECT_EQ(chooseStep(settings, {0.3 * wanted, "an element"}), 0.1 * wanted);
  settings.dtCapped = false;
  EXPECT_THROW(chooseStep(settings, {0.3 * wanted, "an element"}), InputError);
}

TEST(Settings, TheConservativeSchemeUndoesThePapers) {
  Settings settings;
  applyScheme(settings, Scheme::paper);
  EXPECT_NE(describe(settings), describe(Settings{}));
  EXPECT_TRUE(couplingIsUnbalanced(settings));
  applyScheme(settings, Scheme::conservative);
  EXPECT_EQ(describe(settings), describe(Settings{}));
  EXPECT_FALSE(couplingIsUnbalanced(settings));
}

TEST(Settings, TheContactTimeIsThatOfThePaper) { EXPECT_NEAR(contactTime(Case{}), 4.5465e-3, 5e-8); }

}  // namespace
}  // namespace dovetail::cantilever
