// The program dovetail as its users call it.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "../cantilever/program.hpp"
#include "surfaces.hpp"

using Words = std::vector<std::string>;

namespace dovetail::scene {
namespace {

using cantilever::test::Outcome;
using cantilever::test::runProgram;
using io::test::readText;
using io::test::ScratchFolder;

std::string starter(const std::string& name) { return (std::filesystem::path(SCENES) / (name + ".json")).string(); }

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
  const auto files = std::filesystem::directory_iterator(folder / "out");
  EXPECT_EQ(std::ranges::any_of(files, [](const auto& file) { return file.path().extension() == ".pvd"; }),
            WITH_FRAMES != 0);
  for (const char* file : {"out", "out/series.csv", "out/scene.json"})
    EXPECT_EQ(runProgram({"info", (folder / file).string()}).code, 0) << file;
}
INSTANTIATE_TEST_SUITE_P(
    All, Starters,
    testing::Values(Shortened{"ball-on-cells", "5e-4"}, Shortened{"biaxial-cells", "2e-3"},
                    Shortened{"bonded-beam", "1e-3"}, Shortened{"cantilever", "0.1"}, Shortened{"chute", "2e-3"},
                    Shortened{"column", "2e-3"}, Shortened{"column-collapse", "5e-3"}, Shortened{"digging", "2e-3"},
                    Shortened{"drum", "2e-3"}, Shortened{"footing", "5e-4"}, Shortened{"hopper", "2e-3"},
                    Shortened{"pile", "0.01"}, Shortened{"plate", "2e-4"}, Shortened{"plucked", "5e-3"},
                    Shortened{"shaft", "1"}, Shortened{"shear-band", "2e-3"}, Shortened{"snowball", "5e-4"},
                    Shortened{"static-cantilever", "1"}, Shortened{"stirrer", "2e-3"}, Shortened{"two-materials", "1"},
                    Shortened{"tray", "0.01"}, Shortened{"wave", "2e-3"}, Shortened{"wet-column", "2e-3"}),
    [](const auto& one) {
      std::string name = one.param.name;
      std::erase(name, '-');
      return name;
    });

TEST(Program, ChecksWithoutAFile) {
  const Outcome outcome = runProgram({"check", starter("plate")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* part : {"44 particles", "solid \"plate\": 315 nodes", "at most", "macro steps", "MiB"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << " in\n" << outcome.out;
}

TEST(Program, RefusesInOneLine) {
  const ScratchFolder folder;
  const std::string out = (folder / "out").string();
  expectRefused(runProgram({}), "a verb is missing");
  expectRefused(runProgram({"chekc"}), "write \"check\"");
  expectRefused(runProgram({"run", starter("plate"), "--ste", "a=1"}), "write --set");
  expectRefused(runProgram({"rum"}), "no verb 'rum'");
  expectRefused(runProgram({"run"}), "SCENE");
  expectRefused(runProgram({"run", starter("plate"), "--ot", out}), "--ot");
  expectRefused(runProgram({"check", (folder / "none.json").string()}), "cannot be read");
  expectRefused(runProgram({"check", starter("plate"), "--set", "steps.tt=1"}), "steps");
  expectRefused(runProgram({"run", starter("plate"), "--set", "steps.dt=1 ms", "--out", out}),
                "particle 0 with \"grains on plate (skin)\"");
  expectRefused(runProgram({"run", starter("plate"), "--set", "solids.0.name=a b", "--out", out}), "name");
  expectRefused(runProgram({"run", starter("plate"), "--set", "couplings.0.solid=pate", "--out", out}),
                "write \"plate\"");
  expectRefused(runProgram({"run", starter("plate"), "--set", "couplings.0.on=top", "--out", out}), "couplings.0");
  for (const char* const verb : {"check", "run"}) {
    expectRefused(runProgram({verb, starter("plate"), "--set",
                              R"(walls=[{"shape": "plane", "point": [0, 0, 9], "normal": [0, 0, 1]}])"}),
                  "behind the plane");
    expectRefused(runProgram({verb, starter("plate"), "--set", R"(domain={"box": [[0, 0, 0], [1, 1, 1e-3]]})"}),
                  "outside of the domain");
  }
  expectRefused(runProgram({"resume", folder.path().string()}), "no folder of a run");
  expectRefused(runProgram({"info", (folder / "none").string()}), "no such file");
  expectRefused(runProgram({"new", "plait"}), "plait");
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(Program, StarterScenesAreWrittenOnceAndChecked) {
  const ScratchFolder folder;
  const std::string file = (folder / "mine.json").string();
  EXPECT_EQ(runProgram({"new", "plate", file}).code, 0);
  EXPECT_EQ(runProgram({"check", file}).code, 0);
  expectRefused(runProgram({"new", "plate", file}), "a file of this name");
}

/// What a run writes depends on its own scene alone, whatever an earlier one has left.
TEST(Program, NothingOfAnEarlierRunStandsBesideANewOne) {
  const ScratchFolder folder;
  const auto words = [&](const std::string& output) {
    return Words{"run",   starter("plate"),   "--out",    folder.path().string(), "--set", "time=1e-4",
                 "--set", "output=" + output, "--replace"};
  };
  const auto run = [&](const std::string& output) {
    const Outcome outcome = runProgram(words(output));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  };
  run(std::string(R"({"series": 1e-5, "checkpoints": 5e-5)") + (WITH_HDF5 ? R"(, "hdf5": true)" : "") +
      (WITH_FRAMES ? R"(, "frames": 5e-5, "contents": ["grains", "contacts"])" : "") + "}");
  EXPECT_EQ(std::filesystem::exists(folder / "series.h5"), WITH_HDF5 != 0);
  EXPECT_EQ(std::filesystem::exists(folder / "contacts.pvd"), WITH_FRAMES != 0);
  run("{}");
  for (const char* const old : {"series.csv", "series.h5", "contacts.pvd", "grains.pvd", "checkpoint.state"})
    EXPECT_FALSE(std::filesystem::exists(folder / old)) << old;
  if (!WITH_FRAMES) return;
  const auto frames = [&] {
    const std::filesystem::directory_iterator entries(folder / "grains");
    return std::distance(begin(entries), end(entries));
  };
  run(R"({"frames": 1e-5})");
  const auto first = frames();
  io::test::writeText(folder / "grains/notes.vtu", "mine");
  run(R"({"frames": 5e-5})");
  EXPECT_LT(frames(), first);
  const std::string list = readText(folder / "grains.pvd");
  int listed = 0;
  for (std::size_t at = list.find("DataSet"); at != std::string::npos; at = list.find("DataSet", at + 1)) ++listed;
  EXPECT_EQ(frames(), listed + 1) << "those of the run, and somebody else's file";
  run("{}");
  EXPECT_EQ(frames(), 1);
}

TEST(Program, ReplacesARunOnlyWhenTold) {
  const ScratchFolder folder;
  Words words{"run", starter("plate"), "--out", folder.path().string(), "--set", "time=1e-4", "--set", "output={}"};
  ASSERT_EQ(runProgram(words).code, 0);
  const std::string before = readText(folder / "summary.txt");
  expectRefused(runProgram(words), "--replace");
  EXPECT_EQ(readText(folder / "summary.txt"), before);
  words.emplace_back("--replace");
  EXPECT_EQ(runProgram(words).code, 0);
}

/// Finished or not, and whatever it has left.
TEST(Program, AsksBeforeItReplacesPartsOfARun) {
  const ScratchFolder folder;
  const std::string marked = "# version: dovetail 0.1.0\nt_s\n0\n";
  const Words words{"run", starter("plate"), "--out", folder.path().string(), "--set", "time=1e-4"};
  io::test::writeText(folder / "series.csv", marked);
  expectRefused(runProgram(words), "series.csv");
  EXPECT_EQ(readText(folder / "series.csv"), marked);
}

TEST(Program, RunsKeepWhatTheyRead) {
  const ScratchFolder folder;
  const Words first{"run", starter("plate"), "--out", (folder / "out").string(), "--set", "time=1e-4"};
  ASSERT_EQ(runProgram(first).code, 0);
  io::test::writeText(folder / "more.json", R"({"include": ["out/scene.json"], "title": "again"})");
  const std::string before = readText(folder / "out/scene.json");
  for (const char* const file : {"more.json", "out/scene.json"})
    expectRefused(runProgram({"run", (folder / file).string(), "--out", (folder / "out").string(), "--replace"}),
                  "overwrite this file");
  EXPECT_EQ(readText(folder / "out/scene.json"), before);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/summary.json"));
  EXPECT_EQ(runProgram({"run", (folder / "more.json").string(), "--out", (folder / "other").string()}).code, 0);
}

/// Copies and edits of files of ours that have names of their own.
TEST(Program, ReplacesFilesUnderItsOwnNamesAlone) {
  if (!WITH_FRAMES) GTEST_SKIP() << "there are no frames";
  const ScratchFolder folder;
  const Words words{"run",      starter("plate"), "--out", folder.path().string(),
                    "--set",    "time=1e-4",      "--set", R"(output={"frames": 1e-4})",
                    "--replace"};
  ASSERT_EQ(runProgram(words).code, 0);
  std::filesystem::copy_file(folder / "grains.pvd", folder / "chosen.pvd");
  io::test::writeText(folder / "report_mine.svg", "<!-- dovetail 0.1.0 -->\n<svg>");
  ASSERT_EQ(runProgram(words).code, 0);
  for (const char* const mine : {"chosen.pvd", "report_mine.svg"})
    EXPECT_TRUE(std::filesystem::exists(folder / mine)) << mine;
}

TEST(Program, RefusesPipesAndEndlessIncludes) {
  const ScratchFolder folder;
  const std::string pipe = (folder / "pipe.json").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  expectRefused(runProgram({"check", pipe}), "cannot be read");
  io::test::writeText(folder / "scene.json", R"({"include": ["pipe.json"]})");
  expectRefused(runProgram({"check", (folder / "scene.json").string()}), "cannot be read");
  for (int k = 0; k < 3000; ++k)
    io::test::writeText(folder / (std::to_string(k) + ".json"),
                        R"({"include": [")" + std::to_string(k + 1) + R"(.json"]})");
  expectRefused(runProgram({"check", (folder / "0.json").string()}), "deep");
}

TEST(Program, AProfileTellsOfGrainsAndSolids) {
  const ScratchFolder folder;
  ASSERT_EQ(runProgram({"run", starter("plate"), "--out", folder.path().string(), "--set", "time=1e-4", "--set",
                        "output={}", "--profile"})
                .code,
            0);
  const std::string text = readText(folder / "summary.txt");
  for (const char* const part : {"solids kick and drift", "find pairs", "grains on plate"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
}

/// A clump falls into the empty half of an overlap, and a grain comes through the side of the soil where grains have no
/// share.
TEST(Program, TellsOfGrainsThatNobodyHolds) {
  const ScratchFolder folder;
  std::ofstream(folder / "pit.json") << R"({"gravity": [0, 0, -9.81], "contact": {"law": "linear", "stiffness": 1e4},
    "particles": [{"from": "lattice", "lattice": "simple-cubic", "box": [[0, 0, 0], [0.2, 0.4, 0.3]], "radius": 0.025,
                   "distance": 0.05, "density": 2000},
                  {"from": "list", "density": 2000,
                   "spheres": [{"at": [0.43, 0.2, -0.1], "radius": 0.02, "velocity": [-2, 0, 0]}]}],
    "clumps": [{"density": 2000, "at": [0.3, 0.2, 0.33], "velocity": [0, 0, -2],
                "spheres": [{"at": [-0.01, 0, 0], "radius": 0.02}, {"at": [0.01, 0, 0], "radius": 0.02}]}],
    "solids": [{"name": "soil", "mesh": "box", "cells": [4, 4, 6], "box": [[0, 0, -0.3], [0.4, 0.4, 0.3]],
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.2, "density": 1100},
      "supports": [{"on": "z-"}]}],
    "couplings": [{"type": "overlap", "solid": "soil", "axis": "z", "solid_border": 0.3, "particle_border": 0}],
    "steps": {"dt": 5e-5}, "stages": [{"do": "run", "time": 0.04}], "output": {"series": "10 ms"}})";
  for (const bool before : {true, false}) {
    const std::string out = (folder / (before ? "before" : "out")).string();
    const Outcome outcome = runProgram({"run", (folder / "pit.json").string(), "--out", out, "--set",
                                        before ? "stages=[{\"do\": \"run\", \"time\": 0.005}]" : "steps.dt=5e-5"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::string told = "3 grains entered \"soil\" where its overlap does not constrain them";
    for (const std::string& text : {outcome.out, readText(std::filesystem::path(out) / "summary.txt")})
      EXPECT_EQ(text.find("WARNING: " + told) == std::string::npos, before) << text;
    EXPECT_EQ(readText(std::filesystem::path(out) / "summary.json").find("3 grains entered") == std::string::npos,
              before);
  }
}

TEST(Program, ComparesRunsAndWritesFields) {
  const ScratchFolder folder;
  for (const char* const name : {"a", "b", "c"})
    ASSERT_EQ(runProgram({"run", starter("plate"), "--out", (folder / name).string(), "--set", "time=1e-4", "--set",
                          R"(output={"series": 1e-5, "checkpoints": 5e-5})", "--set",
                          std::string("steps.safety=") + (name[0] == 'c' ? "0.13" : "0.2")})
                  .code,
              0);
  const std::string a = (folder / "a").string();
  const Outcome same = runProgram({"compare", a, (folder / "b").string()});
  EXPECT_EQ(same.code, 0) << same.out << same.err;
  const Outcome other = runProgram({"compare", a, (folder / "c").string(), "--rows", "3"});
  EXPECT_EQ(other.code, 1) << other.out;
  EXPECT_NE(other.out.find("NOT the same"), std::string::npos) << other.out;
  expectRefused(runProgram({"compare", a, (folder / "none").string()}), "no such file");
  expectRefused(runProgram({"compare", a}), "B is missing");
  const Outcome fields = runProgram({"fields", a, "--width", "0.05"});
  EXPECT_EQ(fields.code, WITH_FRAMES ? 0 : 2) << fields.err;
  EXPECT_EQ(std::filesystem::exists(folder / "a/fields.vti"), WITH_FRAMES != 0);
  if (WITH_FRAMES) expectRefused(runProgram({"fields", a, "--width=-1"}), "width");
}

/// CGAL is under the GPL: a program gets it only where it was configured with DOVETAIL_PROGRAM_CGAL.
TEST(Program, SurfacesAreFilledWhereCgalIsLinked) {
  const ScratchFolder folder;
  test::writeBlock(folder / "b.stl");
  std::ofstream(folder / "s.json") << '{' << test::solidInside("b.stl", "0.1")
                                   << R"("stages": [{"do": "run", "time": 1e-4}]})";
  const Outcome outcome = runProgram({"check", (folder / "s.json").string()});
  if (WITH_CGAL) {
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("solid \"b\": "), std::string::npos) << outcome.out;
  } else {
    expectRefused(outcome, "DOVETAIL_PROGRAM_CGAL=ON");
  }
}

TEST(Program, OtherPeoplesFilesStay) {
  const ScratchFolder folder;
  std::ofstream(folder / "summary.txt") << "mine";
  expectRefused(runProgram({"run", starter("plate"), "--out", folder.path().string()}), "summary.txt");
  EXPECT_EQ(readText(folder / "summary.txt"), "mine");
}

/// Starter scenes name the program, as its own files do.
TEST(Program, ScenesStayThatLieWhereARunWrites) {
  const ScratchFolder folder;
  const std::string file = (folder / "scene.json").string();
  ASSERT_EQ(runProgram({"new", "plate", file}).code, 0);
  const std::string text = readText(file);
  expectRefused(runProgram({"run", file, "--out", folder.path().string()}), "scene.json");
  EXPECT_EQ(readText(file), text);
}

TEST(Program, UpgradesScenesInPlace) {
  const ScratchFolder folder;
  const std::string old = R"({"steps": {"per_window": 2}} // mine)";
  std::ofstream(folder / "s.json") << old;
  const Outcome outcome = runProgram({"upgrade", (folder / "s.json").string()});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("per_macro_step"), std::string::npos) << outcome.out;
  EXPECT_EQ(readText(folder / "s.json"), R"({"steps": {"per_macro_step": 2}} // mine)");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  EXPECT_EQ(runProgram({"upgrade", (folder / "s.json").string()}).out, "nothing to change\n");
  expectRefused(runProgram({"upgrade", (folder / "none.json").string()}), "none.json");
}

}  // namespace
}  // namespace dovetail::scene
