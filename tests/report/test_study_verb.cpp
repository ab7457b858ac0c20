// dovetail study
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "bounce.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/report/curve_error.hpp"
#include "dovetail/report/table.hpp"

namespace dovetail::report {
namespace {

TEST(StudyVerb, AValueThatCannotBeIsARowThatSaysWhy) {
  const Bounce bounce;
  const Outcome some = runProgram({"study", bounce.file, "--over", "share=-1,0.1", "--out", bounce.out});
  ASSERT_EQ(some.code, 0) << some.err;
  const Json runs = Json::parse(readText(bounce.folder / "out/study.json"))["runs"];
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0]["outcome"], "refused");
  EXPECT_NE(runs[0]["message"].get<std::string>().find("safety"), std::string::npos) << runs[0]["message"];
  EXPECT_EQ(runs[1]["outcome"], "finished") << runs[1]["message"];

  const Outcome none = runProgram({"study", bounce.file, "--over", "share=-1,-2", "--out", bounce.out + "2"});
  EXPECT_EQ(none.code, 2);
  EXPECT_FALSE(std::filesystem::exists(bounce.out + "2"));
}

TEST(StudyVerb, ReplacesRunsOnlyWhenTold) {
  const Bounce bounce;
  std::vector<std::string> words{"study", bounce.file, "--over", "share=0.1,0.2", "--out", bounce.out};
  ASSERT_EQ(runProgram(words).code, 0);
  std::filesystem::remove(bounce.folder / "out/study.json");
  const Outcome again = runProgram(words);
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.err.find("--replace"), std::string::npos) << again.err;
  words.emplace_back("--replace");
  EXPECT_EQ(runProgram(words).code, 0);
}

TEST(StudyVerb, RunsEveryCombinationAndMarksTheFront) {
  const Bounce bounce;
  const Outcome outcome = runProgram({"study", bounce.file, "--over", "share=0.05,0.1,0.2", "--set", "speed=2",
                                      "--workers", "2", "--out", bounce.out});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json json = Json::parse(readText(bounce.folder / "out/study.json"));
  ASSERT_EQ(json["runs"].size(), 3u);
  double before = 0.0;
  int front = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Json& run = json["runs"][k];
    EXPECT_EQ(run["outcome"], "finished") << run["message"];
    EXPECT_EQ(run["settings"]["share"], k == 0 ? "0.05" : k == 1 ? "0.1" : "0.2");
    const io::TimeSeries series =
        io::readCsv(bounce.folder / ("out/" + run["settings"]["folder"].get<std::string>()) / "series.csv");
    EXPECT_EQ(run["particles_kinetic_J"], series.column("particles_kinetic_J").back());
    EXPECT_NEAR(series.column("particles_kinetic_J").front(), 0.5 * 4.0 * 2500.0 * 4.0 / 3.0 * M_PI * 1e-6,
                1e-12);                                          // --set
    EXPECT_GT(run["largest_residual_J"].get<double>(), before);  // grows with the step
    before = run["largest_residual_J"];
    front += run["on_front"].get<bool>() ? 1 : 0;
  }
  EXPECT_GE(front, 1);
  EXPECT_NE(readText(bounce.folder / "out/study.md").find("| share=0.1 | finished |"), std::string::npos);
  EXPECT_NE(readText(bounce.folder / "out/study.svg").find("<circle"), std::string::npos);
  EXPECT_NE(readText(bounce.folder / "out/study.csv").find(",particles_kinetic_J,"), std::string::npos);
}

