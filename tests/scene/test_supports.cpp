// Supports and ties that ask for the same, and those that contradict each other.
#include "../io/scratch_folder.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/solid_io/solid_files.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

std::string plateHeldBy(const std::string& supports) {
  return R"("solids": [{"name": "b", "mesh": "box", "cells": [2, 2, 2], "box": [[0, 0, 0], [1, 1, 1]],
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000},
      "supports": [)" +
         supports + "]}],";
}

TEST(SceneSupports, ThatShareNodesMayAskForTheSame) {
  for (const char* const pair :
       {R"({"on": "x-"}, {"on": "z-"})", R"({"on": "x-", "components": ["x"]}, {"on": "z-"})",
        R"({"on": "x-", "velocity": [0, 0, 1]}, {"on": "z-", "velocity": [0, 0, 1]})",
        R"({"on": "x-"}, {"on": "z-", "displacement": [0, 0, 0]})",
        R"({"on": "x-", "components": ["x"]}, {"on": "z-", "components": ["z"], "velocity": [0, 0, 1]})"})
    EXPECT_EQ(refusalOfRun(plateHeldBy(pair)), "") << pair;
  if (!WITH_EXPRESSIONS) return;
  for (const char* const pair :
       {R"({"on": "x-", "displacement": [0, 0, "0.1*t"]}, {"on": "z-", "displacement": [0, 0, "t/10"]})",
        R"({"on": "x-", "displacement": [0, 0, "0.1*t"]}, {"on": "z-", "velocity": [0, 0, 0.1]})",
        R"({"on": "x-", "displacement": [0, 0, "0.1*t^2"]}, {"on": "z-", "velocity": [0, 0, "0.2*t"]})",
        R"({"on": "x-"}, {"on": "z-", "displacement": ["0", "0*t", 0]})"})
    EXPECT_EQ(refusalOfRun(plateHeldBy(pair)), "") << pair;
}

TEST(SceneSupports, ThatContradictEachOtherAreRefused) {
  const auto refused = [](const char* pair) {
    expectParts(refusalOfRun(plateHeldBy(pair)), {"component z of the node at (0, 0, 0) m", "supports item 0 on \"x-\"",
                                                  "leave \"z\" out of the components", "supports.1"});
  };
  refused(R"({"on": "x-"}, {"on": "z-", "velocity": [0, 0, 1]})");
  refused(R"({"on": "x-", "velocity": [0, 0, 1]}, {"on": "z-"})");
  refused(R"({"on": "x-", "velocity": [0, 0, 1]}, {"on": "z-", "velocity": [0, 0, 2]})");
  refused(R"({"on": "x-"}, {"on": "z-", "displacement": [0, 0, 0.1]})");
  if (!WITH_EXPRESSIONS) return;
  refused(R"({"on": "x-"}, {"on": "z-", "displacement": [0, 0, "0.1*t"]})");
  refused(R"({"on": "x-", "displacement": [0, 0, "0.1*t"]}, {"on": "z-", "displacement": [0, 0, "0.2*t"]})");
  refused(R"({"on": "x-", "velocity": [0, 0, "t"]}, {"on": "z-", "velocity": [0, 0, "t^2"]})");
  refused(R"({"on": "x-", "displacement": [0, 0, "0.1*t"]}, {"on": "z-", "velocity": [0, 0, 0.2]})");
}

TEST(SceneSupports, PathsThatDoNotBeginWhereTheNodesLieAreTold) {
  const auto notesOf = [](const char* support) {
    std::string all;
    for (const std::string& note : build(sceneOf(plateHeldBy(support))).notes) all += note + "\n";
    return all;
  };
  expectParts(notesOf(R"({"on": "z-"}, {"on": "z+", "displacement": [0, 0, 0.001]})"),
              {"WARNING", "\"b\"", "supports item 1 on \"z+\"", "component z by 0.001 m at once", "min(t/T, 1)"});
  EXPECT_EQ(notesOf(R"({"on": "z+", "displacement": [0, 0, 0]})").find("at once"), std::string::npos);
  EXPECT_EQ(notesOf(R"({"on": "z+", "velocity": [0, 0, 1]})").find("at once"), std::string::npos);
  if (!WITH_EXPRESSIONS) return;
  expectParts(notesOf(R"--({"on": "z+", "components": ["x"], "displacement": ["0.1*cos(3*t)", 0, "1"]})--"),
              {"component x by 0.1 m at once"});
  EXPECT_EQ(notesOf(R"--({"on": "z+", "displacement": [0, 0, "0.1*sin(3*t)"]})--").find("at once"), std::string::npos);
}

/// Two bricks that meet at x = 1, 2 × 2 faces on 3 × 3.
std::string refusalOfTied(const std::string& keys) {
  const io::test::ScratchFolder folder;
  fem::SolidMesh both = fem::boxOf(fem::ElementShape::hex8, {1, 2, 2}, {0, 0, 0}, {1, 1, 1});
  const fem::SolidMesh right = fem::boxOf(fem::ElementShape::hex8, {1, 3, 3}, {1, 0, 0}, {2, 1, 1});
  const int offset = static_cast<int>(both.X.size());
  std::vector<int> fine = right.nodeSets.at("x-");
  for (int& n : fine) n += offset;
  both.X.insert(both.X.end(), right.X.begin(), right.X.end());
  for (const int n : right.groups[0].node) both.groups[0].node.push_back(n + offset);
  const std::vector<int> coarse = both.nodeSets.at("x+");
  both.nodeSets = {{"fine", fine}, {"coarse", coarse}};
  both.faceSets = {{"meet", both.faceSets.at("x+")}};
  solid_io::writeSolid(both, folder / "two.inp");
  try {
    started(sceneOf(R"("solids": [{"name": "b", "mesh": "file", "file": "two.inp",
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000},
      "sets": [{"name": "south", "place": "side", "side": "y-"}, {"name": "foot", "place": "side", "side": "z-"},
               {"name": "edge", "place": "box", "box": [[0.9, 0, 0], [1.1, 0.01, 1]]}],)" +
                        keys + "}],",
                    folder.path()));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}
const std::string tieOfFeet = R"({"nodes": "fine", "faces": "meet", "tolerance": 1e-6})";

TEST(SceneSupports, RollersOnPlanesThroughATieAskForTheSame) {
  EXPECT_EQ(refusalOfTied(R"("supports": [{"on": "south", "components": ["y"]}, {"on": "foot", "components": ["z"]}],
      "ties": [)" + tieOfFeet +
                          "]"),
            "");
  EXPECT_EQ(refusalOfTied(R"("supports": [{"on": "foot", "velocity": [0, 1, 0]}], "ties": [)" + tieOfFeet + "]"), "");
}

TEST(SceneSupports, ThatContradictATieAreRefused) {
  expectParts(refusalOfTied(R"("supports": [{"on": "fine", "components": ["y"]}], "ties": [)" + tieOfFeet + "]"),
              {"component y of the node at (1, 0, 0) m is held by supports item 0 on \"fine\"", "tied to nodes of",
               "\"meet\"", "ties.0"});
  expectParts(refusalOfTied(R"("supports": [{"on": "fine", "components": ["y"]},
      {"on": "coarse", "components": ["y"], "velocity": [0, 1, 0]}], "ties": [)" +
                            tieOfFeet + "]"),
              {"tied to nodes of", "let the support hold those nodes too"});
  expectParts(refusalOfTied(R"("ties": [)" + tieOfFeet + ", " + tieOfFeet + "]"),
              {"in two ties", "at (1, 0, 0) m", "ties.1"});
}

}  // namespace
}  // namespace dovetail::scene::test
