// dovetail cell as its users call it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "../cantilever/program.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::rve {
namespace {

using cantilever::test::Outcome;
using cantilever::test::runProgram;
using io::test::readText;
using io::test::ScratchFolder;

const std::string biaxial = std::string(SCENES) + "/cells/biaxial.json";

/// The shipped file with fewer discs and smaller strains.
std::vector<std::string> small(const std::string& out) {
  std::vector<std::string> words{"cell", biaxial, "--out", out};
  for (const char* const change : {"cells.0.count=64", "cells.0.number=3", "drive.0.strain=0.01", "drive.0.outputs=10",
                                   "drive.1.strain=0.01", "drive.1.outputs=10"})
    words.insert(words.end(), {"--set", change});
  return words;
}

TEST(CellProgram, MakesCellsAndTestsThem) {
  const ScratchFolder folder;
  std::vector<std::string> words = small((folder / "out").string());
  words.insert(words.end(), {"--show", "fabric_yy"});
  const Outcome outcome = runProgram(words);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("solid fraction"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("largest stress ratio"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("3 made in"), std::string::npos) << outcome.err;
  const std::string page = readText(folder / "out" / "report.md");
  EXPECT_NE(page.find("report_drained_fabric_yy.svg"), std::string::npos) << page;
  const io::TimeSeries mean = io::readCsv(folder / "out" / "drained.csv"),
                       cells = io::readCsv(folder / "out" / "drained_cells.csv");
  ASSERT_EQ(mean.rows(), 11u);
  ASSERT_EQ(cells.rows(), 33u);
  EXPECT_EQ(mean.column("strain").back(), 0.01);
  for (std::size_t row = 0; row < 33; ++row) EXPECT_NEAR(cells.column("sigma_xx_Pa")[row], -150e3, 150.0);
  for (std::size_t row = 0; row < 11; ++row)
    EXPECT_NEAR(mean.column("sigma_yy_Pa")[row],
                (cells.column("sigma_yy_Pa")[row] + cells.column("sigma_yy_Pa")[row + 11] +
                 cells.column("sigma_yy_Pa")[row + 22]) /
                    3.0,
                1e-6);
  const io::TimeSeries undrained = io::readCsv(folder / "out" / "undrained_cells.csv");
  for (const double volume : undrained.column("volumetric_strain")) EXPECT_NEAR(volume, 0.0, 1e-12);
}

TEST(CellProgram, CellsAreUsedAgainAndThreadsChangeNoDigit) {
  const ScratchFolder folder;
  const auto curvesOn = [&](const char* threads, const std::string& out) {
    ::setenv("OMP_NUM_THREADS", threads, 1);
    const Outcome outcome = runProgram(small((folder / out).string()));
    ::unsetenv("OMP_NUM_THREADS");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::string text = readText(folder / out / "drained_cells.csv");
    return std::pair(outcome.err, text.substr(text.find("\ncell,")));
  };
  const auto [firstLog, first] = curvesOn("1", "one");
  const auto [againLog, again] = curvesOn("2", "one");
  const auto [otherLog, other] = curvesOn("2", "two");
  EXPECT_NE(firstLog.find("made"), std::string::npos) << firstLog;
  EXPECT_NE(againLog.find("their inputs are unchanged"), std::string::npos) << againLog;
  EXPECT_NE(otherLog.find("made"), std::string::npos) << otherLog;
  EXPECT_EQ(first, again);
  EXPECT_EQ(first, other);
}

TEST(CellProgram, RefusesInOneLine) {
  const ScratchFolder folder;
  const std::string out = (folder / "out").string();
  for (const auto& [words, part] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"cell"}, "FILE"},
           {{"cell", biaxial, "--show", "fabric_yx", "--out", out}, "fabric_xx"},
           {{"cell", biaxial, "--set", "drive.0.strian=0.1", "--out", out}, "strain"},
           {{"cell", biaxial, "--set", "drive.0.do=triaxial", "--out", out}, "biaxial"},
           {{"cell", biaxial, "--set", "drive.0.cells=dics", "--out", out}, "discs"},
           {{"cell", biaxial, "--set", "drive.1.name=drained", "--out", out}, "two tests"},
           {{"cell", biaxial, "--set", "drive.1.do=isotropic", "--out", out}, "constant volume"},
           {{"cell", biaxial, "--set", "drive.0.back_to=0.2", "--out", out}, "larger strain"}}) {
    const Outcome outcome = runProgram(words);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
}

TEST(CellProgram, PrintsItsKeys) {
  for (const char* const option : {"--keys", "--schema"}) {
    const Outcome outcome = runProgram({"cell", option});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("constant_volume"), std::string::npos);
  }
}

}  // namespace
}  // namespace dovetail::rve
