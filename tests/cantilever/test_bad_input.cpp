#include <map>

#include "refusals.hpp"

namespace dovetail::cantilever {
namespace {

using io::test::ScratchFolder;
using io::test::writeText;
using test::everyByte;
using test::expectChoice;
using test::expectRefused;
using test::Words;

TEST(BadInput, NumbersOutsideTheirRange) {
  const std::string width = "--cg-width";
  for (const char* value : {"-1", "nan", "inf", "-inf"})
    expectRefused({width, value}, {width, value, "give 0 (local)"});
  expectRefused({"--refine", "0"}, {"--refine", "from 1 to 16"});
  expectRefused({"--refine", "-2"}, {"--refine", "from 1 to 16"});
  expectRefused({"--until", "-1"}, {"--until", "positive time"});
  expectRefused({"--until", "0"}, {"--until", "positive time"});
  expectRefused({"--until", "nan"}, {"--until", "positive time"});
  expectRefused({"--threads", "0"}, {"--threads", "from 1 to 1024"});
  expectRefused({"--fem-every", "0"}, {"--fem-every", "from 1 to 1000"});
  expectRefused({"--output-interval", "0"}, {"--output-interval", "positive time"});
  expectRefused({"--restitution", "1.01"}, {"--restitution", "up to 1"});
  expectRefused({"--restitution", "0"}, {"--restitution", "above 0"});
  expectRefused({"--stiffness-ratio", "0"}, {"--stiffness-ratio", "positive"});
  expectRefused({"--stiffness-ratio", "1e-9"}, {"--stiffness-ratio", "give at least"});
}

TEST(BadInput, TimeSteps) {
  expectRefused({"--dt-factor", "0"}, {"--dt-factor", "positive", "--dt auto"});
  expectRefused({"--dt-factor", "5"}, {"--dt-factor", "element", "give at most", "--dt auto"});
  expectRefused({"--dt-factor", "0.05", "--dt", "auto"}, {"--dt-factor", "--dt"});
  expectRefused({"--dt", "0.001"}, {"--dt", "auto"});
  expectRefused({"--dt-fraction", "1.1"}, {"above the critical step", "give at most"});
  expectRefused({"--dt-fraction", "0.5", "--dt-factor", "0.05"}, {"--dt-factor", "--dt-fraction"});
  expectRefused({"--dt-factor", "5", "--fem", "newmark"}, {"contact of a particle with the skin", "give at most"});
  expectRefused({"--fem-every", "500"}, {"stepped every 500", "give at most"});
}

TEST(BadInput, RunsThatWouldNotEnd) {
  expectRefused({"--dt-factor", "1e-9"}, {"steps are too many", "--dt-factor", "--until"});
  expectRefused({"--stiffness-ratio", "1e300", "--dt", "auto"}, {"steps are too many", "--stiffness-ratio"});
  expectRefused({"--stiffness-ratio", "1e20", "--until", "1"}, {"steps are too many", "--stiffness-ratio"});
}

TEST(BadInput, ARefusedRunLeavesNoFolder) {
  const ScratchFolder folder;
  const std::string out = (folder / "new").string();
  expectRefused({"--dt-factor", "5", "--out", out, "--summary", out + "/summary.json"}, {"--dt-factor"});
  expectRefused({"--stiffness-ratio", "1e-9", "--out", out}, {"--stiffness-ratio"});
  EXPECT_TRUE(everyByte(folder).empty());
}

TEST(BadInput, Meshes) {
  expectRefused({"--mesh", "0,30,2"}, {"--mesh", "2,30,2"});
  expectRefused({"--mesh", "2,-30,2"}, {"--mesh", "2,30,2"});
  expectRefused({"--mesh", "2,30"}, {"--mesh", "3"});
  expectRefused({"--mesh", "2,30,2,2"}, {"--mesh", "3"});
  expectRefused({"--mesh", "2,thirty,2"}, {"--mesh", "2,thirty,2"});
  expectRefused({"--mesh", "2.5,30,2"}, {"--mesh", "2.5,30,2"});
  expectRefused({"--mesh", "2000,2000,2000"}, {"--mesh", "at most 4 million"});
  expectRefused({"--mesh", "100,100,100", "--refine", "2"}, {"--refine", "at most 4 million"});
}

TEST(BadInput, WordsThatAreNoChoice) {
  const std::map<std::string, Words> choices{
      {"--scheme", {"conservative", "paper"}},
      {"--kernel", {"lucy", "gauss"}},
      {"--kernel-correction", {"none", "linear", "symmetric"}},
      {"--surface", {"flat", "smooth"}},
      {"--element", {"hex8", "hybrid8"}},
      {"--lag", {"none", "load", "load-and-skin"}},
      {"--transfer", {"adjoint", "spread"}},
      {"--edges", {"projected", "paper"}},
      {"--metric", {"reference", "deformed"}},
      {"--fem", {"explicit", "newmark"}},
      {"--mass", {"lumped", "consistent"}},
      {"--study", {"widths", "pareto", "stability", "ablation"}},
  };
  for (const auto& [option, names] : choices) expectChoice(option, names);
}

TEST(BadInput, WordsThatAreNoOption) {
  expectRefused({"--cgwidth", "2"}, {"--cgwidth", "--help"});
  expectRefused({"leftover"}, {"leftover", "--help"});
  expectRefused({"--cg-width"}, {"--cg-width", "--help"});
  expectRefused({"--cg-width", "two"}, {"--cg-width", "two"});
  expectRefused({"--refine", "1.5"}, {"--refine", "1.5"});
  expectRefused({"--threads", "99999999999"}, {"--threads", "99999999999"});
  expectRefused({"--cg-width", "2", "--cg-width", "3"}, {"--cg-width"});
}

TEST(BadInput, EmptyValues) {
  for (const char* option : {"--cg-width", "--kernel", "--mesh", "--element", "--until", "--out", "--summary",
                             "--reference", "--dt-factor", "--study"})
    expectRefused({option, "", "--quiet"}, {option});
}

TEST(BadInput, ThingsThatDoNotGoTogether) {
  expectRefused({"--surface", "smooth", "--transfer", "spread"}, {"--surface smooth", "--transfer adjoint"});
  expectRefused({"--surface", "smooth", "--edges", "paper"}, {"--surface smooth", "--edges projected"});
  expectRefused({"--scheme", "paper", "--surface", "smooth"}, {"--surface smooth", "--transfer adjoint"});
  expectRefused({"--mass", "consistent"}, {"--mass consistent", "--fem newmark --lag load"});
  expectRefused({"--metric", "deformed", "--element", "hybrid8"}, {"--metric deformed", "--element hex8"});
  expectRefused({"--transfer", "spread", "--kernel-correction", "linear"},
                {"--kernel-correction linear", "--kernel-correction none"});
  expectRefused({"--study", "widths", "--summary", "x.json"}, {"--summary", "--out DIR"});
  expectRefused({"--study", "widths", "--reference", "x"}, {"--reference", "leave out"});
}

TEST(BadInput, OptionsThatWouldDoNothing) {
  expectRefused({"--kernel", "gauss"}, {"--kernel", "--cg-width"});
  expectRefused({"--kernel-correction", "linear"}, {"--kernel-correction", "--cg-width"});
  expectRefused({"--output-interval", "1"}, {"--output-interval", "--out DIR"});
  expectRefused({"--study", "widths", "--out", "x", "--output-interval", "1"}, {"--output-interval", "--study"});
  expectRefused({"--quiet", "--reference", "x"}, {"--reference", "--quiet"});
  expectRefused({"--quiet", "--profile"}, {"--profile", "--summary FILE"});
}

TEST(BadInput, PlacesThatCannotBeWritten) {
  const ScratchFolder folder;
  writeText(folder / "file", "mine");
  const std::string file = (folder / "file").string();
  const Words longRun{"--until", "1000"};  // would be noticed, should it start
  const auto with = [&](const char* option, const std::string& place) {
    Words words = longRun;
    words.insert(words.end(), {option, place});
    return words;
  };
  const auto before = everyByte(folder);
  expectRefused(with("--out", file), {"--out", file, "give a folder"});
  expectRefused(with("--out", file + "/below"), {"--out", file, "give a folder"});
  expectRefused(with("--summary", "/proc/x"), {"--summary", "/proc", "give a folder"});
  expectRefused(with("--summary", file + "/x.json"), {"--summary", file, "give a folder"});
  expectRefused(with("--summary", (folder / "typo/x.json").string()), {"--summary", "typo", "make it"});
  expectRefused(with("--summary", folder.path().string()), {"--summary", folder.path().string()});
  expectRefused({"--out", folder.path().string(), "--summary", (folder / "series.csv").string()},
                {"--summary", "series.csv", "another name"});
  EXPECT_EQ(everyByte(folder), before);
}

TEST(BadInput, ReferencesThatAreNotThere) {
  const ScratchFolder folder;
  expectRefused({"--reference", folder.path().string()}, {"--reference", "cantilever_c*d.csv", "name the folder"});
  expectRefused({"--reference", (folder / "nowhere").string()}, {"--reference", "name the folder"});
  writeText(folder / "cantilever_c0d.csv", "t_s\n0\n");
  expectRefused({"--reference", folder.path().string()}, {"cantilever_c0d.csv", "x1_m"});
}

TEST(BadInput, WhatOthersWroteIsNotOverwritten) {
  Words names{"series.csv", "summary.json"};
  if (TEST_WITH_HDF5) names.push_back("series.h5");
  if (TEST_WITH_VTK) names.insert(names.end(), {"beam.pvd", "particles.pvd", "beam", "particles"});
  for (const std::string& name : names) {
    const ScratchFolder folder;
    writeText(folder / name, "somebody else's");
    const std::string out = folder.path().string();
    expectRefused({"--until", "1000", "--out", out, "--summary", (folder / "summary.json").string()},
                  {name, name == "summary.json" ? "--summary" : "--out"});
    const auto after = everyByte(folder);
    for (const auto& [file, bytes] : after)  // folders may have been made, files not
      EXPECT_TRUE(file == name ? bytes == "somebody else's" : std::filesystem::is_directory(folder / file)) << file;
    EXPECT_TRUE(after.contains(name));
  }
}

}  // namespace
}  // namespace dovetail::cantilever
