// Parts of scenes that are looked at together.
#include "../io/scratch_folder.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "warning_parts.hpp"

namespace dovetail::scene::test {
namespace {

const std::string grain = spheres(R"({"at": [0.1, 0.1, 0.1], "radius": 0.02})");
const std::string two = R"("particles": [{"from": "list", "name": "g", "density": 2500, "spheres": [
    {"at": [0, 0, 0.02], "radius": 0.02}, {"at": [0.04, 0, 0.02], "radius": 0.02}]}],)";

TEST(SceneTogether, GrainsOnTheWrongSideOfWallsAreRefused) {
  const auto of = [](const std::string& wall) { return refusalOfRun(grain + R"("walls": [)" + wall + "],"); };
  expectParts(
      of(R"({"shape": "plane", "point": [0, 0, 0.5], "normal": [0, 0, 1]})"),
      {"1 grain lies behind the plane", "by 0.4 m (particle 0 at (0.1, 0.1, 0.1) m)", "walls.0", "reverse the normal"});
  expectParts(of(R"({"shape": "box", "box": [[1, 1, 1], [2, 2, 2]]})"), {"outside of the box", "make the box larger"});
  expectParts(of(R"({"shape": "cylinder", "point": [1, 0, 0], "axis": [0, 0, 1], "radius": 0.2})"),
              {"outside of the cylinder", "\"inside\""});
  expectParts(of(R"({"shape": "sphere", "centre": [0.1, 0.1, 0.2], "radius": 0.3, "inside": false})"),
              {"within the sphere"});
  expectParts(of(R"({"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "displacement": [0, 0, 0.2]})"),
              {"starts displaced by (0, 0, 0.2) m", "let it start at 0"});
  EXPECT_EQ(of(R"({"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]})"), "");
}

TEST(SceneTogether, HeldGrainsMayLieInWalls) {
  EXPECT_EQ(refusalOfRun(replaced(two, "0, 0, 0.02", "0, 0, -0.01") + ground + R"("drives": [{"group": "g"}],)"), "");
}

TEST(SceneTogether, GrainsOutsideOfTheDomain) {
  const auto of = [](const std::string& more) {
    return grain + R"("domain": {"box": [[0, 0, 0], [0.05, 1, 1]])" + more + "},";
  };
  expectParts(refusalOfRun(of("")),
              {"1 grain lies outside of the domain", "by 0.05 m", "domain]", "domain.box larger"});
  const Built built = build(sceneOf(of(R"(, "escape": "remove")")));
  ASSERT_EQ(built.notes.size(), 1U);
  expectParts(built.notes[0], {"1 grain lies outside of the domain", "are removed at once"});
}

TEST(SceneTogether, GrainsAreBondedAndDrivenOnce) {
  const std::string bond = R"("youngs_modulus": 1e7, "poisson_ratio": 0.2, "gap": 1e-3)";
  for (const char* const with : {"", R"("with": "g", )"})
    expectParts(
        refusalOfRun(two + R"("bonds": [{"group": "g", )" + bond + R"(}, {"group": "g", )" + with + bond + "}],"),
        {"the grains of \"g\" are bonded by another item", "bonds.1"});
  expectParts(refusalOfRun(two + R"("drives": [{"group": "g"}, {"group": "g", "velocity": [0, 0, 1]}],)"),
              {"the grains of \"g\" are driven by another item", "drives.1"});
}

TEST(SceneCompany, WhatIsThereTwiceOrCancels) {
  const std::string plane = R"({"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]})";
  expectParts(warningsOf(grain + R"("walls": [)" + plane + "," + plane + "],"), {"walls.0 and walls.1 are identical"});
  const auto loaded = [](const std::string& loads) {
    return warningsOf(heldBlock + R"(, "loads": [)" + loads + "]" + onBlock +
                      spheres(R"({"at": [0.5, 0.5, 1.1], "radius": 0.1})"));
  };
  const auto pressure = [](const std::string& on, const std::string& value) {
    return R"({"type": "pressure", "on": ")" + on + R"(", "pressure": )" + value + "}";
  };
  expectParts(loaded(pressure("z+", "10") + "," + pressure("z+", "-10")), {"loads.0 and solids.0.loads.1", "cancel"});
  expectParts(loaded(pressure("z-", "10")), {"solids.0.loads.0 acts on \"z-\", all of whose nodes are held"});
  EXPECT_EQ(loaded(pressure("z+", "10") + "," + pressure("x+", "-10")), "");
}

