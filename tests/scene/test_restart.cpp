// Runs that were broken off go on to the same bytes.
#include <gtest/gtest.h>

#include "../cantilever/program.hpp"

namespace dovetail::scene {
namespace {

using cantilever::test::everyByte;
using cantilever::test::Running;
using cantilever::test::runProgram;
using io::test::ScratchFolder;

std::vector<std::string> words(const ScratchFolder& folder) {
  std::vector<std::string> all{"run",     std::string(SCENES) + "/pile.json", "--out", folder.path().string(), "--set",
                               "time=0.2"};
  const char* const output = WITH_FRAMES ? "output={\"series\": 2e-3, \"frames\": 0.02, \"checkpoints\": 0.02}"
                                         : "output={\"series\": 2e-3, \"checkpoints\": 0.02}";
  all.insert(all.end(), {"--set", output});
  return all;
}

/// All bytes but those of the summary, which tells times.
std::map<std::string, std::string> digits(const ScratchFolder& folder) {
  auto bytes = everyByte(folder);
  bytes.erase("summary.txt");
  bytes.erase("checkpoint.previous.state");
  return bytes;
}

/// Grains meet the clay, so that books get channels after the state that is gone on from.
void expectSameAfter(int signal, int code) {
  const ScratchFolder whole, broken;
  ASSERT_EQ(runProgram(words(whole)).code, 0);
  Running running(words(broken));
  ASSERT_TRUE(running.awaits(broken / "series.csv", "\n0.13"));
  running.signal(signal);
  const auto outcome = running.outcome();
  ASSERT_EQ(outcome.code, code) << outcome.err;
  EXPECT_NE(digits(broken), digits(whole)) << "the run had ended before the signal came";
  const auto resumed = runProgram({"resume", broken.path().string()});
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  const auto expected = digits(whole), found = digits(broken);
  for (const auto& [name, bytes] : expected) {
    ASSERT_TRUE(found.contains(name)) << name;
    EXPECT_TRUE(found.at(name) == bytes) << name;
  }
  EXPECT_EQ(found.size(), expected.size());
}

TEST(Restart, AfterAnInterruptionAllBytesAreTheSame) { expectSameAfter(SIGINT, 130); }
TEST(Restart, AfterAKillAllBytesAreTheSame) { expectSameAfter(SIGKILL, -1); }

TEST(Restart, AFolderServesAgainAndPartsOfStatesGo) {
  const ScratchFolder folder;
  const std::vector<std::string> run{
      "run",   std::string(SCENES) + "/plate.json", "--out", folder.path().string(), "--set", "time=1e-4",
      "--set", "output={\"checkpoints\": 5e-5}"};
  ASSERT_EQ(runProgram(run).code, 0);
  std::filesystem::copy_file(folder / "checkpoint.state", folder / "checkpoint.state.part-1-2");
  const auto again = runProgram(run);
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "checkpoint.state.part-1-2"));
  EXPECT_EQ(runProgram({"resume", folder.path().string()}).code, 0);
}

TEST(Restart, StatesOfOtherScenesAndDamagedOnesAreRefused) {
  const ScratchFolder folder;
  ASSERT_EQ(runProgram({"run", std::string(SCENES) + "/plate.json", "--out", folder.path().string(), "--set",
                        "time=1e-4", "--set", "output={\"checkpoints\": 5e-5}"})
                .code,
            0);
  const auto refusal = [&] {
    const auto outcome = runProgram({"resume", folder.path().string()});
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  std::string scene = io::test::readText(folder / "scene.json");
  const std::string state = io::test::readText(folder / "checkpoint.state");
  std::ofstream(folder / "scene.json") << scene.replace(scene.find("1000.0"), 6, "1001.0");
  EXPECT_NE(refusal().find("another scene"), std::string::npos);
  std::ofstream(folder / "checkpoint.state") << state.substr(0, state.size() / 2);
  EXPECT_NE(refusal().find("checkpoint.state"), std::string::npos);
}

}  // namespace
}  // namespace dovetail::scene
