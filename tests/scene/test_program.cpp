// The program dovetail as its users call it.
#include <gtest/gtest.h>

#include <fstream>

#include "../cantilever/program.hpp"

namespace dovetail::scene {
namespace {

using cantilever::test::Outcome;
using cantilever::test::runProgram;
using io::test::readText;
using io::test::ScratchFolder;

std::string starter(const std::string& name) { return std::string(SCENES) + "/" + name + ".json"; }

void expectRefused(const Outcome& outcome, const std::string& part) {
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(outcome.err.starts_with("dovetail: ")) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
}

struct Shortened {
  const char *name, *time;
};
class Starters : public testing::TestWithParam<Shortened> {};

TEST_P(Starters, RunAndCloseTheirBooks) {
  const auto& [name, time] = GetParam();
  const ScratchFolder folder;
  std::vector<std::string> words{
      "run", starter(name), "--set", std::string("time=") + time, "--out", (folder / "out").string()};
  if (!WITH_FRAMES) words.insert(words.end(), {"--set", "output={\"series\": \"1 ms\"}"});
  const Outcome outcome = runProgram(words);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("residual over all impulses"), std::string::npos) << outcome.out;
  const std::string summary = readText(folder / "out/summary.txt"), series = readText(folder / "out/series.csv");
  for (const std::string& text : {summary, series, readText(folder / "out/scene.json")}) {
    EXPECT_NE(text.find("setting.scene: "), std::string::npos);
    EXPECT_NE(text.find("commit: "), std::string::npos);
  }
  EXPECT_EQ(std::filesystem::exists(folder / "out/grains.pvd"), WITH_FRAMES != 0);
  for (const char* file : {"out", "out/series.csv", "out/scene.json"})
    EXPECT_EQ(runProgram({"info", (folder / file).string()}).code, 0) << file;
}
INSTANTIATE_TEST_SUITE_P(All, Starters,
                         testing::Values(Shortened{"footing", "5e-4"}, Shortened{"pile", "0.01"},
                                         Shortened{"plate", "2e-4"}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Program, ChecksWithoutAFile) {
  const Outcome outcome = runProgram({"check", starter("plate")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* part : {"44 particles", "solid \"plate\": 315 nodes", "at most", "windows", "MiB"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << " in\n" << outcome.out;
}

TEST(Program, RefusesInOneLine) {
  const ScratchFolder folder;
  const std::string out = (folder / "out").string();
  expectRefused(runProgram({}), "subcommand");
  expectRefused(runProgram({"rum"}), "no verb 'rum'");
  expectRefused(runProgram({"run"}), "SCENE");
  expectRefused(runProgram({"run", starter("plate"), "--ot", out}), "--ot");
  expectRefused(runProgram({"check", (folder / "none.json").string()}), "cannot be read");
  expectRefused(runProgram({"check", starter("plate"), "--set", "steps.tt=1"}), "steps");
  expectRefused(runProgram({"run", starter("plate"), "--set", "steps.dt=1 ms", "--out", out}), "element 132");
  expectRefused(runProgram({"run", starter("plate"), "--set", "solids.0.name=a b", "--out", out}), "name");
  expectRefused(runProgram({"run", starter("plate"), "--set", "couplings.0.solid=pate", "--out", out}),
                "write \"plate\"");
  expectRefused(runProgram({"run", starter("plate"), "--set", "couplings.0.on=top", "--out", out}), "couplings.0");
  expectRefused(runProgram({"resume", folder.path().string()}), "no folder of a run");
  expectRefused(runProgram({"info", (folder / "none").string()}), "no such file");
  expectRefused(runProgram({"new", "plait"}), "plait");
  EXPECT_FALSE(std::filesystem::exists(folder / "out/series.csv"));
}

TEST(Program, StarterScenesAreWrittenOnceAndChecked) {
  const ScratchFolder folder;
  const std::string file = (folder / "mine.json").string();
  EXPECT_EQ(runProgram({"new", "plate", file}).code, 0);
  EXPECT_EQ(runProgram({"check", file}).code, 0);
  expectRefused(runProgram({"new", "plate", file}), "a file of this name");
}

TEST(Program, OtherPeoplesFilesStay) {
  const ScratchFolder folder;
  std::ofstream(folder / "summary.txt") << "mine";
  expectRefused(runProgram({"run", starter("plate"), "--out", folder.path().string()}), "summary.txt");
  EXPECT_EQ(readText(folder / "summary.txt"), "mine");
}

}  // namespace
}  // namespace dovetail::scene
