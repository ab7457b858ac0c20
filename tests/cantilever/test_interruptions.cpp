// Runs that are stopped: what they leave, and how they say so.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "dovetail/io/time_series.hpp"
#include "program.hpp"

namespace dovetail::cantilever {
namespace {

using io::test::readText;
using io::test::ScratchFolder;
using test::Outcome;
using test::Running;
using test::runProgram;

using Words = std::vector<std::string>;

/// A folder that holds a complete run, and another one into it that would take hours.
struct Scene {
  ScratchFolder folder;
  std::filesystem::path out = folder / "out", summary = folder / "summary.json";

  Words words(const std::string& until) const {
    return {"--until", until,        "--output-interval", "0.02",          "--quiet",
            "--out",   out.string(), "--summary",         summary.string()};
  }
  Scene() { EXPECT_EQ(runProgram(words("0.5")).code, 0); }

  double endOfSeries() const { return io::readCsv(out / "series.csv").column("time_s").back(); }
  double lastFrame() const {
    const std::string pvd = readText(out / "beam.pvd");
    const std::string mark = "timestep=\"";
    return std::stod(pvd.substr(pvd.rfind(mark) + mark.size()));
  }
  std::set<std::string> leftovers() const {
    std::set<std::string> names;
    for (const std::string& name : folder.content())
      if (name.find(".part-") != std::string::npos) names.insert(name);
    return names;
  }
};

TEST(Interruption, EndsARunInOrder) {
  for (const auto& [signal, code, name] : {std::tuple{SIGINT, 130, "SIGINT"}, {SIGTERM, 143, "SIGTERM"}}) {
    const Scene scene;
    Running run(scene.words("9000"));
    ASSERT_TRUE(run.awaits(scene.out / "series.csv", "until_s: 9000"));
    run.signal(signal);
    const Outcome outcome = run.outcome();
    EXPECT_EQ(outcome.code, code);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(std::string("interrupted by ") + name), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("t = "), std::string::npos) << outcome.err;
    const auto summary = nlohmann::json::parse(readText(scene.summary)), json = summary.at("results");
    EXPECT_EQ(json.at("finished"), false);
    EXPECT_EQ("cantilever: " + json.at("failure").get<std::string>() + "\n", outcome.err);
    EXPECT_EQ(summary.at("settings").at("until_s"), "9000");
    EXPECT_EQ(scene.endOfSeries(), json.at("end_time_s").get<double>());
    if (TEST_WITH_VTK) {
      EXPECT_EQ(scene.lastFrame(), json.at("end_time_s").get<double>());
    }
    if (TEST_WITH_HDF5) {
      EXPECT_NE(readText(scene.out / "series.h5").find("9000"), std::string::npos);
    }
    EXPECT_NE(readText(scene.out / "series.csv").find("# setting.mesh: 2,30,2\n"), std::string::npos);
    EXPECT_LT(json.at("ledger_residual_relative").get<double>(), 1e-3);
    EXPECT_TRUE(scene.leftovers().empty());
  }
}

TEST(Interruption, AKilledRunLeavesItsSeriesAndNoneOfAnEarlierRun) {
  const Scene scene;
  Running run(scene.words("9000"));
  ASSERT_TRUE(run.awaits(scene.out / "series.csv", "until_s: 9000"));
  ASSERT_TRUE(run.awaits(scene.out / "series.csv", "\n0.04"));
  run.signal(SIGKILL);
  EXPECT_EQ(run.outcome().code, -1);
  EXPECT_NE(readText(scene.out / "series.csv").find("until_s: 9000"), std::string::npos);
  if (TEST_WITH_VTK) {
    EXPECT_GE(scene.endOfSeries(), scene.lastFrame());
  }
  EXPECT_GT(scene.endOfSeries(), 0.03);
  EXPECT_FALSE(std::filesystem::exists(scene.summary));
  EXPECT_FALSE(std::filesystem::exists(scene.out / "series.h5"));
  EXPECT_EQ(runProgram(scene.words("0.05")).code, 0);
}

TEST(Interruption, OneRunAtATimeWritesIntoAFolder) {
  const Scene scene;
  Running run(scene.words("9000"));
  ASSERT_TRUE(run.awaits(scene.out / "series.csv", "until_s: 9000"));
  const Outcome second = runProgram(scene.words("0.05"));
  EXPECT_EQ(second.code, 2);
  EXPECT_NE(second.err.find("another run"), std::string::npos) << second.err;
  EXPECT_NE(readText(scene.out / "series.csv").find("until_s: 9000"), std::string::npos);
}

TEST(Interruption, AStudyKeepsTheRunsThatAreDone) {
  const ScratchFolder folder;
  Running study({"--study", "ablation", "--until", "0.5", "--quiet", "--out", folder.path().string()});
  ASSERT_TRUE(study.awaits(folder / "ablation.json", "label"));
  study.signal(SIGTERM);
  const Outcome outcome = study.outcome();
  EXPECT_EQ(outcome.code, 143);
  EXPECT_NE(outcome.err.find("interrupted by SIGTERM"), std::string::npos) << outcome.err;
  const auto json = nlohmann::json::parse(readText(folder / "ablation.json"));
  EXPECT_LT(json.at("runs").size(), 20u);
  for (const auto& entry : json.at("runs")) EXPECT_EQ(entry.at("outcome"), "finished");
}

}  // namespace
}  // namespace dovetail::cantilever
