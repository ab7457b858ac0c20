// Grains of files of other codes in scenes, and files of one kind from another.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <sstream>

#include "../io/scratch_folder.hpp"
#include "dovetail/scene/convert.hpp"
#include "dovetail/scene/execute.hpp"
#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

using io::test::readText, io::test::ScratchFolder, io::test::writeText;

const std::string data = R"(two kinds, units = si

3 atoms
2 atom types

0 0.06 xlo xhi
0 0.06 ylo yhi
0 0.1 zlo zhi

Atoms # sphere

1 1 0.008 2500 0.01 0.02 0.03
2 2 0.01 2500 0.05 0.02 0.005
7 1 0.005 1200 0.03 0.04 0.07

Velocities

1 0.1 -0.2 0.3 1 2 -3
2 0 0 0 0 0 0
7 -0.5 0 0.25 0 0 10
)";
const std::string dump = R"(ITEM: TIMESTEP
0
ITEM: NUMBER OF ATOMS
1
ITEM: BOX BOUNDS pp ff pp
0 0.06
0 0.06
0 0.1
ITEM: ATOMS id x y z radius density
1 0.07 0.02 0.03 0.004 2500
)";
const std::string mercury = "1 0.5 0 0 0 0.06 0.06 0.1\n0.01 0.02 0.03 0.1 -0.2 0.3 0.004 0 0 0 1 2 -3 0\n";
const std::string yade = "#format x_y_z_r_matId\n0.01\t0.02\t0.03\t0.004\t0\n0.05\t0.02\t0.005\t0.005\t1\n";

struct Files : ::testing::Test {
  Files() {
    writeText(folder / "g.data", data);
    writeText(folder / "g.dump", dump);
    writeText(folder / "m.data", mercury);
    writeText(folder / "y.txt", yade);
  }
  Built built(const std::string& particles, const std::string& more = "") const {
    return build(sceneOf("\"particles\": [" + particles + "], " + more, folder.path()));
  }
  std::string refused(const std::string& particles) const {
    return refusalOf(sceneOf("\"particles\": [" + particles + "], ", folder.path()));
  }
  static std::string notes(const Built& built) {
    std::string text;
    for (const std::string& note : built.notes) text += note + "\n";
    return text;
  }
  ScratchFolder folder;
};

TEST_F(Files, GrainsOfOtherCodesKeepMassMotionAndSpin) {
  const Built scene = built(R"({"from": "lammps", "file": "g.data", "velocity": [1, 0, 0]},
      {"from": "mercury", "file": "m.data", "density": 1000},
      {"from": "yade", "file": "y.txt", "density": 3000, "spin": [0, 0, 1]})");
  const dem::Particles& p = scene.run->grains.particles;
  ASSERT_EQ(p.size(), 6u);
  EXPECT_EQ(p.x[2], (Vec3{0.03, 0.04, 0.07}));
  EXPECT_EQ(p.v[0], (Vec3{1.1, -0.2, 0.3}));
  EXPECT_EQ(p.omega[0], (Vec3{1, 2, -3}));
  EXPECT_EQ(p.omega[3], (Vec3{1, 2, -3}));
  EXPECT_EQ(p.omega[5], (Vec3{0, 0, 1}));
  for (const auto& [i, density] : {std::pair{0u, 2500.0}, {2u, 1200.0}, {3u, 1000.0}, {4u, 3000.0}})
    EXPECT_NEAR(p.mass[i], density * 4.0 / 3.0 * std::numbers::pi * std::pow(p.radius[i], 3),
                1e-15 * p.mass[i] + 1e-18);
}

