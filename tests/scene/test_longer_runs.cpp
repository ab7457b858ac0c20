// Runs that go on from what is whole, to another end, on other numbers of threads.
#include <gtest/gtest.h>

#include <cmath>

#include "../cantilever/program.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::scene {
namespace {

using cantilever::test::everyByte;
using cantilever::test::Running;
using cantilever::test::runProgram;
using io::test::ScratchFolder;

using Words = std::vector<std::string>;

/// Grains are poured onto a plate of rubber with implicit steps, whatever the build writes.
Words poured(const ScratchFolder& folder, const std::string& time, const Words& more = {}) {
  std::string output = "output={\"series\": 2e-3, \"checkpoints\": 0.01";
  if (WITH_FRAMES) output += ", \"frames\": 0.01, \"contents\": [\"grains\", \"contacts\", \"solids\"]";
  if (WITH_HDF5) output += ", \"hdf5\": true";
  Words words{"run",   std::string(SCENES) + "/tray.json",
              "--out", folder.path().string(),
              "--set", "time=" + time,
              "--set", "solids.0.stepping=implicit",
              "--set", "solids.0.cells=[6, 4, 1]",
              "--set", output + "}",
              "--set", "steps.per_macro_step=4"};
  for (const std::string& one : more) words.insert(words.end(), {"--set", one});
  return words;
}

/// All but what tells times, or of the way.
std::map<std::string, std::string> digitsOf(const ScratchFolder& folder) {
  auto bytes = everyByte(folder);
  for (const char* const name :
       {"summary.txt", "summary.json", "times.csv", "checkpoint.previous.state", "checkpoint.damaged.state"})
    bytes.erase(name);
  return bytes;
}

void expectSame(const ScratchFolder& folder, const ScratchFolder& expected, const Words& but = {}) {
  auto found = digitsOf(folder), right = digitsOf(expected);
  for (const std::string& name : but) found.erase(name), right.erase(name);
  EXPECT_EQ(found.size(), right.size());
  for (const auto& [name, bytes] : right) EXPECT_TRUE(found.contains(name) && found.at(name) == bytes) << name;
}

cantilever::test::Outcome resumed(const ScratchFolder& folder, const Words& options = {}) {
  Words words{"resume", folder.path().string()};
  words.insert(words.end(), options.begin(), options.end());
  return runProgram(words);
}

/// Its end lies between two rows, two frames and two looks.
TEST(LongerRuns, HaveTheBytesOfThoseThatWereLongFromTheStart) {
  const ScratchFolder whole, done, broken;
  ASSERT_EQ(runProgram(poured(whole, "0.0806")).code, 0);
  ASSERT_EQ(runProgram(poured(done, "0.0409")).code, 0);
  EXPECT_EQ(resumed(done, {"--until", "80.6 ms"}).code, 0);
  expectSame(done, whole);

  auto limited = poured(broken, "0.0409");
  limited.insert(limited.end(), {"--max-wall-seconds", "1e-3"});
  ASSERT_EQ(runProgram(limited).code, 142);
  ASSERT_EQ(resumed(broken, {"--until", "0.0806", "--max-wall-seconds", "1e-3"}).code, 142);
  EXPECT_EQ(resumed(broken).code, 0) << "the new end is that of the scene from now on";
  expectSame(broken, whole);
}

/// Walls, grains, planes and nodes move by functions of time, whose velocities and integrals are found by differences.
TEST(LongerRuns, MoveBySameFunctionsWhateverTheirEnd) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP() << "expressions need muParser";
  const ScratchFolder whole, done;
  io::test::writeText(done / "moved.json", R"json({
    "let": {"time": 0.05},
    "contact": {"law": "linear", "stiffness": 1e4, "restitution": 0.5, "friction": 0.3},
    "particles": [{"from": "list", "density": 2000, "name": "driven",
      "spheres": [{"at": [0.0, 0, 0.0999], "radius": 0.05}, {"at": [0.11, 0, 0.0999], "radius": 0.05}]},
      {"from": "list", "density": 2000, "spheres": [{"at": [0.05, 0, 0.186], "radius": 0.05}]}],
    "drives": [{"group": "driven", "displacement": [0, "0.01*sin(40*t)", 0]}],
    "walls": [{"shape": "plane", "point": [0, 0, 0.05], "normal": [0, 0, 1], "displacement": ["0.01*sin(90*t)", 0, "0.002*sin(30*t)"]},
      {"shape": "plane", "point": [0.05, 0, 0.235], "normal": [0, 0, -1], "velocity": [0, 0, "-0.02*cos(20*t)"]}],
    "solids": [{"name": "bar", "mesh": "box", "cells": [1, 1, 3], "box": [[1, 0, 0], [1.05, 0.05, 0.1]],
      "gravity": false, "stepping": "implicit",
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000},
      "supports": [{"on": "z-"}, {"on": "z+", "velocity": ["0.1*cos(50*t)", 0, 0]}],
      "planes": [{"on": "y+", "point": [1, 0.05, 0], "normal": [0, -1, 0], "displacement": [0, "-0.001*sin(60*t)", 0]}]}],
    "steps": {"dt": 1e-4}, "stages": [{"do": "run", "time": "time"}],
    "output": {"series": 1e-3, "checkpoints": 0.01}})json");
  const auto words = [&](const std::string& time, const ScratchFolder& folder) {
    return Words{"run", (done / "moved.json").string(), "--set", "time=" + time, "--out", (folder / "out").string()};
  };
  ASSERT_EQ(runProgram(words("0.05", whole)).code, 0);
  ASSERT_EQ(runProgram(words("0.023", done)).code, 0);
  ASSERT_EQ(runProgram({"resume", (done / "out").string(), "--until", "0.05"}).code, 0);
  for (const char* const file : {"checkpoint.state", "series.csv"})
    EXPECT_TRUE(io::test::readText(whole / "out" / file) == io::test::readText(done / "out" / file)) << file;
}

