// What `check` warns of.
#include <sstream>

#include "../io/scratch_folder.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/solid_io/solid_files.hpp"
#include "warning_parts.hpp"

namespace dovetail::scene::test {
namespace {

TEST(SceneWarnings, StarterScenesHaveNone) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP();
  for (const char* const name : {"cantilever", "wave", "plate", "tray", "bonded-beam"})
    EXPECT_EQ(warningsOf(readScene(starter(name))), "") << name;
}

TEST(SceneWarnings, DeepContactsAndGrainsInSolids) {
  expectParts(warningsOf(spheres(R"({"at": [0, 0, 0], "radius": 0.1}, {"at": [0.18, 0, 0], "radius": 0.1},
                                    {"at": [5, 0, 0], "radius": 0.1}, {"at": [5.199, 0, 0], "radius": 0.1})")),
              {"1 contact is deeper than 5 % of a radius", "20 % (particle 0 with particle 1)"});
  const std::string floor = R"("walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],)";
  expectParts(warningsOf(floor + spheres(R"({"at": [0, 0, 0.08], "radius": 0.1})")), {"20 % (particle 0 with a wall)"});
  EXPECT_EQ(warningsOf(floor + spheres(R"({"at": [0, 0, 0.099], "radius": 0.1})")), "");
  expectParts(warningsOf(heldBlock + onBlock + spheres(R"({"at": [0.5, 0.5, 0.5], "radius": 0.01})")),
              {"1 grain has its centre in \"b\""});
  EXPECT_EQ(warningsOf(heldBlock + onBlock + spheres(R"({"at": [0.5, 0.5, 1.02], "radius": 0.01})")), "");
}

TEST(SceneWarnings, NamesThatNobodyUses) {
  const std::string sets = R"(, "sets": [{"name": "top", "place": "side", "side": "z+"},
      {"name": "mid", "place": "plane", "point": [0, 0, 0.5], "normal": [0, 0, 1]}],
      "loads": [{"type": "pressure", "on": "top", "pressure": 1}])";
  const std::string found = warningsOf(heldBlock + sets + onBlock);
  expectParts(found, {"the set \"mid\" is not used"});
  EXPECT_EQ(found.find("\"top\""), std::string::npos);
  expectParts(
      warningsOf(R"("contacts": [{"between": "a", "and": "a", "law": "linear", "stiffness": 1e4}], "particles": [
      {"from": "list", "name": "beam", "density": 1, "spheres": [{"at": [0, 0, 0], "radius": 1}]}],)"),
      {"group of particles \"beam\"", "contact material \"a\""});
}

TEST(SceneWarnings, HertzOnSingleNodesAndSolidsThatFall) {
  const std::string hertz = R"("contact": {"law": "Hertz", "youngs_modulus": 1e6, "poisson_ratio": 0.3},)";
  const auto of = [&](const std::string& kernel, const std::string& supports) {
    return warningsOf(sceneFromText("{" + hertz + R"("gravity": [0, 0, -1],)" +
                                        replaced(heldBlock, R"("supports": [{"on": "z-"}])", supports) +
                                        replaced(onBlock, "\"advised\"", kernel) + onTop + end + "}",
                                    "s.json", "/"));
  };
  expectParts(of("\"none\"", R"("supports": [])"),
              {"write \"kernel\": \"advised\"", "\"b\" has no supports and falls"});
  expectParts(of("5", R"("supports": [{"on": "z-"}])"), {"times as wide as advised"});
  EXPECT_EQ(of("\"advised\"", R"("supports": [{"on": "z-"}])"), "");
}

TEST(SceneWarnings, WallsThatAreOpenClosedOrCutThemselves) {
  const io::test::ScratchFolder folder;
  const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<geometry::Facet> closed{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  mesh_io::writeStl(folder / "closed.stl", x, closed);
  const std::vector<Vec3> crossing{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, -1}, {0.2, 0.2, 1}, {0.4, 0.2, 1}};
  mesh_io::writeStl(folder / "crossing.stl", crossing, std::vector<geometry::Facet>{{0, 1, 2}, {3, 4, 5}});
  const auto wall = [&](const std::string& file, const std::string& more) {
    return warningsOf(R"("walls": [{"shape": "mesh", "file": ")" + file + "\"" + more + "}],", folder.path());
  };
  expectParts(wall("closed.stl", ""), {"walls.0 is closed, but is treated as a sheet"});
  EXPECT_EQ(wall("closed.stl", R"(, "closed": true)"), "");
  mesh_io::writeStl(folder / "cavity.stl", x, std::vector<geometry::Facet>{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}});
  expectParts(wall("cavity.stl", R"(, "closed": true)"), {"walls.0 is closed with its normals inwards"});
  expectParts(wall("crossing.stl", ""), {"intersects itself at 1 pairs of facets, the first 0 and 1"});
}