TEST(SceneCompany, ProbesFarFromWhatTheyFollow) {
  const auto of = [](const std::string& probe) {
    return warningsOf(grain + heldBlock + onBlock + R"("output": {"series": 1e-4, "probes": [{"name": "p", )" + probe +
                      "}]},");
  };
  expectParts(of(R"("of": "node", "solid": "b", "at": [101, 1, 1])"),
              {"The probe \"p\" follows the nearest node, which is 100 m from its place, at (1, 1, 1) m"});
  expectParts(of(R"("of": "grain", "at": [0.1, 0.1, 9])"), {"nearest grain, which is 8.9 m"});
}

TEST(SceneCompany, InsertionsWhereNobodyCanEnter) {
  const auto of = [](const std::string& region, const std::string& more = "") {
    return warningsOf(R"("insertions": [{"density": 2500, "radius": {"smallest": 0.01, "largest": 0.01},
        "number_per_second": 10000, "region": )" +
                      region + "}]," + ground + more);
  };
  expectParts(of("[[0, 0, -2], [1, 1, -1]]"), {"The region of insertions.0 is behind walls or outside of the domain"});
  expectParts(of("[[0, 0, -2], [1, 1, 1]]"), {"is 66.7 % behind walls"});
  expectParts(of("[[0, 0, 1], [1, 1, 2]]", R"("domain": {"box": [[5, 5, 0], [6, 6, 9]]},)"), {"outside of the domain"});
  expectParts(of("[[0, 0, 5], [1, 1, 6]]", grain + R"("outlets": [{"region": [[0, 0, 0], [1, 1, 1]]}],)"),
              {"1 grains lie in the region of outlets.0"});
  expectParts(of("[[0, 0, 1], [1, 1, 2]]", R"("outlets": [{"region": [[0, 0, 0], [1, 1, 1.5]]}],)"),
              {"overlaps that of outlets.0"});
  EXPECT_EQ(of("[[0, 0, 0], [1, 1, 1]]"), "");
}

TEST(SceneCompany, SolidsThatNoGrainsComeTo) {
  const auto of = [](const std::string& places, const std::string& more = "") {
    return warningsOf(heldBlock + onBlock + spheres(places) + more);
  };
  expectParts(of(R"({"at": [50, 0.5, 2], "radius": 0.1})"), {"No grains can reach \"b\"", "does nothing"});
  expectParts(of(R"({"at": [0.5, 0.5, 90], "radius": 0.1})"), {"No grains can reach \"b\""});
  EXPECT_EQ(of(R"({"at": [0.5, 0.5, 90], "radius": 0.1})", R"("gravity": [0, 0, -10],)").find("No grains"),
            std::string::npos);
  EXPECT_EQ(of(R"({"at": [50, 0.5, 0.5], "radius": 0.1, "velocity": [-60000, 0, 0]})").find("No grains"),
            std::string::npos);
}

TEST(SceneCompany, GrainsThatFallForEver) {
  const auto of = [](const std::string& parts, const std::string& stage = "relax") {
    return warningsOf(sceneFromText(
        "{" + law + parts + R"("gravity": [0, 0, -10], "steps": {"dt": 1e-5}, "stages": [{"do": ")" + stage + R"("}]})",
        "s.json", SCENES));
  };
  expectParts(of(two), {"2 of 2 grains have nothing below them"});
  EXPECT_EQ(of(two + ground), "The group of particles \"g\" is not used.\n");
  const std::string tray = R"("solids": [{"name": "b", "mesh": "box", "cells": [1, 1, 1],
      "box": [[-0.1, -0.1, -1], [0.01, 0.1, 0]], "supports": [{"on": "z-"}], "material": {"law": "neo-Hookean",
      "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000}}], "couplings": [{"type": "surface", "solid": "b"}],)";
  expectParts(of(two + tray), {"1 of 2 grains have nothing below them"});
}

TEST(SceneCompany, PathsThatDoNotBeginAtZero) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP();
  expectParts(warningsOf(grain + R"("walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1],
      "displacement": [0, 0, "0.01 + t"]
}],)"),
              {"walls.0 starts displaced by (0, 0, 0.01) m, as its displacement"});
  expectParts(warningsOf(two + R"("drives": [{"group": "g", "displacement": [0, 0, "0.01 + t"]}],)"),
              {"The grains of drives.0 lie (0, 0, 0.01) m from their path"});
}

