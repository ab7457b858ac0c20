// Runs that were broken off go on to the same bytes.
#include <gtest/gtest.h>

#include "../cantilever/program.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::scene {
namespace {

using cantilever::test::everyByte;
using cantilever::test::Running;
using cantilever::test::runProgram;
using io::test::ScratchFolder;

using Words = std::vector<std::string>;

/// With all outputs that the build has.
Words words(const ScratchFolder& folder, const std::string& scene, const Words& settings, const std::string& every) {
  Words all{"run", std::string(SCENES) + "/" + scene, "--out", folder.path().string()};
  for (const std::string& setting : settings) all.insert(all.end(), {"--set", setting});
  std::string output = "output={\"series\": 2e-3, \"checkpoints\": " + every;
  if (WITH_FRAMES)
    output +=
        ", \"frames\": 0.02, \"contents\": [\"grains\", \"spin\", \"forces\", \"weights\", \"contacts\", "
        "\"solids\", \"stress\", \"history\"]";
  if (WITH_HDF5) output += ", \"hdf5\": true";
  all.insert(all.end(), {"--set", output + ", \"probes\": [{\"name\": \"g\", \"of\": \"grain\", \"at\": [0, 0, 0]}]}"});
  return all;
}
Words pile(const ScratchFolder& folder) { return words(folder, "pile.json", {"time=0.16"}, "0.02"); }

/// All bytes but those of the summaries, which tell times.
std::map<std::string, std::string> digits(const ScratchFolder& folder) {
  auto bytes = everyByte(folder);
  for (const char* const name : {"summary.txt", "summary.json", "times.csv"}) bytes.erase(name);
  bytes.erase("checkpoint.previous.state");
  return bytes;
}

struct Case {
  Words (*words)(const ScratchFolder&);
  const char *file, *text;  ///< the signal is sent when the file holds the text
};

void expectSameAfter(const Case& one, int signal, int code) {
  const ScratchFolder whole, broken;
  ASSERT_EQ(runProgram(one.words(whole)).code, 0);
  Running running(one.words(broken));
  ASSERT_TRUE(running.awaits(broken / one.file, one.text));
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

/// Grains meet the clay, so that books get channels after the state that is gone on from.
const Case pouring{pile, "series.csv", "\n0.13"};
TEST(Restart, AfterAnInterruptionAllBytesAreTheSame) { expectSameAfter(pouring, SIGINT, 130); }
TEST(Restart, AfterAKillAllBytesAreTheSame) { expectSameAfter(pouring, SIGKILL, -1); }

/// The published scheme: loads one step old, spread on an implicit solid by the rule of the deepest contact.
Words published(const ScratchFolder& folder) {
  return words(folder, "cantilever.json",
               {"time=0.25", "steps.lag=load", "couplings.0.transfer=spread", "couplings.0.kernel=0.4",
                "couplings.0.kernel_correction=none", "couplings.0.edges=deepest", "contact.restitution=0.99",
                "solids.0.material.law=deformed-metric", "solids.0.stepping=implicit"},
               "0.02");
}
const Case staggered{published, "series.csv", "\n0.1"};
TEST(Restart, APublishedSchemeGoesOnToTheSameBytes) { expectSameAfter(staggered, SIGKILL, -1); }

/// A bar that is pulled and pushed until it yields; factors of its implicit steps serve many of them.
Words yieldingBar(const ScratchFolder& folder, const std::string& every) {
  io::test::writeText(folder / "bar.json", R"json({"solids": [{"name": "bar", "mesh": "box", "cells": [1, 1, 3],
    "box": [[0, 0, 0], [0.05, 0.05, 0.1]], "formulation": "enhanced", "stepping": "implicit",
    "material": {"law": "J2", "youngs_modulus": 2e11, "poisson_ratio": 0.3, "density": 7800, "yield_stress": 2.5e8,
                 "hardening": 1e9},
    "supports": [{"on": "z-"}, {"on": "z+", "displacement": [0, 0, "2e-3*sin(20*t)"]}],
    "loads": [{"on": "x+", "type": "pressure", "pressure": "1e6*sin(70*t)"}]}],
    "steps": {"dt": 2e-4}, "stages": [{"do": "run", "time": 0.1}]})json");
  return {"run",   (folder / "bar.json").string(),
          "--out", (folder / "out").string(),
          "--set", "output={\"series\": 2e-3, \"checkpoints\": " + every + "}"};
}
std::string rowsOf(const ScratchFolder& folder) {
  const std::string text = io::test::readText(folder / "out" / "series.csv");
  return text.substr(text.find("\ntime_s"));
}