TEST(SceneWarnings, SettlingWhileWallsMove) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP() << "steady motion is refused";
  const auto of = [](const std::string& motion) {
    return warningsOf(sceneFromText(R"({"walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], )" +
                                        motion + R"(}], "steps": {"dt": 1e-4}, "stages": [{"do": "relax"}]})",
                                    "s.json", "/"));
  };
  for (const char* const motion :
       {R"("velocity": [0, 0, "t"])", R"("displacement": [0, 0, "t"])", R"("turn": {"axis": [0, 0, 1], "angle": "t"})"})
    expectParts(of(motion), {"relaxes while walls"});
  EXPECT_EQ(of(R"("displacement": [0, 0, 0.1])"), "");
}

/// A lattice of grains on a bar; the last two keys are the solid's modulus and density.
std::string overlapWarnings(const std::string& borders, double modulus, double density, const std::string& cells) {
  const std::string particles =
      R"("particles": [{"from": "lattice", "lattice": "simple-cubic", "density": 2500, "radius": 0.05,
      "box": [[0, 0, 0], [0.4, 0.4, 2]]}],)";
  return warningsOf(sceneFromText(
      R"({"contact": {"law": "linear", "stiffness": 1e6},)" + particles +
          R"("solids": [{"name": "b", "mesh": "box", "cells": )" + cells + R"(, "box": [[0, 0, 1], [0.4, 0.4, 3]],
      "material": {"law": "neo-Hookean", "poisson_ratio": 0, "youngs_modulus": )" +
          std::to_string(modulus) + R"(, "density": )" + std::to_string(density) + R"(}, "supports": [{"on": "z+"}]}],
      "couplings": [{"type": "overlap", "solid": "b", )" +
          borders + R"(}], "steps": {"dt": "auto", "safety": 0.1}, "stages": [{"do": "run", "time": 1}]})",
      "s.json", "/"));
}

TEST(SceneWarnings, OverlapsWhoseModelsDoNotGoTogether) {
  const std::string borders = R"("solid_border": 1, "particle_border": 2)";
  const double bulk = 2500.0 * std::acos(-1.0) / 6.0, modulus = 1e6 / 0.1;
  EXPECT_EQ(overlapWarnings(borders, modulus, bulk, "[1, 1, 10]"), "");
  expectParts(overlapWarnings(borders, modulus, 2.0 * bulk, "[1, 1, 10]"), {"give the solid the density 1310"});
  expectParts(overlapWarnings(borders, 10.0 * modulus, bulk, "[1, 1, 10]"), {"10 times that of the grains"});
  expectParts(overlapWarnings(R"("solid_border": 1, "particle_border": 1.25)", modulus, bulk, "[1, 1, 20]"),
              {"0.25 m thick, with elements of 0.1 m and grains of 0.1 m"});
}

std::string bodyOf(const std::string& keys, const std::string& supports = R"("supports": [{"on": "x-"}])") {
  return R"("solids": [{"name": "b", "mesh": "box", "gravity": false,
      "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6, "poisson_ratio": 0, "density": 1000},)" +
         keys + "," + supports + "}],";
}

TEST(SceneWarnings, ThinPartsOfElementsThatBendWrongly) {
  const std::string beam = R"("box": [[0, 0, 0], [10, 1, 1]], )";
  expectParts(warningsOf(bodyOf(beam + R"("cells": [20, 1, 1], "formulation": "reduced")")),
              {"\"b\" has 1 layer of hex8 (\"reduced\")", "1 m thick", "many times too softly", "\"enhanced\""});
  expectParts(warningsOf(bodyOf(beam + R"("cells": [20, 2, 2], "formulation": "reduced")")),
              {"2 layers", "about 1.33 times too softly", "4 layers or more"});
  expectParts(warningsOf(bodyOf(beam + R"("cells": [20, 1, 1], "formulation": "mean-dilatation")")),
              {"1 layer", "about 1.42 times too softly"});
  expectParts(warningsOf(bodyOf(beam + R"("cells": [5, 2, 2])")), {"2 m long", "about 3 times too stiffly"});
  expectParts(warningsOf(bodyOf(beam + R"("cell": "tet4", "cells": [10, 1, 1])")),
              {"tet4", "about 4.1 times too stiffly", "tet10"});
  expectParts(warningsOf(bodyOf(R"("box": [[0, 0, 0], [3, 3, 0.1]], "cells": [10, 10, 1])")),
              {"0.1 m thick", "too stiffly"});
  for (const char* const right :
       {R"("cells": [20, 4, 4], "formulation": "reduced")", R"("cells": [20, 1, 1], "formulation": "enhanced")",
        R"("cells": [20, 1, 1], "formulation": "assumed-stress")", R"("cells": [40, 2, 2])",
        R"("cell": "hex20", "cells": [5, 1, 1])", R"("cell": "tet10", "cells": [10, 1, 1])",
        R"("cell": "hex27", "cells": [5, 1, 1])"})
    EXPECT_EQ(warningsOf(bodyOf(beam + right)), "") << right;
}

