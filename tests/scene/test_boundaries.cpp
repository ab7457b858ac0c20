// Sets by place and ties of solids of a scene.
#include "../io/scratch_folder.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/solid_io/solid_files.hpp"
#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

const std::string boundedBlock =
    R"("solids": [{"name": "b", "mesh": "box", "cells": [4, 2, 2], "box": [[0, 0, 0], [4, 2, 2]],
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000},)";

TEST(SceneSets, HoldTheNodesAndFacesOfTheirPlace) {
  const Built built = build(sceneOf(boundedBlock + R"("sets": [
      {"name": "left", "place": "side", "side": "x-"},
      {"name": "corner", "place": "box", "box": [[-1, -1, -1], [1.5, 1.5, 0.5]]},
      {"name": "slice", "place": "plane", "point": [2, 0, 0], "normal": [1, 0, 0]},
      {"name": "diagonal", "place": "plane", "point": [0, 0, 0], "normal": [1, -1, 0], "tolerance": 0.1},
      {"name": "ball", "place": "sphere", "centre": [4, 2, 2], "radius": 1.1}]}],)"));
  const fem::SolidMesh& mesh = built.meshes[0];
  EXPECT_EQ(mesh.nodeSets.at("left"), mesh.nodeSets.at("x-"));
  EXPECT_EQ(mesh.faceSets.at("left").size(), mesh.faceSets.at("x-").size());
  EXPECT_EQ(mesh.nodeSets.at("corner").size(), 4U);
  EXPECT_EQ(mesh.faceSets.at("corner").size(), 1U);
  EXPECT_EQ(mesh.nodeSets.at("slice").size(), 9U);
  EXPECT_FALSE(mesh.faceSets.contains("slice"));
  EXPECT_EQ(mesh.nodeSets.at("diagonal").size(), 9U);
  EXPECT_EQ(mesh.nodeSets.at("ball").size(), 4U);
}

TEST(SceneSets, ServeSupportsLoadsAndCouplings) {
  Built built = started(
      sceneOf(boundedBlock + R"("sets": [{"name": "foot", "place": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]},
        {"name": "roof", "place": "side", "side": "z+"}],
      "supports": [{"on": "foot"}], "loads": [{"type": "pressure", "on": "roof", "pressure": "1 kPa"}]}],
      "particles": [{"from": "list", "density": 2500, "spheres": [{"at": [2, 1, 2.09], "radius": 0.1}]}],
      "couplings": [{"type": "surface", "solid": "b", "on": "roof"}],)"));
  EXPECT_GT(built.run->grains.particles.f[0].z, 10.0);
  for (const int n : built.meshes[0].nodeSets.at("z-"))
    EXPECT_EQ(built.run->solid(0).nodes().fixed[static_cast<std::size_t>(n)], 7);
}

TEST(SceneSets, EmptyAndDoubleOnesAreRefused) {
  expectParts(
      refusalOfRun(boundedBlock + R"("sets": [{"name": "a", "place": "sphere", "centre": [9, 9, 9], "radius": 1}]}],)"),
      {"no nodes in this place", "sets.0"});
  expectParts(refusalOfRun(boundedBlock + R"("sets": [{"name": "x-", "place": "side", "side": "x-"}]}],)"),
              {"has a set \"x-\"", "sets.0"});
  expectParts(refusalOfRun(boundedBlock + R"("loads": [{"type": "traction", "on": "top", "traction": [0, 0, 1]}]}],)"),
              {"\"top\"", "loads.0"});
  expectParts(refusalOfRun(boundedBlock +
                           R"("sets": [{"name": "s", "place": "plane", "point": [0, 0, 0], "normal": [0, 0, 0]}]}],)"),
              {"no length", "sets.0"});
}

TEST(SceneSets, TiesPassUniformStrain) {
  const io::test::ScratchFolder folder;
  fem::SolidMesh left = fem::boxOf(fem::ElementShape::hex8, {2, 2, 2}, {0, 0, 0}, {1, 1, 1});
  fem::SolidMesh right = fem::boxOf(fem::ElementShape::hex8, {2, 4, 4}, {1, 0, 0}, {2, 1, 1});
  const int offset = static_cast<int>(left.X.size());
  left.X.insert(left.X.end(), right.X.begin(), right.X.end());
  for (int& n : right.groups[0].node) n += offset;
  left.groups[0].node.insert(left.groups[0].node.end(), right.groups[0].node.begin(), right.groups[0].node.end());
  std::vector<int> slaves = right.nodeSets.at("x-"), end = right.nodeSets.at("x+");
  for (std::vector<int>* set : {&slaves, &end})
    for (int& n : *set) n += offset;
  left.nodeSets = {{"start", left.nodeSets.at("x-")}, {"fine", slaves}, {"end", end}};
  left.faceSets = {{"coarse", left.faceSets.at("x+")}};
  solid_io::writeSolid(left, folder / "two.inp");
  Built built = started(sceneOf(R"("solids": [{"name": "b", "mesh": "file", "file": "two.inp", "stepping": "implicit",
      "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6, "poisson_ratio": 0, "density": 1000},
      "ties": [{"nodes": "fine", "faces": "coarse", "tolerance": 1e-6}],
      "supports": [{"on": "start"}, {"on": "end", "velocity": [1, 0, 0]}]}],)",
                                folder.path()));
  built.run->advance(20);
  const fem::Nodes& nodes = built.run->solid(0).nodes();
  double fine = 0.0, coarse = 0.0;
  for (const int n : built.meshes[0].nodeSets.at("fine"))
    fine = std::max(fine, std::abs(nodes.u[static_cast<std::size_t>(n)].x));
  for (std::size_t n = 0; n < static_cast<std::size_t>(offset); ++n)
    if (nodes.X[n].x == 1.0) coarse = std::max(coarse, std::abs(nodes.u[n].x));
  EXPECT_GT(coarse, 0.0);
  EXPECT_NEAR(fine, coarse, 1e-12 * coarse);
}

}  // namespace
}  // namespace dovetail::scene::test