TEST(Restart, PlannedCheckpointsChangeNothing) {
  const ScratchFolder seldom, often;
  ASSERT_EQ(runProgram(yieldingBar(seldom, "1")).code, 0);
  ASSERT_EQ(runProgram(yieldingBar(often, "7e-3")).code, 0);
  EXPECT_EQ(rowsOf(often), rowsOf(seldom));
}

TEST(Restart, UnplannedCheckpointsChangeNothing) {
  const ScratchFolder whole, broken;
  ASSERT_EQ(runProgram(yieldingBar(whole, "1")).code, 0);
  Running running(yieldingBar(broken, "1"));
  ASSERT_TRUE(running.awaits(broken / "out" / "series.csv", "\n0.02"));
  running.signal(SIGTERM);
  ASSERT_EQ(running.outcome().code, 143);
  ASSERT_EQ(runProgram({"resume", (broken / "out").string()}).code, 0);
  EXPECT_EQ(rowsOf(broken), rowsOf(whole));
}

/// A driven clump and bonded ones.
const Case stirring{[](const ScratchFolder& folder) { return words(folder, "stirrer.json", {"time=0.06"}, "0.02"); },
                    "series.csv", "\n0.03"};
TEST(Restart, ADrivenClumpGoesOnToTheSameBytes) { expectSameAfter(stirring, SIGKILL, -1); }

/// A ball on a solid whose points have cells of grains.
const Case onCells{[](const ScratchFolder& folder) {
                     return words(
                         folder, "ball-on-cells.json",
                         {"solids.0.cells=[2, 2, 2]", "cells.0.count=60", "stages=[{\"do\": \"run\", \"time\": 0.02}]"},
                         "0.004");
                   },
                   "series.csv", "\n0.01"};
TEST(Restart, CellsOfGrainsGoOnToTheSameBytes) { expectSameAfter(onCells, SIGKILL, -1); }

/// Ended while all is brought to rest, by a checkpoint's first bytes.
const Case relaxing{[](const ScratchFolder& folder) {
                      return words(
                          folder, "pile.json",
                          {"stages=[{\"do\": \"run\", \"time\": 0.02}, {\"do\": \"relax\", \"kinetic\": 1e-12, "
                           "\"macro_steps\": 1000}, {\"do\": \"run\", \"time\": 4e-3}]"},
                          "0.02");
                    },
                    "checkpoint.previous.state", "dovetail"};
TEST(Restart, AnInterruptedRestGoesOn) { expectSameAfter(relaxing, SIGTERM, 143); }
TEST(Restart, AKilledRestGoesOn) { expectSameAfter(relaxing, SIGKILL, -1); }

/// Ended among load steps, of which each has a row.
const Case loading{[](const ScratchFolder& folder) {
                     return Words{"run",   std::string(SCENES) + "/static-cantilever.json",
                                  "--out", folder.path().string(),
                                  "--set", "stages.0.load_steps=60",
                                  "--set", "stages.0.time=0.6",
                                  "--set", "output.checkpoints=0.1"};
                   },
                   "series.csv", "\n0.1"};
TEST(Restart, InterruptedLoadStepsGoOn) { expectSameAfter(loading, SIGTERM, 143); }
TEST(Restart, KilledLoadStepsGoOn) { expectSameAfter(loading, SIGKILL, -1); }