TEST(StudyVerb, TellsTheOrderAndTheGrowthOfTheEnergy) {
  const Bounce bounce;
  const Outcome outcome = runProgram({"study", bounce.file, "--over", "share=0.04,0.02", "--energy", "--set",
                                      "output.series=20 us", "--set", "stages.0.time=1 ms", "--set", "speed=0", "--set",
                                      "particles.0.spheres.0.at=[0, 0, 0.0095]", "--out", bounce.out});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json runs = Json::parse(readText(bounce.folder / "out/study.json"))["runs"];
  ASSERT_EQ(runs.size(), 2u);
  for (const Json& run : runs) {
    // From the spring, pressed in at the start, into motion.
    const double kinetic = run["particles_kinetic_J"].get<double>();
    EXPECT_GT(kinetic, 5e-4);
    EXPECT_NEAR(run["changed_hands_J"].get<double>(), kinetic, 0.01 * kinetic);
    EXPECT_NEAR(run["largest_residual_fraction"].get<double>(),
                run["largest_residual_J"].get<double>() / run["changed_hands_J"].get<double>(), 1e-15);
  }
  const std::string csv = readText(bounce.folder / "out/energy.csv"),
                    html = readText(bounce.folder / "out/energy.html");
  const double ratio =
      runs[0]["largest_residual_fraction"].get<double>() / runs[1]["largest_residual_fraction"].get<double>();
  EXPECT_NEAR(std::log2(ratio), 2.0, 0.3);  // of the second order, told in the table
  EXPECT_NE(html.find("Residual against step"), std::string::npos);
  EXPECT_NE(html.find("particles_kinetic_J"), std::string::npos);
  EXPECT_NE(csv.find("residual_growth"), std::string::npos);
}

TEST(StudyVerb, RefusesBeforeAnythingIsRun) {
  const Bounce bounce;
  const auto refused = [&](std::vector<std::string> more, const std::string& part) {
    more.insert(more.begin(), {"study", bounce.file, "--out", bounce.out});
    const Outcome outcome = runProgram(more);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(bounce.out));
  };
  refused({"--over", "share"}, "key=a,b,c");
  refused({"--over", "share=1,,2"}, "a value is empty");
  refused({"--over", "share=0.1, 0.1"}, "two points of the axis are named");
  refused({"--over", "shore=0.1"}, "share");
  refused({"--over", "share=wide,broad"}, "wide");
  refused({"--over", "share=0.1", "--workers", "0"}, "--workers");
  refused({"--over", "share=0.1", "--error", "speed_J"}, "--error speed_J");
  refused({"--over", "share=0.1", "--error", "wall_seconds"}, "take one of largest_residual_J, time_s, ");
  refused({}, "--over");
  refused({"--over", "share=0.1", "--along", "time_s"}, "--against");
  refused({"--over", "share=0.1", "--show", "speed_J"}, "--show speed_J");
  refused({"--over", "share=0.1", "--set", "speed"}, "key=value");
  const std::string reference = (bounce.folder / "reference.csv").string();
  writeText(reference, "time_s,particles_kinetic_J,residual_J\n0,1,0\n1,1,0\n");
  refused({"--over", "share=0.1", "--against", reference}, "--error");
  refused({"--over", "share=0.1", "--against", reference, "--error", "particles_contacts_J"},
          "no column particles_contacts_J");
  refused({"--over", "share=0.1", "--against", reference, "--error", "particles_kinetic_J", "--exact", "1"}, "--exact");
  refused({"--over", "share=0.1", "--against", reference, "--error", "particles_kinetic_J", "--along", "t"},
          "no column t");
}

