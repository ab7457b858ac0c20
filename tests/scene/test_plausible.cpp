// Numbers that are likely not meant, and what check tells of outputs.
#include <filesystem>
#include <fstream>
#include <sstream>

#include "../io/scratch_folder.hpp"
#include "dovetail/scene/execute.hpp"
#include "warning_parts.hpp"

namespace dovetail::scene::test {
namespace {

/// Warnings of a bed of two grains with a part in another one's place.
std::string bedWith(const std::string& part, const std::string& in) {
  const std::string text = R"("gravity": [0, 0, -9.81],
    "contact": {"law": "linear", "stiffness": 1e5, "restitution": 0.8, "friction": 0.3},
    "particles": [{"from": "list", "density": 2500, "velocity": [0, 0, 0], "spheres": [
      {"at": [0, 0, 0.02], "radius": 0.01}, {"at": [0.03, 0, 0.02], "radius": 0.01}]}],)" +
                           ground + R"("steps": {"dt": "auto"}, "stages": [{"do": "run", "time": 1e-3}])";
  return warningsOf(sceneFromText("{" + replaced(text, part, in) + "}", "s.json", "/"));
}

/// With the step that the scene's parts ask for.
std::string warningsAtAnyStep(const std::string& middle) {
  return warningsOf(sceneFromText(
      "{" + law + middle + R"("steps": {"dt": "auto"}, "stages": [{"do": "run", "time": 1e-3}]})", "s.json", "/"));
}

TEST(ScenePlausible, NumbersOfAnotherUnitAreToldWithIt) {
  EXPECT_EQ(bedWith("2500", "2500"), "");
  expectParts(bedWith("2500", "2.5"), {"particles.0.density is 2.5 kg/m3", "write \"2.5 g/cm3\" if that is meant"});
  expectParts(bedWith("\"friction\": 0.3", "\"friction\": 30"),
              {"contact.friction is 30,", "write 0.577 if an angle of 30 deg is meant"});
  const std::string hertz = R"("law": "Hertz", "poisson_ratio": 0.3, "youngs_modulus": )";
  expectParts(bedWith(R"("law": "linear", "stiffness": 1e5)", hertz + "\"2 mPa\""),
              {"contact.youngs_modulus is 0.002 Pa", "write \"2 MPa\" if that is meant"});
  expectParts(bedWith(R"("law": "linear", "stiffness": 1e5)", hertz + "70"), {"write \"70 GPa\" if that is meant"});
  expectParts(bedWith("1e5", "1e-6"), {"contact.stiffness is 1e-06 N/m", "check its unit", "In the first step"});
  expectParts(bedWith("-9.81]", "-981000]"), {"gravity is -981000 m/s2", "write \"-981000 mm/s2\""});
  expectParts(bedWith(R"("velocity": [0, 0, 0])", R"("velocity": [0, 0, -20000])"), {"write \"-20000 mm/s\""});
}

TEST(ScenePlausible, ValuesJustOutsideOfWhatIsUsual) {
  expectParts(bedWith("2500", "7.85"), {"particles.0.density is 7.85 kg/m3", "write \"7.85 g/cm3\""});
  EXPECT_EQ(bedWith("2500", "30"), "");
  expectParts(bedWith("-9.81]", "-9810]"), {"gravity is -9810 m/s2", "write \"-9810 mm/s2\""});
  EXPECT_EQ(
      warningsOf(R"("particles": [{"from": "list", "density": 2000, "spheres": [{"at": [0, 0, 0], "radius": 100}]}],)"),
      "");
}

TEST(ScenePlausible, SpringsHarderThanDiamond) {
  expectParts(bedWith("1e5", "1e13"),
              {"contact.stiffness is 1e+13 N/m, which makes grains of 0.01 m radius as stiff as a "
               "material of 1e+15 Pa",
               "write 5e+08 N/m"});
  EXPECT_EQ(bedWith("1e5", "1e10"), "");
}

TEST(ScenePlausible, BridgesLargerThanGrains) {
  const auto withBridge = [](const char* volume) {
    return bedWith(
        R"("restitution": 0.8)",
        std::string(R"("restitution": 0.8, "liquid_bridge": {"surface_tension": 0.07, "volume": )") + volume + "}");
  };
  expectParts(withBridge("\"5 cm3\""), {"contact.liquid_bridge.volume is 5e-06 m3", "smallest grain", "\"mm3\""});
  EXPECT_EQ(withBridge("\"5 mm3\""), "");
}

TEST(ScenePlausible, GrainsOfVeryDifferentSizes) {
  const auto of = [](const std::string& radius) {
    return warningsAtAnyStep(
        spheres(R"({"at": [0, 0, 0], "radius": 0.01}, {"at": [1, 0, 0], "radius": )" + radius + "}"));
  };
  expectParts(of("9e-6"), {"particles.0.spheres.1.radius is 9e-06 m and particles.0.spheres.0.radius 0.01 m"});
  EXPECT_EQ(of("1.1e-5"), "");
}

TEST(ScenePlausible, BondsThatBreakAtOnceOrOnlyCreep) {
  const auto of = [](const std::string& keys) {
    return warningsAtAnyStep(R"("particles": [{"from": "list", "name": "g", "density": 2500, "spheres": [
        {"at": [0, 0, 0], "radius": 0.01}, {"at": [0.02, 0, 0], "radius": 0.01}]}],
        "bonds": [{"group": "g", "gap": 1e-4, "youngs_modulus": 1e8, "poisson_ratio": 0.2, )" +
                             keys + "}],");
  };
  EXPECT_EQ(of(R"("tensile_strength": 5e5, "damping_time": 2e-6)"), "");
  expectParts(of(R"("tensile_strength": 0.5)"), {"bonds.0.tensile_strength is 0.5 Pa", "write \"0.5 MPa\""});
  expectParts(of(R"("damping_time": 2)"), {"bonds.0.damping_time is 2 s", "for a damping ratio of 5 %"});
}