TEST_F(Files, TypesBecomeGroupsWithMaterials) {
  const auto item = [](int type, const std::string& name) {
    return R"({"from": "lammps", "file": "g.data", "type": )" + std::to_string(type) + R"(, "name": ")" + name +
           R"(", "contact_material": ")" + name + "\"}";
  };
  const Built scene = built(item(1, "glass") + "," + item(2, "steel"), R"("contacts": [
      {"between": "steel", "and": "steel", "law": "linear", "stiffness": 2e4},
      {"between": "glass", "and": "steel", "law": "linear", "stiffness": 2e4},
      {"between": "glass", "and": "glass", "law": "linear", "stiffness": 2e4}],)");
  const dem::Particles& p = scene.run->grains.particles;
  ASSERT_EQ(p.size(), 3u);
  EXPECT_EQ(p.radius[1], 0.0025);
  EXPECT_EQ(p.material[0], p.material[1]);
  EXPECT_NE(p.material[0], p.material[2]);
  EXPECT_EQ(notes(scene).find("all are one group"), std::string::npos);
  EXPECT_NE(notes(built(R"({"from": "lammps", "file": "g.data"})")).find("types 1 (2 spheres), 2 (1 spheres)"),
            std::string::npos);
}

TEST_F(Files, ThePeriodicSpaceOfAFileIsToldUnlessTheSceneHasIt) {
  const std::string item = R"({"from": "lammps", "file": "g.dump"})";
  const std::string told = notes(built(item));
  EXPECT_NE(told.find("WARNING: "), std::string::npos);
  const std::string key = R"("periodic": {"box": [[0, 0, 0], [0.06, 0.06, 0.1]], "axes": ["x", "z"]})";
  ASSERT_NE(told.find(key), std::string::npos) << told;
  const Built scene = built(item, key + ",");
  EXPECT_EQ(notes(scene).find("periodic space"), std::string::npos);
  EXPECT_NE(notes(built(item, R"("periodic": {"box": [[0, 0, 0], [0.06, 0.06, 0.1]], "axes": ["x"]},)"))
                .find("another periodic space"),
            std::string::npos);
  const std::string ofData = R"({"from": "lammps", "file": "g.data"})";
  EXPECT_NE(notes(built(ofData)).find("does not tell whether its box is periodic"), std::string::npos);
  EXPECT_EQ(notes(built(ofData, key + ",")).find("does not tell"), std::string::npos);
}

TEST_F(Files, FaultsAreRefusedWithThePlaceInBothFiles) {
  expectParts(refused(R"({"from": "lammps", "file": "g.data", "density": 1})"), {"densities of its own", "g.data"});
  expectParts(refused(R"({"from": "yade", "file": "y.txt"})"), {"no densities", "write \"density\"", "s.json"});
  expectParts(refused(R"({"from": "lammps", "file": "g.data", "type": 3})"), {"no spheres of type 3", "2 (1 spheres)"});
  expectParts(refused(R"({"from": "mercury", "file": "y.txt", "density": 1})"), {"no restart or data file"});
  expectParts(refused(R"({"from": "lammps", "file": "g.data", "frame": 2})"), {"a data file has one frame"});
  expectParts(refused(R"({"from": "lammps", "file": "g.dump", "frame": 2})"), {"there is no frame 2"});
  expectParts(refused(R"({"from": "lammps", "file": "g.dump", "units": "cgs"})").empty() ? "read" : "refused",
              {"read"});
  writeText(folder / "g.data", data.substr(0, data.size() - 30));
  expectParts(refused(R"({"from": "lammps", "file": "g.data"})"), {"g.data, line ", "particles.0"});
}

std::string converted(const std::filesystem::path& from, const std::filesystem::path& to,
                      const ConvertOptions& settings = {}) {
  std::ostringstream log;
  convert(from, to, settings, log);
  return log.str();
}

