// dovetail study of several ways
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "bounce.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/report/curve_error.hpp"
#include "dovetail/report/table.hpp"

namespace dovetail::report {
namespace {

/// Two ways to bounce, each with repeats from other heights, beside the finest of the first.
struct Ways : Bounce {
  std::string plan = (folder / "plan.json").string(), more;
  void write(const std::string& against, const std::string& error = "particles_kinetic_J, momentum_z_Ns") const {
    std::string soft = bouncing;
    soft.replace(soft.find("1e4"), 3, "2e4");
    writeText(folder / "soft.json", soft);
    writeText(plan, R"({"ways": [
      {"name": "hard", "scene": "bounce.json", "over": [{"key": "share", "values": "0.01, 0.1"}]},
      {"name": "soft", "scene": "soft.json"}],
      "set": [{"key": "output.checkpoints", "value": "0.1 ms"}],
      "repeat": {"key": "particles.0.spheres.0.at", "values": "[0, 0, 0.0101], [0, 0, 0.01015]"}, "error": ")" +
                        error + "\", \"against\": {" + against + "}" + more + "}");
  }
  Json runs() const { return Json::parse(readText(folder / "out/study.json"))["runs"]; }
};

TEST(StudyWays, HoldsWaysToRunsOfTheStudyRepeatByRepeat) {
  Ways ways;
  ways.write(R"("way": "hard", "point": "share=0.01", "norm": "relative")");
  const Outcome outcome = runProgram({"study", ways.plan, "--out", ways.out});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json study = Json::parse(readText(ways.folder / "out/study.json"));
  const Json& runs = study["runs"];
  ASSERT_EQ(runs.size(), 6u);
  const auto curveIn = [&](std::size_t run, const std::string& column) {
    const io::TimeSeries series =
        io::readCsv(ways.folder / ("out/" + runs[run]["settings"]["folder"].get<std::string>()) / "series.csv");
    const auto x = series.column("time_s"), y = series.column(column);
    return Curve{"", {x.begin(), x.end()}, {y.begin(), y.end()}};
  };
  const auto distance = [&](const Curve& from, std::size_t run, const std::string& column) {
    return distanceFrom(from, curveIn(run, column), Norm::relative).value;
  };
  double scatter = 0.0;
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(runs[k]["point"], k < 2 ? "share=0.01" : k < 4 ? "share=0.1" : "soft");
    if (k < 2) {  // the reference
      EXPECT_FALSE(runs[k].contains("error"));
      continue;
    }
    double sum = 0.0;
    for (const char* const column : {"particles_kinetic_J", "momentum_z_Ns"}) {
      const double part = distance(curveIn(k % 2, column), k, column);
      EXPECT_EQ(runs[k][std::string("error_") + column], part);
      sum += 0.5 * part * part;
    }
    EXPECT_NEAR(runs[k]["error"].get<double>(), std::sqrt(sum), 1e-15);
  }
  for (const char* const column : {"particles_kinetic_J", "momentum_z_Ns"})
    for (std::size_t k = 0; k < 2; ++k) {
      const double part = distance(meanOf({curveIn(0, column), curveIn(1, column)}), k, column);
      scatter += 0.25 * part * part;
    }
  EXPECT_NEAR(study["scatter"].get<double>(), std::sqrt(scatter), 1e-15);
  EXPECT_GT(scatter, 0.0);
  ASSERT_EQ(study["points"].size(), 2u);
  EXPECT_EQ(study["points"][1]["way"], "soft");
  EXPECT_EQ(study["points"][1]["runs"], 2);
  for (const char* const file : {"curves_particles_kinetic_J.svg", "curves_momentum_z_Ns.svg"})
    EXPECT_NE(readText(ways.folder / "out" / file).find("soft"), std::string::npos);
}