TEST(LongerRuns, BeginAfterWhatBroughtToRest) {
  const auto stages = [](const std::string& time) {
    return Words{"stages=[{\"do\": \"relax\", \"macro_steps\": 60}, {\"do\": \"run\", \"time\": " + time + "}]"};
  };
  const ScratchFolder whole, done;
  ASSERT_EQ(runProgram(poured(whole, "1", stages("0.03"))).code, 0);
  const std::string rows = io::test::readText(whole / "series.csv");
  const std::size_t last = rows.rfind('\n', rows.size() - 2) + 1;
  ASSERT_EQ(runProgram(poured(done, "1", stages("0.011"))).code, 0);
  EXPECT_EQ(resumed(done, {"--until", rows.substr(last, rows.find(',', last) - last)}).code, 0);
  expectSame(done, whole, {"scene.json", "series.h5"});  // whose times are not rounded to macro steps
}

/// Grains of a sieve curve, and clumps, enter until their totals and stick to each other.
std::string sticky(const std::string& contact, double time) {
  return R"({"gravity": [0, 0, -9.81], "contact": )" + contact + R"(, "damping": {"rate": 2, "local": 0.05},
    "walls": [{"shape": "box", "box": [[0, 0, 0], [0.1, 0.1, 0.3]], "open": ["z+", "x+"]}], "insertions": [
      {"region": [[0, 0, 0], [0.1, 0.1, 0.1]], "density": 2500, "number_per_second": 6000, "total_mass": 0.1,
       "from": "11 ms", "radius": {"distribution": "sieves", "sieves": [{"opening": 0.008, "passing": 0},
         {"opening": 0.01, "passing": 0.6}, {"opening": 0.014, "passing": 1}]}},
      {"region": [[0, 0, 0], [0.1, 0.1, 0.1]], "density": 2500, "number_per_second": 500, "until": "30 ms",
       "velocity": [1, 0, 0], "spin": [0, 9, 0], "clumps": [{"spheres": [{"at": [0, 0, 0], "radius": 0.005},
         {"at": [0.006, 0, 0], "radius": 0.005}]}]}],
    "outlets": [{"region": [[0.1, 0, -9], [9, 9, 9]]}], "steps": {"dt": "20 us", "threads": 1}, "stages": [{"do": "run", "time": )" +
         std::to_string(time) + R"(}], "output": {"series": 1e-3, "checkpoints": 0.01}})";
}

TEST(LongerRuns, OfGrainsThatEnterAndStick) {
  for (const char* const contact :
       {R"({"law": "linear", "stiffness": 5000, "restitution": 0.6, "friction": 0.4, "liquid_bridge":
           {"surface_tension": 0.072, "volume": "2 mm3", "contact_angle": "20 deg"}})",
        R"({"law": "elastic-plastic", "stiffness": 3000, "unloading_stiffness": 9000, "cohesion_stiffness": 1000,
           "friction": 0.4, "adhesion": {"work": 0.1}})"}) {
    const ScratchFolder scenes, whole, done;
    const auto runs = [&](const ScratchFolder& out, double time) {
      io::test::writeText(scenes / "s.json", sticky(contact, time));
      return runProgram({"run", (scenes / "s.json").string(), "--out", out.path().string()});
    };
    ASSERT_EQ(runs(whole, 0.06).code, 0);
    const auto outcome = runs(done, 0.02);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(resumed(done, {"--until", "0.06", "--threads", "3"}).code, 0);
    const auto rows = [](const ScratchFolder& folder) {
      const std::string text = io::test::readText(folder / "series.csv");
      return text.substr(text.find("\ntime_s"));
    };
    EXPECT_EQ(rows(done), rows(whole));
    const io::TimeSeries series = io::readCsv(whole / "series.csv");
    EXPECT_GT(series.column("left").back(), 0.0);
    EXPECT_GT(series.column("entered").back(), 40.0);
    EXPECT_LT(std::abs(series.column("residual_J").back()),
              1e-2 * std::abs(series.column("particles_entered_minus_J").back()));
  }
}