TEST(ScenePlausible, StrengthAboveTheModulus) {
  const auto of = [](const std::string& stress) {
    return warningsOf(replaced(heldBlock, R"("neo-Hookean")", R"("J2", "yield_stress": )" + stress) +
                      R"(, "formulation": "enhanced")" + onBlock + onTop);
  };
  expectParts(of("1e7"),
              {"solids.0.material.yield_stress is 1e+07 Pa, above youngs_modulus, 1e+06 Pa", "\"b\" hardly yields"});
  EXPECT_EQ(of("1e4"), "");
}

TEST(ScenePlausible, OneFaultOfManyItemsIsToldOnce) {
  const auto one = [](const std::string& density, const std::string& x) {
    return R"({"from": "list", "density": )" + density + R"(, "spheres": [{"at": [)" + x +
           R"(, 0, 0], "radius": 0.01}]})";
  };
  const std::string found =
      warningsOf(R"("particles": [)" + one("2.5", "0") + "," + one("2.7", "1") + "," + one("2.9", "2") + "],");
  expectParts(found, {"particles.0.density", "The same holds for 2 more."});
  EXPECT_EQ(found.find("particles.1.density"), std::string::npos);
}

TEST(ScenePlausible, SoundThatNoMaterialHas) {
  expectParts(warningsOf(replaced(heldBlock, "1e6", "500") + onBlock + onTop), {"Waves in \"b\" travel at 0.707 m/s"});
  EXPECT_EQ(warningsOf(replaced(heldBlock, "1e6", "5000") + onBlock + onTop), "");
}

TEST(ScenePlausible, ElementsThatLock) {
  const auto of = [](const std::string& poisson, const std::string& formulation, const std::string& cell,
                     const std::string& material = "neo-Hookean") {
    return warningsOf(replaced(replaced(replaced(heldBlock, "0.3", poisson), "neo-Hookean", material), R"("cells")",
                               R"("formulation": ")" + formulation + R"(", "cell": ")" + cell + R"(", "cells")") +
                      onBlock + onTop);
  };
  EXPECT_EQ(of("0.45", "standard", "hex8"), "");
  expectParts(of("0.49999", "standard", "hex8"),
              {"\"b\" hardly changes its volume (poisson_ratio 0.49999)", "write \"formulation\": \"enhanced\""});
  expectParts(of("0.499", "standard", "tet4"), {"tet4 elements lock", "take tet10"});
  EXPECT_EQ(of("0.499", "enhanced", "hex8"), "");
  expectParts(of(R"(0.3, "yield_stress": 1e3)", "standard", "hex8", "J2"),
              {"\"b\" flows at constant volume (J2), for which hex8"});
  EXPECT_EQ(of(R"(0.3, "yield_stress": 1e3)", "enhanced", "hex8", "J2"), "");
}