TEST(SceneCompany, PartsThatDoNothing) {
  expectParts(warningsOf(grain + R"("walls": [{"shape": "box", "box": [[0, 0, 0], [1, 1, 1]],
      "open": ["x-", "x+", "y-", "y+", "z-", "z+"]}],)"),
              {"walls.0 is a box with all six sides open"});
  expectParts(warningsOf(heldBlock + onBlock), {"The scene has no grains, so that the coupling of \"b\" does nothing"});
  EXPECT_EQ(warningsOf(heldBlock + R"(}, {"name": "snow", "mesh": "points",
                "points": {"from": "box", "box": [[0.4, 0.4, 1.1], [0.6, 0.6, 1.3]]}, "grid": {"spacing": 0.1},
                "velocity": [0, 0, -1],
                "material": {"law": "neo-Hookean", "youngs_modulus": 1e5, "poisson_ratio": 0.3, "density": 1000}}],
                "couplings": [{"type": "surface", "solid": "b"}, {"type": "points", "solid": "snow"}],)"),
            "");
  const std::string above = spheres(R"({"at": [0.5, 0.5, 1.1], "radius": 0.1, "velocity": [0, 0, -1]})");
  const auto on = [&](const std::string& faces) {
    return warningsOf(heldBlock + replaced(onBlock, R"("surface",)", R"("surface", "on": ")" + faces + "\",") + above);
  };
  expectParts(on("z-"), {"All grains are behind the faces \"z-\" of \"b\"", "couplings.0"});
  EXPECT_EQ(on("z+"), "");
  expectParts(warningsOf(heldBlock + replaced(onBlock, "\"advised\"", "1e-9") + above),
              {"1e-09 m wide, far below an element"});
  expectParts(refusalOfRun(replaced(heldBlock, R"("on": "z-")", R"("on": "z-", "components": [])") + onBlock + above),
              {"components is empty, and the support on \"z-\" holds nothing", "solids.0"});
}

TEST(SceneCompany, GrainsThatFlyAway) {
  const auto of = [](const std::string& velocity) {
    return warningsOf(heldBlock + onBlock +
                      spheres(R"({"at": [0.5, 0.5, 1.2], "radius": 0.1, "velocity": [0, 0, )" + velocity + "]}"));
  };
  expectParts(of("50"), {"No grains can reach \"b\""});
  EXPECT_EQ(of("-101").find("No grains"), std::string::npos);
}

TEST(SceneCompany, ClumpsInPieces) {
  const auto of = [](const std::string& places) {
    return warningsOf(R"("clumps": [{"density": 2500, "at": [0, 0, 0], "spheres": [{"at": [0, 0, 0], "radius": 0.1},
        )" + places + "]}],");
  };
  EXPECT_EQ(of(R"({"at": [0.15, 0, 0], "radius": 0.1}, {"at": [0.3, 0, 0], "radius": 0.1})"), "");
  expectParts(of(R"({"at": [0.3, 0, 0], "radius": 0.1})"), {"clumps.0.spheres.1 does not touch the others"});
  expectParts(of(R"({"at": [0.15, 0, 0], "radius": 0.1}, {"at": [0, 0, 0], "radius": 0.1})"),
              {"clumps.0.spheres.0 and clumps.0.spheres.2 are the same sphere"});
}

TEST(SceneCompany, PartsThatDoNotGoWithAPeriod) {
  const auto of = [](const std::string& length, const std::string& more) {
    return warningsOf(grain + R"("periodic": {"box": [[0, 0, 0], [)" + length + R"(, 1, 1]], "axes": ["x"]},)" + more);
  };
  expectParts(of("1", R"("domain": {"box": [[0, 0, 0], [0.5, 1, 1]]},)"),
              {"domain.box does not span the period along x"});
  EXPECT_EQ(of("1", R"("domain": {"box": [[0, 0, 0], [1, 0.5, 1]]},)"), "");
  expectParts(of("0.5", heldBlock + onBlock), {"The solid \"b\" is 1 m wide along x, where the period is 0.5 m"});
  EXPECT_EQ(of("1", heldBlock + onBlock).find("wide along"), std::string::npos);
  expectParts(of("1", R"("gravity": [1, 0, 0],)"), {"Gravity acts along x, which is periodic"});
  expectParts(of("1", R"("gravity": [1, 0, 0],)" + ground), {"Gravity acts along x, which is periodic"});
  EXPECT_EQ(of("1", R"("gravity": [0.01, 0, -0.01],)" + ground), "");
}

