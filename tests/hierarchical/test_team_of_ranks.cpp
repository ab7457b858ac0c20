// Ranks that have served a farm and become a team. All run the tests; the first one tells.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/team.hpp"
#include "dovetail/hierarchical/farm.hpp"
#include "dovetail/linalg/partition.hpp"

namespace dovetail::hierarchical {
namespace {

TEST(TeamOfRanks, SumsAreTheSameOnAll) {
  std::vector<double> values(1000);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = std::sin(double(k) + team().rank());
  team().sum(values);
  const auto* const bytes = reinterpret_cast<const char*>(values.data());
  for (const std::vector<char>& other : team().gather({bytes, bytes + values.size() * sizeof(double)}))
    EXPECT_TRUE(std::equal(other.begin(), other.end(), bytes));
  double expected = 0.0;
  for (int rank = 0; rank < team().size(); ++rank) expected += std::sin(10.0 + rank);
  EXPECT_NEAR(values[10], expected, 1e-14);
  EXPECT_EQ(team().largest(team().rank()), team().size() - 1);
}

TEST(TeamOfRanks, LettersGoToWhomTheyAreFor) {
  std::vector<std::vector<char>> letters;
  for (int to = 0; to < team().size(); ++to)  // of different lengths, to oneself none
    letters.emplace_back(to == team().rank() ? 0 : 3 * to + 1, static_cast<char>(team().rank()));
  letters = team().exchange(std::move(letters));
  ASSERT_EQ(letters.size(), static_cast<std::size_t>(team().size()));
  for (int from = 0; from < team().size(); ++from)
    EXPECT_EQ(letters[static_cast<std::size_t>(from)],
              std::vector<char>(from == team().rank() ? 0 : static_cast<std::size_t>(3 * team().rank() + 1),
                                static_cast<char>(from)));
}

TEST(TeamOfRanks, WhatFailsOnOneFailsOnAll) {
  const int last = team().size() - 1;
  try {
    together([&] {
      if (team().rank() == last) throw NumericalError("element 7 is inverted", "here", "");
    });
    ADD_FAILURE() << "it went on";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("element 7"), std::string::npos);
    if (team().size() > 1) {
      EXPECT_NE(std::string(error.what()).find("rank " + std::to_string(last)), std::string::npos);
    }
  }
}

TEST(TeamOfRanks, TheFirstOneWritesFiles) { EXPECT_EQ(writesFiles(), team().rank() == 0); }

TEST(TeamOfRanks, CutsAreBalancedAndTheSameAgain) {
  constexpr int n = 12;
  std::vector<int> corners;
  const auto node = [](int i, int j) { return i + (n + 1) * j; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      for (const int corner : {node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)})
        corners.push_back(corner);
  const std::vector<int> owner = linalg::partitionCells(2, (n + 1) * (n + 1), 4, corners);
  EXPECT_EQ(owner, linalg::partitionCells(2, (n + 1) * (n + 1), 4, corners));
  for (int rank = 0; rank < team().size(); ++rank)
    EXPECT_LE(static_cast<double>(std::count(owner.begin(), owner.end(), rank)), 1.1 * n * n / team().size());
}

TEST(TeamOfRanks, KeepsNoFarm) { EXPECT_EQ(ranksOfFarm(), 1); }

}  // namespace
}  // namespace dovetail::hierarchical

int main(int argc, char** argv) {
  if (dovetail::hierarchical::serveFarm()) return 0;
  dovetail::hierarchical::formTeam();
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
