#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "../cantilever/program.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::wave {
namespace {

using cantilever::test::everyByte;
using cantilever::test::Outcome;
using cantilever::test::runProgram;
using io::test::readText;
using io::test::ScratchFolder;

using Words = std::vector<std::string>;

const Words shortBar{"--dem-length", "4", "--overlap", "1.6", "--fem-length", "4", "--pulse-elements", "6"};

Outcome runShort(const Words& more) {
  Words words = shortBar;
  words.insert(words.end(), more.begin(), more.end());
  return runProgram(words);
}

nlohmann::json parsed(const std::filesystem::path& file) { return nlohmann::json::parse(readText(file)); }

const char* everyOption =
    "--particles-per-edge --dem-length --overlap --fem-length --constraint "
    "--gap --scheme --cg-width --kernel --penalty "
    "--weight-floor --weight-profile --signal --pulse-elements --omega "
    "--cycles --amplitude --tension --material --mass --dashpot-matrix "
    "--rows --kernel-normalisation --kernel-reach --order --absorber "
    "--full-dem --stiffness-ratio --density-ratio --dt-factor --dt "
    "--fem --fem-every --until --threads --out "
    "--output-interval --no-comparison --summary --study --reference "
    "--profile --quiet --workers --dt-fraction --insist --until-past ";

TEST(Program, HelpListsEveryOption) {
  for (const char* word : {"--help", "-h"}) {
    const Outcome outcome = runProgram({word});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, "");
    std::istringstream options(everyOption);
    for (std::string option; options >> option;)
      EXPECT_NE(outcome.out.find(" " + option + " "), std::string::npos) << option << " in\n" << outcome.out;
  }
}

void expectSummary(const nlohmann::json& summary) {
  const auto& json = summary.at("results");
  for (const char* key :
       {"steps", "wall_seconds", "seconds_per_step", "particles", "energy_input_J", "energy_final_J",
        "energy_lost_fraction", "energy_absorbed_fraction", "coupling_work_fraction", "ledger_residual_relative",
        "momentum_residual_relative", "mass_residual_relative", "waveform_error_fem", "waveform_error_dem",
        "reflected_energy_fraction", "speed_ratio_to_full_dem", "overlap_mismatch", "gap_max_m"}) {
    ASSERT_TRUE(json.contains(key)) << key;
    EXPECT_TRUE(json[key].is_number()) << key << ": " << json[key];
  }
  EXPECT_TRUE(json.at("paper_dissipated_fraction").is_null());  // not an impulse
  for (const char* part : {"particles", "solid", "together"})
    EXPECT_GT(json.at("critical_step_s").at(part).get<double>(), 0.0) << part;
  EXPECT_EQ(json.at("critical_step_set_by"), "the coupling");
  EXPECT_EQ(json.at("stable"), true);
  EXPECT_EQ(summary.at("settings").at("cg_width_elements"), "1");
  EXPECT_EQ(summary.at("settings").at("scheme"), "conservative");
  for (const char* key : {"version", "commit", "compiler", "flags", "processor"})
    EXPECT_FALSE(summary.at("provenance").at(key).get<std::string>().empty()) << key;
  EXPECT_EQ(summary.at("energy").at("channels").size(), 7u);
  EXPECT_FALSE(summary.at("times").at("parts").empty());
}

/// One line of names below the provenance, then as many numbers in every row.
void expectTable(const std::string& text, const std::string& names, std::size_t leastRows) {
  std::istringstream stream(text);
  std::size_t commas = 0, rows = 0;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("#")) continue;
    const auto count = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
    if (rows++ == 0) {
      EXPECT_TRUE(line.starts_with(names)) << line;
      commas = count;
    }
    EXPECT_EQ(count, commas);
  }
  EXPECT_GT(rows, leastRows);
}

TEST(Program, AShortRunWritesItsFilesQuietlyAndAgainIntoTheSameFolder) {
  const ScratchFolder folder;
  const std::string out = (folder / "deep/out").string();
  const std::filesystem::path summary = folder / "deep/summary.json";
  for (int time = 0; time < 2; ++time) {
    const Outcome outcome = runShort({"--cg-width", "1", "--output-interval", "0.005", "--quiet", "--profile", "--out",
                                      out, "--summary", summary.string()});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
    expectTable(readText(folder / "deep/out/series.csv"), "time_s,mass_particles_kg,", 20);
    expectTable(readText(folder / "deep/out/profile.csv"), "time_s,model,y_m,velocity_y_m_per_s,particles_fraction",
                60);
    expectSummary(parsed(summary));
    EXPECT_EQ(std::filesystem::exists(out + "/series.h5"), TEST_WITH_HDF5 == 1);
    for (const std::string name : {"solid", "particles"}) {
      EXPECT_EQ(std::filesystem::exists(out + "/" + name + ".pvd"), TEST_WITH_VTK == 1);
      EXPECT_EQ(std::filesystem::exists(out + "/" + name + "/" + name + "_000002.vtu"), TEST_WITH_VTK == 1);
    }
  }
  const auto before = everyByte(folder);
  const Outcome refused = runShort({"--dt-factor", "5", "--out", out, "--summary", summary.string()});
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(everyByte(folder), before) << "a refused run changed what an earlier one wrote";
}

TEST(Program, WhatWasNotComparedIsNull) {
  const ScratchFolder folder;
  const std::string summary = (folder / "summary.json").string();
  const std::vector<Words> runs{{"--no-comparison"}, {"--full-dem"}};
  for (Words more : runs) {
    more.insert(more.end(), {"--until", "0.004", "--summary", summary});
    const Outcome outcome = runShort(more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out.find("Beside particles alone"), std::string::npos);
    const auto json = parsed(summary).at("results");
    for (const char* key :
         {"waveform_error_fem", "waveform_error_dem", "reflected_energy_fraction", "speed_ratio_to_full_dem"})
      EXPECT_TRUE(json.at(key).is_null()) << key;
  }
}