TEST(ScenePlausible, FramesAreCountedAndTooManyAreTold) {
  const auto of = [](const std::string& interval) {
    return sceneOf(spheres(R"({"at": [0, 0, 0], "radius": 0.1})") + R"("output": {"frames": )" + interval + "},");
  };
  const auto checked = [&](const std::string& interval) {
    std::ostringstream log;
    check(of(interval), log);
    return log.str();
  };
  if (!WITH_FRAMES) GTEST_SKIP();
  expectParts(checked("1e-4"), {"frames: 11 of about 2.", "kB on disk"});
  EXPECT_EQ(checked("1e-4").find("WARNING"), std::string::npos);
  Scene every = of("1e-9");
  std::get<RunFor>(every.stages[0].kind).time = 1.0;
  expectParts(warningsOf(every), {"requests 100001 frames, one at every macro step", "such as 0.005 s"});
}

TEST(ScenePlausible, OutputsThatWriteNothingOrTooOften) {
  const auto of = [](const std::string& output) {
    return warningsOf(spheres(R"({"at": [0, 0, 0], "radius": 0.1})") + R"("output": {)" + output + "},");
  };
  if (!WITH_FRAMES) GTEST_SKIP();
  expectParts(of(R"("series": 1e-9, "frames": 1e-4)"),
              {"output.series requests a row every 1e-09 s, which is shorter than a macro step (1e-05 s)"});
  expectParts(of(R"("frames": 1e-9)"), {"output.frames requests a frame every 1e-09 s", "such as 1e-05 s"});
  EXPECT_EQ(of(R"("series": 1e-5)"), "");
  expectParts(of(R"("contents": ["grains", "contacts"])"), {"output.contents is given and output.frames is not"});
  expectParts(of(R"("frames": 1e-4, "contents": [])"), {"output.contents is empty, so that frames hold nothing"});
  expectParts(of(R"("frames": 1e-4, "contents": ["grains", "walls"])"),
              {"output.contents has \"walls\", and the scene has no wall that is a mesh"});
  expectParts(of(R"("frames": 1e-4, "contents": ["grains", "bonds"])"), {"the scene has no bonds"});
  expectParts(of(R"("frames": 1e-4, "contents": ["grains", "solids"])"), {"the scene has no solids"});
  EXPECT_EQ(of(R"("frames": 1e-4)"), "");
}

TEST(ScenePlausible, InsertionsThatBringNobody) {
  const auto of = [](const std::string& rate) {
    return warningsOf(R"("insertions": [{"density": 2500, "radius": {"smallest": 0.01, "largest": 0.01},
        "region": [[0, 0, 0], [1, 1, 1]], "number_per_second": )" +
                      rate + "}],");
  };
  expectParts(of("10"), {"insertions.0 inserts only 0.01 grains in 0.001 s", "1000 per second"});
  EXPECT_EQ(of("1001"), "");
}

TEST(ScenePlausible, RoomOfFramesIsThatOfTheirFiles) {
  if (!WITH_FRAMES) GTEST_SKIP();
  const io::test::ScratchFolder folder;
  const Scene scene = sceneOf(
      R"("particles": [{"from": "lattice", "lattice": "simple-cubic", "radius": 0.05, "distance": 0.0999, "density": 2500,
      "box": [[0, 0, 0], [1, 1, 1]]}], "output": {"frames": 1, "contents": ["grains", "spin", "forces", "contacts"]},)");
  std::ostringstream log, ran;
  check(scene, log);
  run(scene, {.folder = folder.path() / "out", .progress = false}, ran);
  double bytes = 0.0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path() / "out"))
    if (entry.path().string().find("_000001.v") != std::string::npos) bytes += static_cast<double>(entry.file_size());
  const std::string text = log.str();
  const double told = 1e3 * std::stod(text.substr(text.find(" of about ") + 10));
  EXPECT_NEAR(told / bytes, 1.0, 0.1) << text;
}

TEST(ScenePlausible, RunsTellItInTheirSummary) {
  const io::test::ScratchFolder folder;
  std::ostringstream log;
  run(sceneOf(replaced(spheres(R"({"at": [0, 0, 0], "radius": 0.1})"), "2500", "2.5")),
      {.folder = folder.path() / "out", .progress = false}, log);
  std::ostringstream summary;
  summary << std::ifstream(folder.path() / "out" / "summary.txt").rdbuf();
  for (const std::string& text : {log.str(), summary.str()}) expectParts(text, {"WARNING: particles.0.density is 2.5"});
}

}  // namespace
}  // namespace dovetail::scene::test