TEST(SceneWarnings, ThickBodiesAndHeldLayersHaveNone) {
  for (const char* const cell : {R"("formulation": "reduced")", R"("formulation": "mean-dilatation")",
                                 R"("formulation": "standard")", R"("cell": "tet4")"}) {
    const std::string elements = std::string(cell) + ", ";
    EXPECT_EQ(warningsOf(bodyOf(elements + R"("cells": [1, 1, 1], "box": [[0, 0, 0], [1, 1, 1]])")), "") << cell;
    EXPECT_EQ(warningsOf(bodyOf(elements + R"("cells": [1, 1, 4], "box": [[0, 0, 0], [1, 1, 4]])")), "") << cell;
    EXPECT_EQ(warningsOf(bodyOf(elements + R"("cells": [3, 3, 1], "box": [[0, 0, 0], [1, 1, 0.4]])")), "") << cell;
    const std::string pad = R"("cells": [10, 10, 1], "box": [[0, 0, 0], [10, 10, 1]])";
    EXPECT_EQ(warningsOf(bodyOf(elements + pad, R"("supports": [{"on": "z-"}])")), "") << cell;
    EXPECT_NE(warningsOf(bodyOf(elements + pad)), "") << cell;
  }
}

TEST(SceneWarnings, PartsThatAreOnlyStretchedHaveNone) {
  const auto bar = [](const std::string& loads, const std::string& supports = "") {
    return warningsOf(bodyOf(
        R"("formulation": "reduced", "cells": [20, 1, 1], "box": [[0, 0, 0], [10, 1, 1]], "loads": [)" + loads + "]",
        R"("supports": [{"on": "x-"})" + supports + "]"));
  };
  EXPECT_EQ(bar(R"({"type": "traction", "on": "x+", "traction": [1, 0, 0]})"), "");
  EXPECT_EQ(bar(R"({"type": "pressure", "on": "x+", "pressure": -1})"), "");
  EXPECT_EQ(bar("", R"(, {"on": "x+", "velocity": [1, 0, 0]})"), "");
  for (const char* const load : {R"({"type": "traction", "on": "x+", "traction": [1, 0, 1]})",
                                 R"({"type": "pressure", "on": "z+", "pressure": 1})",
                                 R"({"type": "traction", "on": "z+", "traction": [1, 0, 0]})"})
    expectParts(bar(load), {"which bend"});
  expectParts(bar("", R"(, {"on": "x+", "velocity": [0, 0, 1]})"), {"which bend"});
}

/// A plate of one layer below a block whose nodes are tied to it.
TEST(SceneWarnings, LayersThatAreTiedToThickBodiesHaveNone) {
  const io::test::ScratchFolder folder;
  fem::SolidMesh both = fem::boxOf(fem::ElementShape::hex8, {10, 10, 1}, {0, 0, 0}, {10, 10, 0.5});
  const fem::SolidMesh block = fem::boxOf(fem::ElementShape::hex8, {13, 13, 8}, {0, 0, 0.5}, {10, 10, 8});
  const int offset = static_cast<int>(both.X.size());
  std::vector<int> foot = block.nodeSets.at("z-");
  for (int& n : foot) n += offset;
  both.X.insert(both.X.end(), block.X.begin(), block.X.end());
  for (const int n : block.groups[0].node) both.groups[0].node.push_back(n + offset);
  both.nodeSets = {{"foot", foot}, {"side", both.nodeSets.at("x-")}};
  both.faceSets = {{"top", both.faceSets.at("z+")}};
  solid_io::writeSolid(both, folder / "two.inp");
  const auto of = [&](const std::string& ties) {
    return warningsOf(R"("solids": [{"name": "b", "mesh": "file", "file": "two.inp", "supports": [{"on": "side"}],
      "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6, "poisson_ratio": 0, "density": 1000}, "ties": [)" +
                          ties + "]}],",
                      folder.path());
  };
  expectParts(of(""), {"0.5 m thick", "which bend"});
  EXPECT_EQ(of(R"({"nodes": "foot", "faces": "top", "tolerance": 1e-6})"), "");
}

