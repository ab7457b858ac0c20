#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.hpp"

namespace dovetail::cantilever {
namespace {

using io::test::readText;
using io::test::ScratchFolder;
using test::everyByte;
using test::Outcome;
using test::runProgram;

const char* const everyOption =
    "--scheme --cg-width --kernel --kernel-correction --surface --element --mesh --refine "
    "--dt-factor --dt --dt-fraction --insist --fem --fem-every --until --stiffness-ratio --threads "
    "--out --output-interval --summary --study --reference --profile --workers --quiet --help "
    "--lag --transfer --edges --metric --mass --restitution ";

TEST(Program, HelpListsEveryOption) {
  for (const char* word : {"--help", "-h"}) {
    const Outcome outcome = runProgram({word});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, "");
    std::istringstream options(everyOption);
    for (std::string option; options >> option;) {
      const bool listed = outcome.out.find(" " + option + " ") != std::string::npos ||
                          outcome.out.find("," + option + " ") != std::string::npos;
      EXPECT_TRUE(listed) << option << " in\n" << outcome.out;
    }
  }
}

void expectSummary(const std::filesystem::path& file) {
  const auto summary = nlohmann::json::parse(readText(file));
  const auto& json = summary.at("results");
  for (const char* key : {"steps", "wall_seconds", "seconds_per_step", "energy_initial_J", "energy_min_J",
                          "energy_max_J", "energy_drift_relative", "ledger_residual_relative", "lateral_drift_m",
                          "moment_residual_relative", "time_mean_error_m", "no_contact_fraction"}) {
    ASSERT_TRUE(json.contains(key)) << key;
    EXPECT_TRUE(json[key].is_number()) << key << ": " << json[key];
  }
  ASSERT_TRUE(json.contains("leave_time_s"));
  EXPECT_TRUE(json["leave_time_s"].is_null());                  // has not left
  EXPECT_TRUE(json.at("time_mean_error_dynamic_m").is_null());  // and so is not set beside the beam
  EXPECT_EQ(json.at("stable"), true);
  EXPECT_EQ(summary.at("settings").at("cg_width_diameters"), "2");
  EXPECT_EQ(summary.at("settings").at("scheme"), "conservative");
  for (const char* key : {"version", "commit", "compiler", "flags", "processor"})
    EXPECT_FALSE(summary.at("provenance").at(key).get<std::string>().empty()) << key;
  EXPECT_NEAR(json.at("energy_initial_J").get<double>(), 0.8716, 1e-3);
  EXPECT_EQ(summary.at("energy").at("channels").size(), 7u);
  EXPECT_FALSE(summary.at("times").at("parts").empty());
  EXPECT_EQ(summary.at("version"), 1);
}

/// One line of names below the provenance, then as many numbers in every row; times grow.
void expectSeries(const std::string& text) {
  std::istringstream stream(text);
  std::size_t commas = 0, rows = 0;
  double before = -1.0;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("#")) continue;
    const auto count = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
    if (commas == 0) {
      EXPECT_TRUE(line.starts_with("time_s,x1_m,y1_m,z1_m")) << line;
      commas = count;
      continue;
    }
    EXPECT_EQ(count, commas);
    const double time = std::stod(line);
    EXPECT_GT(time, before);
    before = time;
    ++rows;
  }
  EXPECT_GE(rows, 5u);  // every 0.02 s from 0 to 0.1
}