TEST(SceneCompany, SolidsThatMoveIntoEachOtherOrHoldAnInsertion) {
  const auto of = [](const std::string& velocity) {
    return warningsOf(heldBlock +
                      R"(}, {"name": "ram", "mesh": "box", "cells": [1, 1, 1], "box": [[0, 0, 1.1], [1, 1, 2]],
        "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000},
        "velocity": [0, 0, )" +
                      velocity + "]" + onBlock);
  };
  expectParts(of("-101"), {"\"b\" and \"ram\" move into each other and will overlap"});
  EXPECT_EQ(of("-99").find("move into"), std::string::npos);
  expectParts(warningsOf(heldBlock + onBlock + R"("insertions": [{"density": 2500, "number_per_second": 10000,
      "radius": {"smallest": 0.01, "largest": 0.01}, "region": [[0, 0, 0], [1, 1, 0.9]]}],)"),
              {"100 % of the region of insertions.0 lies in \"b\""});
}

TEST(SceneCompany, BondsThatReachThroughGrainsAndFastRims) {
  const auto of = [](const std::string& gap) {
    return warningsOf(sceneFromText("{" + law + two + R"("bonds": [{"group": "g", "youngs_modulus": 1e7,
        "poisson_ratio": 0.2, "gap": )" +
                                        gap + R"(}], "stages": [{"do": "run", "time": 1e-3}]})",
                                    "s.json", "/"));
  };
  expectParts(of("0.05"), {"bonds.0.gap is 0.05 m, larger than a grain", "write about 0.002 m"});
  EXPECT_EQ(of("0.001"), "");
  if (!WITH_EXPRESSIONS) GTEST_SKIP();
  const auto drum = [](const std::string& angle) {
    return warningsOf(grain + R"("walls": [{"shape": "cylinder", "point": [0, 0, 0], "axis": [0, 1, 0], "radius": 0.5,
        "turn": {"axis": [0, 1, 0], "angle": ")" +
                      angle + "\"}}],");
  };
  expectParts(drum("9000*t"), {"walls.0.turn reaches 9000 rad/s, with the rim at 4500 m/s", "\"(9000*t)*pi/180\""});
  EXPECT_EQ(drum("9*t").find("rim"), std::string::npos);
}

TEST(SceneCompany, SurfacesOfAnotherUnit) {
  const io::test::ScratchFolder folder;
  const std::vector<Vec3> x{{-100, -100, 0}, {100, -100, 0}, {0, 100, 0}};
  mesh_io::writeStl(folder / "plate.stl", x, std::vector<geometry::Facet>{{0, 1, 2}});
  const auto of = [&](const std::string& scale) {
    return warningsOf(grain + R"("walls": [{"shape": "mesh", "file": "plate.stl", "scale": )" + scale + "}],",
                      folder.path());
  };
  expectParts(of("1"), {"The surface of walls.0 is 283 m across, and all grains together 0.04 m", "\"scale\": 0.001"});
  expectParts(of("1e-6"), {"The surface of walls.0 is 0.000283 m across, and the smallest grain 0.04 m"});
  EXPECT_EQ(of("0.001"), "");
}

TEST(SceneMessages, WallsThatDoNotRepeatAreNamed) {
  const auto of = [](const std::string& length, const std::string& wall) {
    return refusalOfRun(grain + R"("periodic": {"box": [[0, 0, 0], [)" + length +
                        R"(, 1, 1]], "axes": ["x"]}, "walls": [)" + wall + "],");
  };
  expectParts(of("1", R"({"shape": "plane", "point": [0, 0, 0], "normal": [1, 0, 0]})"),
              {"its normal is not perpendicular to the period along x", "walls.0]"});
  expectParts(of("1", R"({"shape": "cylinder", "point": [0, 0, 0], "axis": [1, 1, 0], "radius": 2})"),
              {"its axis is oblique to the period along x", "walls.0]"});
  expectParts(of("0.07", ""),
              {"the period along x is 0.07 m, below twice the largest diameter", "periodic]", "0.08 m"});
}