TEST(LongerRuns, AreRefusedWhereNoEndCanBe) {
  const auto refusal = [](const ScratchFolder& folder, const std::string& until) {
    const auto outcome = resumed(folder, {"--until", until});
    EXPECT_EQ(outcome.code, 2) << until;
    return outcome.err;
  };
  const ScratchFolder done, relaxes, waits;
  ASSERT_EQ(runProgram(poured(done, "0.02")).code, 0);
  const auto before = everyByte(done);
  EXPECT_NE(refusal(done, "0.01").find("give a later time"), std::string::npos);
  for (const char* const odd : {"soon", "-1", "0", "3 m", "nan", "inf"})
    EXPECT_NE(refusal(done, odd).find("--until"), std::string::npos) << odd;
  EXPECT_TRUE(everyByte(done) == before);
  ASSERT_EQ(runProgram(poured(relaxes, "1", {"stages=[{\"do\": \"relax\", \"macro_steps\": 40}]"})).code, 0);
  EXPECT_NE(refusal(relaxes, "1").find("the last stage does not run for a time"), std::string::npos);
  auto limited =
      poured(waits, "1", {"stages=[{\"do\": \"relax\", \"macro_steps\": 900}, {\"do\": \"run\", \"time\": 0.01}]"});
  limited.insert(limited.end(), {"--max-wall-seconds", "1e-3"});
  ASSERT_EQ(runProgram(limited).code, 142);
  EXPECT_NE(refusal(waits, "1").find("stage 1 has not come to rest"), std::string::npos);
}

TEST(DamagedStates, AreSetAsideForTheOneBefore) {
  const ScratchFolder whole;
  ASSERT_EQ(runProgram(poured(whole, "0.08")).code, 0);
  for (const std::string damage : {"short", "", "last letter"}) {
    const ScratchFolder broken;
    Running running(poured(broken, "0.08"));
    ASSERT_TRUE(running.awaits(broken / "checkpoint.previous.state", "dovetail"));
    running.signal(SIGTERM);
    ASSERT_EQ(running.outcome().code, 143);
    std::string state = io::test::readText(broken / "checkpoint.state");
    state.back() = static_cast<char>(state.back() ^ 1);
    io::test::writeText(broken / "checkpoint.state", damage == "last letter" ? state : damage);
    const auto outcome = resumed(broken);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("checkpoint.previous.state, t = "), std::string::npos) << outcome.out;
    EXPECT_TRUE(std::filesystem::exists(broken / "checkpoint.damaged.state"));
    expectSame(broken, whole);
  }
}

TEST(Threads, AreNoPartOfARun) {
  const ScratchFolder whole, broken;
  const auto rows = [](const ScratchFolder& folder) {
    const std::string text = io::test::readText(folder / "series.csv");
    return text.substr(text.find("\ntime_s"));
  };
  ASSERT_EQ(runProgram(poured(whole, "0.04", {"steps.threads=2"})).code, 0);
  auto limited = poured(broken, "0.04", {"steps.threads=2"});
  limited.insert(limited.end(), {"--max-wall-seconds", "1e-3"});
  ASSERT_EQ(runProgram(limited).code, 142);
  EXPECT_EQ(resumed(broken, {"--threads", "0"}).code, 2);
  EXPECT_EQ(resumed(broken, {"--threads", "1"}).code, 0);
  EXPECT_NE(io::test::readText(broken / "series.csv").find("# threads: 1\n"), std::string::npos);
  EXPECT_EQ(rows(broken), rows(whole));
  EXPECT_TRUE(everyByte(broken).at("checkpoint.state") == everyByte(whole).at("checkpoint.state"));
}

}  // namespace
}  // namespace dovetail::scene