TEST(Program, AShortRunWritesItsFilesQuietlyAndAgainIntoTheSameFolder) {
  const ScratchFolder folder;
  const std::string out = (folder / "deep/out").string();
  const std::filesystem::path summary = folder / "deep/summary.json";
  for (int time = 0; time < 2; ++time) {
    const Outcome outcome = runProgram({"--until", "0.11", "--cg-width", "2", "--output-interval", "0.05", "--quiet",
                                        "--profile", "--out", out, "--summary", summary.string()});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
    expectSeries(readText(folder / "deep/out/series.csv"));
    expectSummary(summary);
    EXPECT_EQ(std::filesystem::exists(out + "/series.h5"), TEST_WITH_HDF5 == 1);
    for (const std::string name : {"beam", "particles"}) {
      EXPECT_EQ(std::filesystem::exists(out + "/" + name + ".pvd"), TEST_WITH_VTK == 1);
      if (!TEST_WITH_VTK) continue;
      const std::string pvd = readText(out + "/" + name + ".pvd");
      EXPECT_NE(pvd.find("timestep=\"0\""), std::string::npos) << pvd;
      EXPECT_NE(pvd.find("file=\"" + name + "/" + name + "_000002.vtu\""), std::string::npos) << pvd;
      EXPECT_TRUE(std::filesystem::exists(out + "/" + name + "/" + name + "_000002.vtu"));
    }
  }
  const auto before = everyByte(folder);
  const Outcome refused =
      runProgram({"--until", "0.1", "--dt-factor", "5", "--out", out, "--summary", summary.string()});
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(everyByte(folder), before) << "a refused run changed what an earlier one wrote";
}

TEST(Program, AContactTooStiffForTheBeamReferenceIsNoReasonToLoseTheRun) {
  const ScratchFolder folder;
  const std::string summary = (folder / "summary.json").string();
  const Outcome outcome =
      runProgram({"--stiffness-ratio", "1e4", "--dt", "auto", "--until", "0.05", "--summary", summary});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("Ledger at the end"), std::string::npos);
  EXPECT_TRUE(nlohmann::json::parse(readText(summary)).at("results").at("time_mean_error_dynamic_m").is_null());
}

TEST(Program, ABreakdownSaysWhereAndWhenAndKeepsWhatThereIs) {
  const ScratchFolder folder;
  const std::string summary = (folder / "summary.json").string();
  // A staggered, stiff contact on light nodes: unstable at any step that is worth taking.
  const Outcome outcome =
      runProgram({"--lag", "load-and-skin", "--stiffness-ratio", "1000", "--mesh", "8,60,8", "--dt", "auto", "--until",
                  "0.2", "--quiet", "--out", (folder / "out").string(), "--summary", summary});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  const bool names = outcome.err.find("element ") != std::string::npos ||
                     outcome.err.find("node ") != std::string::npos ||
                     outcome.err.find("particle ") != std::string::npos;
  EXPECT_TRUE(outcome.err.starts_with("cantilever: ") && names) << outcome.err;
  EXPECT_NE(outcome.err.find("t = "), std::string::npos) << outcome.err;
  const auto json = nlohmann::json::parse(readText(summary)).at("results");
  EXPECT_EQ(json.at("finished"), false);
  EXPECT_EQ(json.at("stable"), false);
  EXPECT_EQ("cantilever: " + json.at("failure").get<std::string>() + "\n", outcome.err);
  EXPECT_GT(json.at("wall_seconds").get<double>(), 0.0);
  EXPECT_LT(json.at("end_time_s").get<double>(), 0.2);
  EXPECT_FALSE(readText(folder / "out/series.csv").empty());
}

TEST(Program, AStudyWritesOneRowPerRun) {
  const ScratchFolder folder;
  const Outcome outcome =
      runProgram({"--study", "ablation", "--until", "0.02", "--quiet", "--out", folder.path().string()});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(folder.content(), (std::set<std::string>{"ablation.csv", "ablation.json", "ablation.md", "ablation.svg"}));
  const auto json = nlohmann::json::parse(readText(folder / "ablation.json"));
  ASSERT_EQ(json.at("runs").size(), 20u);
  for (const auto& entry : json["runs"]) EXPECT_EQ(entry.at("outcome"), "finished") << entry.at("label");
  const std::string csv = readText(folder / "ablation.csv");
  std::istringstream stream(csv);
  std::size_t lines = 0;
  for (std::string line; std::getline(stream, line);) lines += line.starts_with("#") ? 0 : 1;
  EXPECT_EQ(lines, 21u);
}

TEST(Program, AStudyReplacesItsOwnFilesHoweverLong) {
  const ScratchFolder folder;
  for (int i = 0; i < 2; ++i) {
    const Outcome outcome =
        runProgram({"--study", "pareto", "--until", "0.002", "--quiet", "--out", folder.path().string()});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
  EXPECT_GT(std::filesystem::file_size(folder / "pareto.json"), 64u * 1024u);
}

}  // namespace
}  // namespace dovetail::cantilever