TEST(StudyWays, ComparesAStageFromItsStart) {
  // A grain that waits, in each way another time, and falls.
  const ScratchFolder folder;
  const std::string plan = (folder / "plan.json").string(), out = (folder / "out").string();
  writeText(folder / "falls.json", R"({"title": "A grain falls", "let": {"wait": "0.2 ms"}, "gravity": [0, 0, 0],
    "contact": {"law": "linear", "stiffness": 1e4},
    "particles": [{"from": "list", "density": 2500, "spheres": [{"at": [0, 0, 1], "radius": "1 cm"}]}],
    "steps": {"dt": "2 us"}, "output": {"series": "0.1 ms"},
    "stages": [{"do": "run", "time": "wait"}, {"do": "run", "time": "1 ms", "changes": {"gravity": [0, 0, -9.81]}}]})");
  const auto write = [&](const std::string& stage) {
    writeText(plan, R"({"ways": [{"name": "soon", "scene": "falls.json"},
      {"name": "late", "scene": "falls.json", "set": [{"key": "wait", "value": "0.6 ms"}]}],
      "error": "momentum_z_Ns", "against": {"way": "soon", "norm": "relative")" +
                        stage + "}}");
    const Outcome outcome = runProgram({"study", plan, "--replace", "--out", out});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Json::parse(readText(folder / "out/study.json"))["runs"][1];
  };
  EXPECT_GT(write("")["error"].get<double>(), 0.3);
  for (const char* const stage : {R"(, "stage": 2)", R"(, "stage": -1)"}) {
    const Json run = write(stage);
    EXPECT_LT(run["error"].get<double>(), 1e-12) << stage;
    EXPECT_NEAR(run["covered"].get<double>(), 1.0, 1e-9);
  }
  const Json beyond = write(R"(, "stage": 3)");
  EXPECT_NE(beyond["message"].get<std::string>().find("2 stages"), std::string::npos) << beyond;
}

TEST(StudyWays, GoesOnWhereAnEarlierOneEnded) {
  Ways ways;
  ways.write(R"("way": "hard", "point": "share=0.01", "norm": "relative")");
  ASSERT_EQ(runProgram({"study", ways.plan, "--out", ways.out}).code, 0);
  const Json whole = Json::parse(readText(ways.folder / "out/study.json"));
  const std::string series = readText(ways.folder / "out/004/series.csv");
  Json less = whole;  // the fourth has no row, and begins at its checkpoint; the sixth has nothing
  less["runs"].erase(5);
  less["runs"].erase(3);
  writeText(ways.folder / "out/study.json", less.dump(2));
  std::filesystem::remove(ways.folder / "out/004/summary.json");
  std::filesystem::remove_all(ways.folder / "out/006");
  const auto written = std::filesystem::last_write_time(ways.folder / "out/003/series.csv");
  const Outcome outcome = runProgram({"study", ways.plan, "--continue", "--out", ways.out});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(std::filesystem::last_write_time(ways.folder / "out/003/series.csv"), written);
  EXPECT_EQ(readText(ways.folder / "out/004/series.csv"), series);
  const Json runs = ways.runs();
  ASSERT_EQ(runs.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(runs[k]["outcome"], "finished") << runs[k]["message"];
    EXPECT_EQ(runs[k]["label"], whole["runs"][k]["label"]);
    EXPECT_EQ(runs[k]["particles_kinetic_J"], whole["runs"][k]["particles_kinetic_J"]);
    EXPECT_EQ(runs[k].value("error", 0.0), whole["runs"][k].value("error", 0.0)) << k;
  }
  for (const std::size_t k : {0u, 1u, 2u, 4u}) EXPECT_EQ(runs[k]["wall_seconds"], whole["runs"][k]["wall_seconds"]);
  // Another scene is run anew.
  const Outcome other = runProgram({"study", ways.plan, "--continue", "--set", "speed=2", "--out", ways.out});
  ASSERT_EQ(other.code, 0) << other.err;
  EXPECT_NE(ways.runs()[2]["particles_kinetic_J"], whole["runs"][2]["particles_kinetic_J"]);
  EXPECT_EQ(runProgram({"study", ways.plan, "--continue", "--replace", "--out", ways.out}).code, 2);
}