TEST(SceneMessages, HaveWordsOfScenes) {
  const auto of = [](const std::string& keys) {
    return refusalOfRun(replaced(heldBlock, R"("cells")", keys + R"(, "cells")") + onBlock);
  };
  for (const std::string& message :
       {of(R"("cell": "tet4", "formulation": "enhanced")"), of(R"("cell": "tet4", "formulation": "mean-dilatation")"),
        of(R"("formulation": "assumed-stress")"), of(R"("ties": [{"nodes": "x+", "faces": "z-", "tolerance": 1e-9}])"),
        of(R"("sets": [{"name": "s", "place": "sphere", "centre": [9, 9, 9], "radius": 1}])")}) {
    expectParts(message, {"solids.0"});
    for (const char* const word : {"::", "makeSolid", "tieInterface", "nodesWhere"})
      EXPECT_EQ(message.find(word), std::string::npos) << message;
  }
  expectParts(refusalOfRun(R"("particles": [{"from": "lattice", "box": [[0, 0, 0], [1e-3, 1, 1]], "radius": 0.1,
      "density": 1}],)"),
              {"along axis x"});
}

TEST(SceneMessages, TellTheCauseAndNotWhatItLeadsTo) {
  const auto of = [](const std::string& parts) {
    try {
      started(sceneFromText("{" + law + parts + R"("stages": [{"do": "run", "time": 1}]})", "s.json", SCENES));
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  expectParts(of(""), {"the scene has neither grains nor solids"});
  expectParts(of(replaced(grain, "0.1, 0.1, 0.1", "9, 9, 9") +
                 R"("domain": {"box": [[0, 0, 0], [1, 1, 1]], "escape": "remove"},)"),
              {"all grains lie outside of the domain"});
  const std::string heldBlock =
      R"("solids": [{"name": "b", "mesh": "box", "cells": [2, 2, 2], "box": [[0, 0, 0], [1, 1, 1]],
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000},
      "sets": [{"name": "mid", "place": "plane", "point": [0, 0, 0.5], "normal": [0, 0, 1]}],
      "loads": [{"on": "mid", "type": "pressure", "pressure": 1}]}],)";
  expectParts(of(heldBlock), {"this set has nodes", "mid"});
  if (!WITH_EXPRESSIONS) return;
  expectParts(of(R"("walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1],
      "displacement": [0, 0, "0*sin(t)/t"]}],)"),
              {"the expression gives", "walls.0"});
}

TEST(SceneMessages, FoldersAreNoFiles) {
  const auto of = [](const std::string& middle) { return refusal("{" + law + middle + end + "}"); };
  for (const char* const from : {"csv", "vtk"})
    expectParts(of(R"("particles": [{"from": ")" + std::string(from) + R"(", "file": ".", "density": 1}],)"),
                {" is a folder", "particles.0", "give the name of a file in it"});
  expectParts(of(R"("walls": [{"shape": "mesh", "file": "."}],)"), {" is a folder", "walls.0"});
  expectParts(of(R"("include": ["."],)"), {"there is a folder in place of the scene", "include"});
}

/// Discs and a solid of plane strain that meet along its lines.
TEST(SceneTogether, GrainsMeetSolidsOfPlaneStrain) {
  const auto sceneWith = [](const std::string& coupling) {
    return sceneOf(
        R"("gravity": [0, -9.81, 0],
    "particles": [{"from": "list", "density": 1000, "velocity": [-0.2, -1, 0],
      "spheres": [{"at": [0.13, 0.26, 0], "radius": 0.05},
      {"at": [0.41, 0.25, 0], "radius": 0.04}]}],
    "solids": [{"name": "slab", "mesh": "box", "cell": "quad8", "cells": [4, 2, 1], "box": [[0, 0, 0], [0.4, 0.2, 0.1]],
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e5, "poisson_ratio": 0.3, "density": 1000},
      "supports": [{"on": "y-"}]}],
    "couplings": [{"type": "surface", "solid": "slab")" +
        coupling + "}],");
  };
  Built built = started(sceneWith(""));
  const double joules = built.run->kineticEnergy();
  built.run->advance(6000);
  EXPECT_LT(std::abs(built.run->ledger().residual()), 2e-3 * joules);
  const auto totals = built.run->totals();
  EXPECT_LT(totals.ontoSolids.y, -0.5);
  EXPECT_LT(norm(totals.residual.linear), 1e-12 * totals.turnedOver);
  for (const Vec3& x : built.run->grains.particles.x) EXPECT_LE(std::abs(x.z), 1e-15);
  expectParts(refusalOf(sceneWith(R"(, "kernel": 0.1)")), {"couplings.0", "plane strain", "without a kernel"});
  expectParts(refusalOf(sceneWith(R"(, "surface": "smooth")")), {"couplings.0", "without a kernel"});
}

}  // namespace
}  // namespace dovetail::scene::test