TEST(Program, TheReportSaysWhatTheReaderNeeds) {
  const Outcome outcome = runProgram({"--dem-length", "4", "--overlap", "1.6", "--omega", "0.7"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* part : {"waveform error", "reflected energy", "Ledger at the end", "us per step", "the coupling\n",
                           "omega = 0.7 rad/ms", "momentum residual"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << " in\n" << outcome.out;
}

TEST(Program, GivenPartsWinOverTheScheme) {
  const ScratchFolder folder;
  const std::string summary = (folder / "summary.json").string();
  const Outcome outcome =
      runShort({"--order", "symmetric", "--tension", "on", "--scheme", "paper", "--signal", "cosine", "--dt-factor",
                "0.03", "--until", "0.002", "--no-comparison", "--quiet", "--summary", summary});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto settings = parsed(summary).at("settings");
  EXPECT_EQ(settings.at("scheme"), "paper");
  EXPECT_EQ(settings.at("constraint"), "dashpot");
  EXPECT_EQ(settings.at("rows"), "per-element");
  EXPECT_EQ(settings.at("order"), "symmetric");
  EXPECT_EQ(settings.at("tension"), "on");
  EXPECT_EQ(settings.at("signal"), "cosine");
  EXPECT_EQ(settings.at("dt_factor"), "0.03");
}

TEST(Program, ABreakdownSaysWhereAndWhenAndKeepsWhatThereIs) {
  const ScratchFolder folder;
  const std::string summary = (folder / "summary.json").string();
  // A dashpot far too strong for its step, which no critical step guards against.
  const Outcome outcome = runShort({"--constraint", "dashpot", "--penalty", "1e13", "--quiet", "--out",
                                    (folder / "out").string(), "--summary", summary});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("t = "), std::string::npos) << outcome.err;
  const auto json = parsed(summary).at("results");
  EXPECT_EQ(json.at("finished"), false);
  EXPECT_EQ("wave_propagation: " + json.at("failure").get<std::string>() + "\n", outcome.err);
  EXPECT_FALSE(readText(folder / "out/series.csv").empty());
}

TEST(Program, AnInterruptedRunWritesWhatItHas) {
  const ScratchFolder folder;
  const std::filesystem::path out = folder / "out", summary = folder / "summary.json";
  const auto words = [&](const std::string& factor) {
    return Words{"--until",         "0.02",    "--dt-factor", factor,       "--output-interval", "1e-5",
                 "--no-comparison", "--quiet", "--out",       out.string(), "--summary",         summary.string()};
  };
  cantilever::test::Running run(words("1e-5"));
  ASSERT_TRUE(run.awaits(out / "profile.csv", "\n1"));
  run.signal(SIGINT);
  const Outcome outcome = run.outcome();
  EXPECT_EQ(outcome.code, 130);
  EXPECT_NE(outcome.err.find("interrupted by SIGINT"), std::string::npos) << outcome.err;
  const auto json = parsed(summary).at("results");
  EXPECT_EQ(json.at("finished"), false);
  EXPECT_EQ("wave_propagation: " + json.at("failure").get<std::string>() + "\n", outcome.err);
  for (const char* name : {"series.csv", "profile.csv"})
    EXPECT_EQ(io::readCsv(out / name).column("time_s").back(), json.at("end_time_s").get<double>()) << name;
  EXPECT_EQ(std::filesystem::exists(out / "series.h5"), TEST_WITH_HDF5 == 1);
}

TEST(Program, TheSummaryHasTheSceneThatRan) {
  const ScratchFolder folder;
  const std::filesystem::path summary = folder / "summary.json";
  ASSERT_EQ(runShort({"--until", "0.002", "--no-comparison", "--quiet", "--summary", summary.string()}).code, 0);
  const auto scene = parsed(summary).at("scene");
  EXPECT_EQ(scene.at("particles").at(0).at("density"), 2500);
  EXPECT_EQ(scene.at("couplings").at(0).at("particle_border"), 4);
  EXPECT_EQ(scene.at("stages").at(0).at("time"), 0.002);
}

TEST(Program, StudiesWriteOneRowPerRun) {
  const std::map<std::string, std::size_t> studies{{"widths", 24}, {"constraints", 26}, {"stability", 132}};
  for (const auto& [name, runs] : studies) {
    SCOPED_TRACE(name);
    const ScratchFolder folder;
    const Outcome outcome = runShort({"--study", name, "--until", "0.001", "--quiet", "--out", folder.path().string()});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(folder.content(), (std::set<std::string>{name + ".csv", name + ".json", name + ".md", name + ".svg"}));
    const auto json = parsed(folder / (name + ".json"));
    EXPECT_EQ(json.at("runs").size(), runs);
    for (const auto& entry : json["runs"]) {
      const std::string outcomeOfRun = entry.at("outcome"), message = entry.at("message");
      EXPECT_TRUE(outcomeOfRun == "finished" || !message.empty()) << entry.at("label") << outcomeOfRun;
    }
    const std::string csv = readText(folder / (name + ".csv"));
    const auto lines = std::count(csv.begin(), csv.end(), '\n') - std::count(csv.begin(), csv.end(), '#');
    EXPECT_EQ(static_cast<std::size_t>(lines), runs + 1);
    EXPECT_NE(csv.find("\nlabel,outcome,message,"), std::string::npos);
  }
}

}  // namespace
}  // namespace dovetail::wave