TEST(StudyWays, WaysBeginWithWhatOthersPrepared) {
  const Bounce bounce;
  const std::string plan = (bounce.folder / "plan.json").string();
  std::string later = bouncing;
  const std::string spheres =
      later.substr(later.find("[{\"from\""), later.find("],\n  \"walls\"") + 1 - later.find("[{\"from\""));
  later.replace(later.find(spheres), spheres.size(), R"([{"from": "state", "file": "given by the study"}])");
  writeText(bounce.folder / "later.json", later);
  const auto write = [&](const std::string& more) {
    writeText(plan, R"({"ways": [
      {"name": "start", "scene": "bounce.json", "prepares": true, "set": [{"key": "output.checkpoints", "value": "1"}])" +
                        more + R"(},
      {"name": "rest", "scene": "later.json", "set": [{"key": "particles.0.file", "value": "{start}/checkpoint.state"}],
       "over": [{"key": "share", "values": "0.05, 0.1"}]}],
      "repeat": {"key": "speed", "values": "1, 2"}, "error": "particles_kinetic_J"})");
  };
  write("");
  const Outcome outcome = runProgram({"study", plan, "--workers", "3", "--out", bounce.out});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json study = Json::parse(readText(bounce.folder / "out/study.json"));
  const Json& runs = study["runs"];
  ASSERT_EQ(runs.size(), 6u);
  ASSERT_EQ(study["points"].size(), 2u);  // the start is not compared
  for (std::size_t k = 2; k < 6; ++k) {
    EXPECT_EQ(runs[k]["outcome"], "finished") << runs[k]["message"];
    const io::TimeSeries before = io::readCsv(bounce.folder / (k % 2 == 0 ? "out/001" : "out/002") / "series.csv"),
                         after = io::readCsv(bounce.folder / ("out/00" + std::to_string(k + 1)) / "series.csv");
    EXPECT_EQ(after.column("particles_kinetic_J")[0], before.column("particles_kinetic_J").back());
  }
  // Another start: what begins with it is not kept.
  const Outcome changed = runProgram({"study", plan, "--continue", "--set", "steps.dt=1 us", "--out", bounce.out});
  ASSERT_EQ(changed.code, 0) << changed.err;
  const Json anew = Json::parse(readText(bounce.folder / "out/study.json"))["runs"];
  for (std::size_t k = 2; k < 6; ++k) EXPECT_NE(anew[k]["wall_seconds"], runs[k]["wall_seconds"]) << k;
  // The second start cannot be: what begins with it says so.
  write(R"(, "over": [])");
  const Outcome less =
      runProgram({"study", plan, "--set", "stages.0.time=speed < 1.5 ? 1e-3 : -1", "--out", bounce.out + "2"});
  EXPECT_EQ(less.code, 0) << less.err;
  const Json some = Json::parse(readText(bounce.folder / "out2/study.json"))["runs"];
  EXPECT_EQ(some[1]["outcome"], "refused");
  write(R"(, "over": [{"key": "share", "values": "0.1, 0.2"}])");
  const Outcome bad = runProgram({"study", plan, "--out", bounce.out + "3"});
  EXPECT_EQ(bad.code, 2);
  EXPECT_NE(bad.err.find("prepares {start} for \"rest: share=0.05, speed=1\""), std::string::npos) << bad.err;
  write("");
  std::string text = readText(plan);
  text.replace(text.find("{start}"), 7, "{strat}");
  writeText(plan, text);
  const Outcome unknown = runProgram({"study", plan, "--out", bounce.out + "4"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.err.find("prepares {strat}"), std::string::npos) << unknown.err;
}

