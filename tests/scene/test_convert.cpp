// dovetail convert and info, as a user calls them.
#include <gtest/gtest.h>

#include "../cantilever/program.hpp"

namespace dovetail::scene {
namespace {

using cantilever::test::runProgram;
using io::test::readText, io::test::ScratchFolder, io::test::writeText;

const std::string dump = R"(ITEM: TIMESTEP
0
ITEM: NUMBER OF ATOMS
1
ITEM: BOX BOUNDS pp ff ff
0 6
0 6
0 10
ITEM: ATOMS id type x y z radius
3 1 1 2 3 0.5
ITEM: TIMESTEP
100
ITEM: NUMBER OF ATOMS
1
ITEM: BOX BOUNDS pp ff ff
0 6
0 6
0 10
ITEM: ATOMS id type x y z radius
3 1 2 2 3 0.5
)";

struct Convert : ::testing::Test {
  Convert() { writeText(folder / "g.dump", dump); }
  cantilever::test::Outcome convert(std::vector<std::string> more) {
    std::vector<std::string> words{"convert", (folder / "g.dump").string(), (folder / "g.data").string()};
    words.insert(words.end(), more.begin(), more.end());
    return runProgram(words);
  }
  ScratchFolder folder;
};

TEST_F(Convert, TakesFrameUnitsAndDensity) {
  const auto outcome = convert({"--density", "2500", "--units", "cgs", "--frame", "0"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("1 grains"), std::string::npos);
  EXPECT_NE(outcome.out.find(R"("periodic": {"box": [[0, 0, 0], [0.06, 0.06, 0.1]], "axes": ["x"]})"),
            std::string::npos)
      << outcome.out;
  EXPECT_NE(readText(folder / "g.data").find("\n3 1 0.01 2500 0.01 0.02 0.03\n"), std::string::npos);
  ASSERT_EQ(convert({"--density", "2500"}).code, 0);
  EXPECT_NE(readText(folder / "g.data").find("\n3 1 1 2500 2 2 3\n"), std::string::npos);
}

TEST_F(Convert, RefusesInOneLine) {
  for (const auto& [more, said] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{}, "give --density"},
           {{"--density", "1", "--frame", "5"}, "there is no frame 5"},
           {{"--units", "m"}, "--units"}}) {
    const auto outcome = convert(more);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "g.data"));
  }
}

TEST_F(Convert, RunsBecomeSeries) {
  if (!WITH_FRAMES || !WITH_HDF5) GTEST_SKIP() << "needs VTK and HDF5";
  writeText(folder / "s.json", R"({"contact": {"law": "linear", "stiffness": 1e4},
      "particles": [{"from": "lammps", "file": "g.dump", "density": 1}], "steps": {"dt": 1e-3},
      "stages": [{"do": "run", "time": 0.01}], "output": {"frames": 0.005}})");
  ASSERT_EQ(runProgram({"run", (folder / "s.json").string(), "--out", (folder / "run").string()}).code, 0);
  const auto outcome = runProgram({"convert", (folder / "run").string(), (folder / "run.vtkhdf").string()});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("3 frames"), std::string::npos) << outcome.out;
  const auto info = runProgram({"info", (folder / "g.dump").string()});
  EXPECT_NE(info.out.find("1 spheres, radii 0.5"), std::string::npos) << info.out << info.err;
}

TEST_F(Convert, MeshesOfSolidsBecomeOthers) {
  writeText(folder / "m.inp",
            "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT, TYPE=C3D4, ELSET=body\n1,1,2,3,4\n");
  const auto outcome = runProgram({"convert", (folder / "m.inp").string(), (folder / "m.msh").string()});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("4 nodes, 1 elements"), std::string::npos) << outcome.out;
  EXPECT_EQ(runProgram({"convert", (folder / "m.msh").string(), (folder / "n.inp").string()}).code, 0);
  EXPECT_NE(readText(folder / "n.inp").find("body"), std::string::npos);
  EXPECT_EQ(runProgram({"convert", (folder / "m.msh").string(), (folder / "n.inp").string(), "--density", "1"}).code,
            2);
  if (!WITH_FRAMES) return;
  const auto frame = runProgram({"convert", (folder / "m.msh").string(), (folder / "m.vtu").string()});
  EXPECT_NE(frame.out.find("4 nodes, 1 elements"), std::string::npos) << frame.err;
  EXPECT_EQ(runProgram({"convert", (folder / "m.vtu").string(), (folder / "v.inp").string()}).code, 0);
}

}  // namespace
}  // namespace dovetail::scene