TEST_F(Files, DataOfLammpsSurviveConversion) {
  EXPECT_NE(converted(folder / "g.data", folder / "a.data").find("3 grains"), std::string::npos);
  const std::string text = readText(folder / "a.data");
  converted(folder / "a.data", folder / "b.lmp");
  EXPECT_EQ(readText(folder / "b.lmp"), text);
  EXPECT_NE(text.find("7 1 0.005 1200 0.03 0.04 0.07\n"), std::string::npos);
  EXPECT_NE(text.find("7 -0.5 0 0.25 0 0 10\n"), std::string::npos);
  EXPECT_NE(converted(folder / "g.data", folder / "a.csv").find("densities (1200 to 2500 kg/m³), types"),
            std::string::npos);
  converted(folder / "a.csv", folder / "c.data", {.density = 2500.0});
  EXPECT_NE(readText(folder / "c.data").find("3 1 0.005 2500 0.03 0.04 0.07\n"), std::string::npos);
  if (!WITH_FRAMES) return;
  converted(folder / "g.data", folder / "a.vtu");
  converted(folder / "a.vtu", folder / "d.data", {.density = 2500.0});
  EXPECT_NE(readText(folder / "d.data").find("7 1 0.005 2500 0.03 0.04 0.07\n"), std::string::npos);
  EXPECT_NE(readText(folder / "d.data").find("7 -0.5 0 0.25 0 0 10\n"), std::string::npos);
}

TEST_F(Files, StatesOfRunsBecomeData) {
  std::ostringstream log;
  const Scene scene = sceneOf(R"("particles": [{"from": "lammps", "file": "g.data", "velocity": [1, 0, 0]}],
      "periodic": {"box": [[0, 0, 0], [0.06, 0.06, 0.1]], "axes": ["x", "y"]},
      "output": {"checkpoints": 1},)",
                              folder.path());
  ASSERT_TRUE(run(scene, {.folder = folder / "run", .progress = false}, log));
  EXPECT_NE(converted(folder / "run", folder / "s.data").find("\"axes\": [\"x\", \"y\"]"), std::string::npos);
  const grain_io::GrainFile state = grain_io::readLammps(folder / "s.data");
  ASSERT_EQ(state.size(), 3u);
  EXPECT_EQ(state.box->upper, (Vec3{0.06, 0.06, 0.1}));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(state.density[i], i == 2 ? 1200.0 : 2500.0, 1e-11);
  EXPECT_NEAR(state.position[0].x, 0.01 + 1.1e-3, 1e-15);
  EXPECT_EQ(converted(folder / "run" / "checkpoint.state", folder / "t.data").empty(), false);
  EXPECT_EQ(readText(folder / "t.data"), readText(folder / "s.data"));
}

TEST_F(Files, ConversionsThatCannotBeAreRefused) {
  const auto says = [](auto&& action) {
    try {
      action();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  expectParts(says([&] { converted(folder / "y.txt", folder / "a.data"); }), {"no densities", "--density"});
  expectParts(says([&] { converted(folder / "g.data", folder / "a.data", {.density = 1.0}); }), {"of its own"});
  expectParts(says([&] { converted(folder / "g.data", folder / "a.stl"); }), {"'.stl'", ".vtkhdf"});
  expectParts(says([&] { converted(folder / "g.data", folder / "g.dump"); }), {"g.dump"});
  expectParts(says([&] { converted(folder / "none.data", folder / "a.data"); }), {"none.data"});
  converted(folder / "g.data", folder / "a.data");
  expectParts(says([&] { converted(folder / "a.data", folder / "a.data"); }), {"would replace itself"});
  EXPECT_EQ(readText(folder / "g.dump"), dump);
}

TEST_F(Files, ContentIsTold) {
  std::ostringstream out;
  ASSERT_TRUE(inspectGrains(folder / "g.dump", out));
  EXPECT_NE(out.str().find("1 spheres, radii 0.004"), std::string::npos);
  EXPECT_NE(out.str().find(R"("axes": ["x", "z"])"), std::string::npos);
  writeText(folder / "words.txt", "nothing of this kind\n");
  EXPECT_FALSE(inspectGrains(folder / "words.txt", out));
}

}  // namespace
}  // namespace dovetail::scene::test