/// A packing, a reference and what it is compared with at every place of an axis; what they cost over it.
TEST(StudyWays, WaysMeetWhereTheyHaveTheSameValuesOfAnAxis) {
  const Bounce bounce;
  const std::string plan = (bounce.folder / "plan.json").string();
  const auto write = [&](const std::string& against, const std::string& values = "0.05, 0.1") {
    writeText(plan, R"({"ways": [
      {"name": "start", "scene": "bounce.json", "prepares": true, "set": [{"key": "output.checkpoints", "value": "1"}],
       "over": [{"key": "share", "values": "0.05, 0.1"}]},
      {"name": "fine", "scene": "bounce.json", "set": [{"key": "title", "value": "from {start}"}],
       "over": [{"key": "share", "values": "0.05, 0.1"}, {"key": "steps.safety", "values": "0.01, 0.02"}]},
      {"name": "coarse", "scene": "bounce.json", "over": [{"key": "share", "values": ")" +
                        values + R"("}]}],
      "repeat": {"key": "speed", "values": "1, 2"}, "error": "particles_kinetic_J", "size": "share",
      "against": {"way": "fine", "norm": "relative")" +
                        against + "}}");
  };
  write(R"(, "point": "steps.safety=0.01")");
  const Outcome outcome = runProgram({"study", plan, "--out", bounce.out});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json study = Json::parse(readText(bounce.folder / "out/study.json"));
  const Json& runs = study["runs"];
  ASSERT_EQ(runs.size(), 16u);
  const auto folder = [](std::size_t run) { return std::string(run < 9 ? "00" : "0") + std::to_string(run + 1); };
  const auto curveIn = [&](std::size_t run) {
    const io::TimeSeries series = io::readCsv(bounce.folder / "out" / folder(run) / "series.csv");
    const auto x = series.column("time_s"), y = series.column("particles_kinetic_J");
    return Curve{"", {x.begin(), x.end()}, {y.begin(), y.end()}};
  };
  for (std::size_t share = 0; share < 2; ++share)
    for (std::size_t speed = 0; speed < 2; ++speed) {
      const std::size_t fine = 4 + 4 * share + speed, other = fine + 2, coarse = 12 + 2 * share + speed;
      EXPECT_FALSE(runs[fine].contains("error"));
      for (const std::size_t k : {other, coarse})
        EXPECT_EQ(runs[k]["error"], distanceFrom(curveIn(fine), curveIn(k), Norm::relative).value) << k;
      const std::string scene = readText(bounce.folder / "out" / folder(fine) / "scene.json");
      EXPECT_NE(scene.find("out/" + folder(2 * share + speed)), std::string::npos) << fine;
    }
  EXPECT_FALSE(study.contains("scatter"));  // of several points
  const std::string figure = readText(bounce.folder / "out/study_scaling.svg");
  for (const char* const name : {">fine, steps.safety=0.01<", ">fine, steps.safety=0.02<", ">coarse<"})
    EXPECT_NE(figure.find(name), std::string::npos) << name;
  EXPECT_EQ(figure.find(">start<"), std::string::npos);
  EXPECT_NE(readText(bounce.folder / "out/study.md").find("from share"), std::string::npos);
  const auto refused = [&](const std::string& part) {
    const Outcome bad = runProgram({"study", plan, "--out", bounce.out + "2"});
    EXPECT_EQ(bad.code, 2);
    EXPECT_NE(bad.err.find(part), std::string::npos) << bad.err;
  };
  write("");
  refused("several points beside \"coarse: share=0.05, speed=1\"");
  write(R"(, "point": "steps.safety=0.01")", "0.05, 0.2");
  refused("no run of the way stands beside \"coarse: share=0.2, speed=1\"");
  write(R"(, "point": "steps.safety=0.01")");
  std::string text = readText(plan);
  for (std::size_t at = 0; (at = text.find("0.05, 0.1", at)) != std::string::npos;) text.replace(at, 9, "0.05, 10 mm");
  writeText(plan, text);
  refused("no number above 0");
  text.replace(text.find(R"("size": "share")"), 15, R"("size": "speed")");
  writeText(plan, text);
  refused("no axis has the key \"speed\"");
}

TEST(StudyWays, WhatCannotBeComparedIsToldInItsRow) {
  Ways ways;
  // A column that is zero has no relative distance, and no scatter either; all runs are there all the same.
  ways.write(R"("way": "hard", "point": "share=0.01", "norm": "relative")", "momentum_x_Ns");
  ASSERT_EQ(runProgram({"study", ways.plan, "--out", ways.out}).code, 0);
  const Json study = Json::parse(readText(ways.folder / "out/study.json"));
  ASSERT_EQ(study["runs"].size(), 6u);
  EXPECT_NE(study["scatter_message"].get<std::string>().find("zero"), std::string::npos);
  EXPECT_NE(study["runs"][2]["message"].get<std::string>().find("zero"), std::string::npos);
  // A reference that cannot be.
  ways.write(R"("way": "hard", "point": "share=0.01", "norm": "relative")");
  std::string text = readText(ways.plan);
  text.replace(text.find("0.01, 0.1"), 9, "-1, 0.1");
  text.replace(text.find("share=0.01"), 10, "share=-1");
  writeText(ways.plan, text);
  ASSERT_EQ(runProgram({"study", ways.plan, "--replace", "--out", ways.out}).code, 0);
  const Json runs = ways.runs();
  EXPECT_EQ(runs[0]["outcome"], "refused");
  EXPECT_NE(runs[2]["message"].get<std::string>().find("\"hard: share=-1, particles"), std::string::npos) << runs[2];
}

