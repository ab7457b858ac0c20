// Coupled scenes of elements, materials, couplings, contact laws and macro steps that hold every pair of these.
#include <gtest/gtest.h>

#include <set>

#include "matrix_figures.hpp"

namespace dovetail::coupling_matrix {
namespace {

TEST(Cases, OfThePairwiseSetHoldEveryPair) {
  std::set<std::array<int, 4>> pairs;
  for (const Case& c : pairwiseCases()) {
    const auto level = levelsOf(c);
    EXPECT_EQ(levelsOf(caseOf(level)), level);
    for (int a = 0; a < static_cast<int>(factors); ++a)
      for (int b = a + 1; b < static_cast<int>(factors); ++b)
        pairs.insert({a, level[static_cast<std::size_t>(a)], b, level[static_cast<std::size_t>(b)]});
  }
  std::size_t all = 0;
  for (std::size_t a = 0; a < factors; ++a)
    for (std::size_t b = a + 1; b < factors; ++b) all += static_cast<std::size_t>(levels[a] * levels[b]);
  EXPECT_EQ(pairs.size(), all);
  EXPECT_LE(pairwiseCases().size(), 30u);
  EXPECT_EQ(allCases().size(), 720u);
}

class Matrix : public testing::TestWithParam<Case> {};

TEST_P(Matrix, TheBooksCloseAndDigitsStay) {
  const Figures figures = measure(GetParam(), 160);
  EXPECT_EQ(figures.refused, "");
  EXPECT_EQ(shortfall(GetParam(), figures), "");
}

/// Runs in which particles are located anew: fractions of contacts at walls change with those of the particles, and in
/// macro steps of several steps ties are made where solid and particles are at the same instant.
TEST(MatrixLong, TheBooksCloseWhereTiesAreMadeAnew) {
  for (const MacroSteps macroSteps : {MacroSteps::explicit1, MacroSteps::implicit1, MacroSteps::implicit4})
    for (const Joint joint : {Joint::penalty, Joint::multipliers})
      for (const ContactKind contact : {ContactKind::frictional, ContactKind::hertzMindlin, ContactKind::rolling}) {
        const Case c{Element::hex8, SolidLaw::stVenantKirchhoff, joint, contact, macroSteps};
        const Figures figures = measure(c, 640);
        EXPECT_EQ(shortfall(c, figures), "") << nameOf(c);
      }
}

/// Soil that is pulled up again flows at its apex, where it has no stiffness, in some points of an element.
TEST(MatrixLong, EnhancedBricksOfSoilFindTheirModesUnderGrains) {
  const Case c{Element::enhanced, SolidLaw::druckerPrager, Joint::surface, ContactKind::rolling, MacroSteps::explicit1};
  EXPECT_EQ(shortfall(c, measure(c, 400)), "");
}

std::string testName(const testing::TestParamInfo<Case>& c) {
  std::string name = nameOf(c.param);
  std::erase(name, '-');
  for (char& letter : name)
    if (letter == ' ') letter = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Pairs, Matrix, testing::ValuesIn(pairwiseCases()), testName);

}  // namespace
}  // namespace dovetail::coupling_matrix
