// dovetail calibrate as its users call it.
#include <gtest/gtest.h>

#include "../cantilever/program.hpp"

namespace dovetail::calibration {
namespace {

using cantilever::test::Outcome;
using cantilever::test::runProgram;
using io::test::readText;
using io::test::ScratchFolder;

const std::string file = std::string(SCENES) + "/calibration/stiffness.json";

TEST(CalibrateProgram, FitsAndWritesItsFiles) {
  const ScratchFolder folder;
  const Outcome outcome = runProgram({"calibrate", file, "--out", (folder / "out").string()});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("converged"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("evaluation 1, lattice"), std::string::npos) << outcome.err;
  for (const char* const name : {"calibration.json", "calibration.txt", "evaluations.json"})
    EXPECT_NE(readText(folder / "out" / name).find("commit"), std::string::npos) << name;
}

TEST(CalibrateProgram, RefusesInOneLine) {
  const ScratchFolder folder;
  const std::string out = (folder / "out").string();
  for (const auto& [words, part] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"calibrate"}, "FILE"},
           {{"calibrate", file, "--set", "targets.0.of=x", "--out", out}, "no experiment"},
           {{"calibrate", file, "--set", "parameters.0.key=contact.stifness", "--out", out}, "stifness"},
           {{"calibrate", file, "--rehearse", "0", "--out", out}, "--rehearse"}}) {
    const Outcome outcome = runProgram(words);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
}

}  // namespace
}  // namespace dovetail::calibration