TEST(StudyWays, RefusesWaysThatCannotBeCompared) {
  Ways ways;
  const auto refused = [&](const std::string& part, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"study", ways.plan, "--out", ways.out};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome bad = runProgram(words);
    EXPECT_EQ(bad.code, 2);
    EXPECT_NE(bad.err.find(part), std::string::npos) << bad.err;
    EXPECT_FALSE(std::filesystem::exists(ways.out));
  };
  const std::string good = R"("way": "hard", "point": "share=0.01", "norm": "relative")";
  ways.write(R"("way": "hard", "norm": "relative")");
  refused("take one of share=0.01; share=0.1");
  ways.write(R"("way": "hard", "point": "share=1", "norm": "relative")");
  refused("no point \"share=1\"");
  ways.write(R"("way": "grains", "norm": "relative")");
  refused("no way \"grains\"");
  ways.write(R"("norm": "relative")");
  refused("no single one");
  ways.write(R"("way": "hard", "point": "share=0.01")");
  refused("cannot be added up");
  ways.write(good, "particles_kinetic_J, speed_J");
  refused("--error speed_J");
  ways.write(good);
  refused("axes of its own", {"--over", "share=0.1"});
  ways.more = R"(, "scene": "bounce.json")";
  ways.write(good);
  refused("beside a scene");
}

TEST(StudyWays, TheShippedStudyConvergesInEveryWay) {
  const ScratchFolder folder;
  const Outcome outcome = runProgram(
      {"study", std::string(SCENES) + "/studies/static-cantilever.json", "--out", (folder / "out").string()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json points = Json::parse(readText(folder / "out/study.json"))["points"];
  ASSERT_EQ(points.size(), 9u);
  for (std::size_t k = 0; k < 9; ++k)
    if (k % 3 > 0) {
      EXPECT_LT(points[k]["error"].get<double>(), points[k - 1]["error"].get<double>()) << points[k]["point"];
    }
}

/// A short and thin column: a packing under a lid, its grains alone, beside a solid, and as cells cut out of it.
TEST(StudyWays, TheShippedWaysOfAPulseAgree) {
  const ScratchFolder folder;
  const auto way = [](const std::string& name, const std::string& more) {
    return R"({"name": ")" + name + R"(", "scene": ")" + SCENES + "/three-ways/pulse-" + name + R"(.json", )" + more +
           "}";
  };
  const std::string state = R"("value": "{packing}/checkpoint.state"})",
                    grains = R"({"key": "particles.0.file", )" + state + R"(, {"key": "walls.0.state.file", )" + state;
  writeText(folder / "plan.json",
            R"({"ways": [)" + way("packing", R"("prepares": true, "set": [{"key": "settle", "value": "20 ms"},
                     {"key": "stages.1.kinetic", "value": "1e-7"}])") +
                ", " + way("grains", R"("set": [)" + grains + "]") + ", " +
                way("overlap", R"("set": [)" + grains + R"(, {"key": "grains", "value": "8*d"},
                     {"key": "overlap", "value": "5*d"}])") +
                ", " +
                way("cells", R"("set": [{"key": "cells", "value": "1"}, {"key": "cells.0.file", )" + state + "]") +
                R"(], "set": [{"key": "width", "value": "5*d"}, {"key": "length", "value": "25*d"},
                   {"key": "near", "value": "5*d"}, {"key": "far", "value": "16*d"}, {"key": "pulse", "value": "10*d"}],
                 "error": "near_vz_m_per_s, far_vz_m_per_s",
                 "against": {"way": "grains", "norm": "relative", "stage": -1}})");
  const Outcome outcome = runProgram({"study", (folder / "plan.json").string(), "--out", (folder / "out").string()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json runs = Json::parse(readText(folder / "out/study.json"))["runs"];
  ASSERT_EQ(runs.size(), 4u);
  for (const Json& run : runs) {
    ASSERT_EQ(run["outcome"], "finished") << run["message"];
    EXPECT_LT(run["largest_residual_fraction"].get<double>(), 1e-3) << run["label"];
  }
  EXPECT_LT(runs[2]["error"].get<double>(), 0.08);
  EXPECT_LT(runs[3]["error"].get<double>(), 0.5);  // one cell of 150 grains
}

}  // namespace
}  // namespace dovetail::report