TEST(StudyVerb, HoldsRunsToACurve) {
  const Bounce bounce;
  const std::string fine = (bounce.folder / "fine").string(), curve = fine + "/series.csv";
  ASSERT_EQ(runProgram({"run", bounce.file, "--set", "share=0.01", "--out", fine}).code, 0);
  const std::vector<std::string> words{
      "study", bounce.file, "--over",  "share=0.05,0.1,0.2", "--error", "particles_kinetic_J", "--against",
      curve,   "--out",     bounce.out};
  const Outcome outcome = runProgram(words);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json runs = Json::parse(readText(bounce.folder / "out/study.json"))["runs"];
  ASSERT_EQ(runs.size(), 3u);
  const auto curveIn = [](const std::filesystem::path& file) {
    const io::TimeSeries series = io::readCsv(file);
    const auto x = series.column("time_s"), y = series.column("particles_kinetic_J");
    return Curve{"", {x.begin(), x.end()}, {y.begin(), y.end()}};
  };
  double before = 0.0;
  for (const Json& run : runs) {
    const std::string name = run["settings"]["folder"];
    const CurveError error =
        distanceFrom(curveIn(curve), curveIn(bounce.folder / ("out/" + name) / "series.csv"), Norm::mean);
    EXPECT_EQ(run["error"].get<double>(), error.value);
    EXPECT_EQ(run["covered"].get<double>(), error.covered);
    EXPECT_GT(error.value, before);  // grows with the step
    before = error.value;
  }
  EXPECT_NE(readText(bounce.folder / "out/curves.svg").find("reference"), std::string::npos);
  EXPECT_NE(readText(bounce.folder / "out/study.md").find("| error | covered |"), std::string::npos);
}

TEST(StudyVerb, RunsWhatAFilePlans) {
  const Bounce bounce;
  const std::string file = (bounce.folder / "plan.json").string();
  const auto write = [&](const std::string& over, const std::string& more) {
    writeText(file, "{\"scene\": \"bounce.json\", \"set\": [{\"key\": \"speed\", \"value\": \"2\"}], \"over\": [" +
                        over + "]" + more + "}");
  };
  const std::string points = R"({"points": [{"name": "free"},
    {"name": "falling", "set": [{"key": "gravity", "value": "[0, 0, -9.81]"}]}]})",
                    steps = R"({"key": "share", "values": "0.05, 0.1"})";
  write(points + ", " + steps, R"(, "columns": "time_s", "error": "particles_kinetic_J", "exact": 0.02)");
  const Outcome outcome = runProgram({"study", file, "--out", bounce.out});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json runs = Json::parse(readText(bounce.folder / "out/study.json"))["runs"];
  ASSERT_EQ(runs.size(), 4u);
  const char* const labels[] = {"free, share=0.05", "free, share=0.1", "falling, share=0.05", "falling, share=0.1"};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(runs[k]["label"], labels[k]);
    EXPECT_EQ(runs[k]["error"].get<double>(), runs[k]["particles_kinetic_J"].get<double>() - 0.02);
  }
  EXPECT_NE(runs[0]["particles_gravity_J"], runs[2]["particles_gravity_J"]);
  const std::string csv = readText(bounce.folder / "out/study.csv");
  EXPECT_NE(csv.find(",gravity"), std::string::npos) << "settings that only some runs have are columns too";

  for (const char* const verb : {"run", "check"}) {
    const Outcome asScene = runProgram({verb, file});
    EXPECT_EQ(asScene.code, 2);
    EXPECT_NE(asScene.err.find("dovetail study"), std::string::npos) << asScene.err;
  }

  // What is written goes before the file.
  const Outcome less = runProgram({"study", file, "--over", "share=0.1", "--out", bounce.out + "2"});
  ASSERT_EQ(less.code, 0) << less.err;
  EXPECT_EQ(Json::parse(readText(bounce.folder / "out2/study.json"))["runs"].size(), 1u);

  const auto refused = [&](const std::string& part) {
    const Outcome bad = runProgram({"study", file, "--out", bounce.out + "3"});
    EXPECT_EQ(bad.code, 2);
    EXPECT_NE(bad.err.find(part), std::string::npos) << bad.err;
    EXPECT_FALSE(std::filesystem::exists(bounce.out + "3"));
  };
  write(R"({"key": "share"})", "");
  refused("\"key\" with \"values\"");
  write(R"({"key": "share", "values": "0.1", "points": [{"name": "a"}]})", "");
  refused("\"points\"");
  write(steps, R"(, "eror": "time_s")");
  refused("error");
  write(steps, R"(, "exact": 1, "against": {"file": "bounce.json"}, "error": "time_s")");
  refused("leave out one");
}

}  // namespace
}  // namespace dovetail::report