/// Parts of a time that is up at once are as long as a look takes; the last one has time enough.
TEST(Restart, RunsWhoseTimeIsUpGoOn) {
  const ScratchFolder whole, parted;
  const auto limited = [](Words all, const char* seconds) {
    all.insert(all.end(), {"--max-wall-seconds", seconds});
    return runProgram(all);
  };
  const auto of = [](const ScratchFolder& folder) { return words(folder, "pile.json", {"time=0.04"}, "0.02"); };
  ASSERT_EQ(runProgram(of(whole)).code, 0);
  auto outcome = limited(of(parted), "1e-3");
  const Words on{"resume", parted.path().string()};
  for (int part = 0; part < 3; ++part) {
    ASSERT_EQ(outcome.code, 142) << outcome.err;
    EXPECT_NE(outcome.out.find("its time was up at t = "), std::string::npos) << outcome.out;
    outcome = limited(on, part < 2 ? "1e-3" : "600");
  }
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(digits(parted) == digits(whole));
  for (const char* const odd : {"0", "nan", "-5", "soon"}) EXPECT_EQ(limited(on, odd).code, 2) << odd;
}

TEST(Restart, AFolderServesAgainAndPartsOfStatesGo) {
  const ScratchFolder folder;
  const std::vector<std::string> run{
      "run",   std::string(SCENES) + "/plate.json", "--out", folder.path().string(), "--replace", "--set", "time=1e-4",
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
  for (const char* const name : {"checkpoint.state", "checkpoint.previous.state"})
    std::ofstream(folder / name) << state.substr(0, state.size() / 2);
  EXPECT_NE(refusal().find("checkpoint.state"), std::string::npos);
}

/// Two layers of grains that rub against each other.
std::string rubbing(const std::string& particles, double time) {
  return R"({"contact": {"law": "linear", "stiffness": 1e4, "friction": 0.6},
    "periodic": {"box": [[0, 0, 0], [0.4, 0.4, 0.4]], "axes": ["x", "y", "z"]}, "particles": [)" +
         particles + R"(], "steps": {"dt": 1e-4}, "stages": [{"do": "run", "time": )" + std::to_string(time) +
         R"(}], "output": {"series": 0.001, "checkpoints": 1}})";
}

TEST(GrainsOfAState, GoOnInAnotherScene) {
  const ScratchFolder scenes, first, whole, second;
  const std::string layer = R"({"from": "lattice", "lattice": "simple-cubic", "radius": 0.05005, "distance": 0.1,
    "density": 2500, "box": [[0, 0, )";
  const std::string layers = layer + R"(0], [0.4, 0.4, 0.2]], "velocity": [0.1, 0, 0]}, )" + layer +
                             R"(0.2], [0.4, 0.4, 0.4]], "velocity": [-0.1, 0, 0]})";
  const std::string taken = R"({"from": "state", "file": ")" + (first / "checkpoint.state").string() + R"("})";
  const auto runs = [&](const std::string& name, const std::string& text, const ScratchFolder& out) {
    io::test::writeText(scenes / name, text);
    const auto outcome = runProgram({"run", (scenes / name).string(), "--out", out.path().string()});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return io::readCsv(out / "series.csv");
  };
  runs("first.json", rubbing(layers, 0.02), first);
  const io::TimeSeries all = runs("whole.json", rubbing(layers, 0.03), whole);
  const io::TimeSeries rest = runs("second.json", rubbing(taken, 0.01), second);
  for (const char* const name : {"particles_kinetic_J", "particles_contacts_J"}) {
    const double expected = all.column(name).back();
    EXPECT_NEAR(rest.column(name).back(), expected, 1e-11 * std::abs(expected)) << name;
  }
  io::test::writeText(scenes / "behind.json", rubbing(layers + ", " + taken, 0.01));
  const auto refused = runProgram({"check", (scenes / "behind.json").string()});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("put them first"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace dovetail::scene