TEST(SceneWarnings, ParametersThatNobodyNames) {
  expectParts(warningsOf(R"("let": {"width": 0.01, "depth": 2}, "gravity": [0, 0, "-width"],)" + ground + onTop),
              {"The parameter \"depth\" is not used"});
  EXPECT_EQ(warningsOf(R"("let": {"width": 0.01, "depth": "2*width"}, "gravity": [0, 0, "-depth"],)" + ground + onTop),
            "");
}

TEST(SceneWarnings, BodiesThatNothingHolds) {
  const auto of = [](const std::string& supports, const std::string& more) {
    return warningsOf(replaced(heldBlock, R"("supports": [{"on": "z-"}])", R"("supports": [)" + supports + "]") + more +
                      "}],");
  };
  const auto loads = [&](const std::string& all) { return of("", R"(, "loads": [)" + all + "]"); };
  const std::string right = R"({"on": "x+", "type": "pressure", "pressure": 1000})";
  const std::string left = R"({"on": "x-", "type": "pressure", "pressure": 1000})";
  expectParts(loads(right), {"Nothing holds \"b\" along x", "-1000 N", "accelerates without end"});
  EXPECT_EQ(loads(right + "," + left), "");
  if (WITH_EXPRESSIONS) {
    EXPECT_EQ(loads(replaced(right, "1000", "\"1000*(t < 1e-4)\"")), "");
  }
  const std::string sides = R"({"on": "x-", "components": ["x"]}, {"on": "y-", "components": ["y"]})";
  const auto pulled = [&](const std::string& supports) {
    return warningsOf(R"("gravity": [0, 0, -9.81],)" +
                      replaced(heldBlock, R"("supports": [{"on": "z-"}])", R"("supports": [)" + supports + "]") +
                      "}],");
  };
  expectParts(pulled(sides), {"Nothing holds \"b\" along z, where gravity pulls"});
  EXPECT_EQ(pulled(sides + R"(, {"on": "z-", "components": ["z"]})"), "");
}

TEST(SceneWarnings, GravityThatPullsAwayFromAll) {
  const auto of = [](const std::string& gravity, const std::string& more) {
    return warningsOf(spheres(R"({"at": [0.5, 0.5, 0.5], "radius": 0.1})") + R"("gravity": [0, 0, )" + gravity +
                      R"(], "walls": [{"shape": "box", "box": [[0, 0, 0], [1, 1, 1]], "open": ["z+"]}],)" + more);
  };
  expectParts(of("0.97", ""), {"pulls all grains away", "(walls.0 is open at z+)", "reverse gravity"});
  EXPECT_EQ(of("0.97", R"("domain": {"box": [[-1, -1, -1], [2, 2, 9]], "escape": "remove"},)"), "");
  EXPECT_EQ(of("-0.02", ""), "");
}

TEST(SceneWarnings, RegionsWhereNobodyComes) {
  const std::string box = spheres(R"({"at": [0.5, 0.5, 0.5], "radius": 0.1})") +
                          R"("gravity": [0, 0, -0.02], "walls": [{"shape": "box", "box": [[0, 0, 0], [1, 1, 1]]}],)";
  const auto outlet = [&](const std::string& region) {
    return warningsOf(box + R"("outlets": [{"region": )" + region + "}],");
  };
  expectParts(outlet("[[0, 0, -2], [1, 1, -1]]"), {"The region of outlets.0 lies behind a wall"});
  expectParts(outlet("[[0, 0, 50], [1, 1, 60]]"), {"The region of outlets.0 is out of reach of all grains"});
  EXPECT_EQ(outlet("[[0, 0, 0], [0.2, 0.2, 0.2]]"), "");
  expectParts(warningsOf(box + R"("output": {"series": 1e-4, "probes": [{"name": "p", "of": "region",
                "box": [[300, 300, 0], [400, 400, 100]]}]},)"),
              {"The region of the probe \"p\" is out of reach"});
}

TEST(SceneWarnings, SupportsThatSayNothing) {
  const auto of = [](const std::string& support) {
    return warningsOf(replaced(heldBlock, R"({"on": "z-"})", R"({"on": "z-"},)" + support) + "}],");
  };
  expectParts(of(R"({"on": "z+", "components": ["x"], "velocity": [0, 0, 1]})"),
              {"solids.0.supports.1 moves along z, which is not among its components"});
  expectParts(of(R"({"on": "z-"})"), {"are identical: leave one of them out"});
  expectParts(of(R"({"on": "z+", "velocity": [0, 0, 50]})"), {"solids.0.supports.1 moves at up to 50 m/s", "mm/s"});
  EXPECT_EQ(of(R"({"on": "z+", "components": ["z"], "velocity": [0, 0, 1]})"), "");
}

TEST(SceneWarnings, SizesAndPressuresAgainstTheMaterial) {
  const auto of = [](const std::string& from, const std::string& to) {
    return warningsOf(replaced(heldBlock, from, to) + "}],");
  };
  expectParts(of("[1, 1, 1]]", "[1, 1, 0.001]]"), {"Element 0 of \"b\" is 1000 times as long as it is high"});
  expectParts(of(R"("supports")", R"("loads": [{"on": "x+", "type": "pressure", "pressure": 2e6}], "supports")"),
              {"solids.0.loads.0.pressure reaches 2e+06 Pa, above youngs_modulus"});
  expectParts(of(R"("supports")", R"("loads": [{"on": "x+", "type": "pressure", "pressure": "2 mPa"}], "supports")"),
              {"solids.0.loads.0.pressure is 0.002 Pa", "0.002 MPa"});
  expectParts(of(R"("neo-Hookean")", R"("J2", "yield_stress": 1e3, "hardening": 2e7)"),
              {"hardening is 2e+07 Pa, above youngs_modulus"});
}

TEST(SceneWarnings, SolidsThatGoThroughFloors) {
  const auto of = [](const std::string& velocity) {
    return warningsOf(R"("walls": [{"shape": "plane", "point": [0, 0, -0.001], "normal": [0, 0, 1]}],)" +
                      replaced(heldBlock, R"("supports": [{"on": "z-"}])", R"("velocity": [0, 0, )" + velocity + "]") +
                      "}],");
  };
  expectParts(of("-2"), {"\"b\" moves into walls.0 and will pass through it"});
  EXPECT_EQ(of("2"), "");
}

TEST(SceneWarnings, LidsThatJumpAreNotFast) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP();
  const auto of = [](const std::string& z) {
    return warningsOf(
        R"("walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "displacement": [0, 0, )" + z +
        "]}]," + spheres(R"({"at": [0, 0, 2], "radius": 0.1})"));
  };
  expectParts(of("\"-100*t\""), {"walls.0 moves at up to 100 m/s"});
  EXPECT_EQ(of("\"t < 5e-4 ? 0 : -1\""), "");
}

TEST(SceneWarnings, GrainsAtOnePlaceAndBoxesOfOneGrain) {
  expectParts(warningsOf(spheres(R"({"at": [0, 0, 0], "radius": 0.1}, {"at": [0, 0, 0], "radius": 0.1})")),
              {"Particles 0 and 1 have the same centre"});
  expectParts(warningsOf(R"("particles": [{"from": "lattice", "box": [[0, 0, 0], [1, 1, 1]], "radius": 0.1,
                            "distance": 2.2, "density": 2500}],)"),
              {"particles.0 is one grain", "2.2 m"});
}

TEST(SceneWarnings, StagesThatAreTooShort) {
  const auto of = [](const std::string& stage) {
    const Scene scene =
        sceneFromText("{" + law + onTop + R"("steps": {"dt": 1e-5}, "stages": [)" + stage + "]}", "s.json", "/");
    return warningsOf(scene);
  };
  expectParts(of(R"({"do": "run", "time": 1e-6})"), {"stages.0.time is 1e-06 s, and a step"});
  expectParts(of(R"({"do": "relax", "macro_steps": 1})"), {"stages.0.macro_steps is 1"});
  EXPECT_EQ(of(R"({"do": "run", "time": 1e-3})"), "");
}

/// What hinders the start is seldom all that is wrong.
TEST(SceneWarnings, AreToldBesideARefusal) {
  const Scene scene = sceneOf(replaced(heldBlock, "[1, 1, 1]]", "[1, 1, 0.001]]") + "}],");
  Scene hurried = scene;
  hurried.steps.dt.number = 1.0;
  std::ostringstream log;
  EXPECT_THROW(check(hurried, log), InputError);
  expectParts(log.str(), {"WARNING: Element 0 of \"b\" is 1000 times"});
}

}  // namespace
}  // namespace dovetail::scene::test
