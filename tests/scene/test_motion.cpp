// Walls, supports, loads and grains that follow expressions of time.
#include <numbers>

#include "../io/scratch_folder.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/model/term.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

constexpr double pi = std::numbers::pi;

class SceneMotion : public testing::Test {
protected:
  void SetUp() override {
    if (!WITH_EXPRESSIONS) GTEST_SKIP() << "expressions need muParser";
  }
};

const std::string movedBlock =
    R"("solids": [{"name": "b", "mesh": "box", "cells": [2, 2, 2], "box": [[0, 0, 0], [0.1, 0.2, 0.1]],
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000},)";

TEST_F(SceneMotion, PrimitiveWallsFollowTheirPaths) {
  Built built = started(sceneOf(R"("let": {"f": "20 Hz", "a": "10 cm"}, "walls": [
      {"shape": "plane", "point": [1000, 0, -9], "normal": [0, 0, 2], "displacement": ["sin(2*pi*f*t)*a", 0.5, 0]},
      {"shape": "plane", "point": [0, 0, -9], "normal": [0, 0, 1], "velocity": ["min(t, 0.005)*1", 0, "cos(50*t)*a"]},
      {"shape": "cylinder", "point": [0, 0, 0], "axis": [0, 1, 0], "radius": 8, "turn": {"axis": [0, 0, 3], "angle": "20*t^2"}}],)"));
  built.run->advance(1000);
  const double t = built.run->time();
  const dem::PrimitiveWall& first = dem::primitiveWall(built.run->grains, 0);
  EXPECT_NEAR(first.point.x, 1000.0 + 0.1 * std::sin(40.0 * pi * t), 3e-13);
  EXPECT_EQ(first.point.y, 0.5);
  EXPECT_NEAR(first.velocity.x, 4.0 * pi * std::cos(40.0 * pi * t), 1e-6);
  const dem::PrimitiveWall& second = dem::primitiveWall(built.run->grains, 1);
  EXPECT_NEAR(second.point.x, 0.5 * 0.005 * 0.005 + 0.005 * (t - 0.005), 1e-12);
  EXPECT_NEAR(second.point.z, -9.0 + 0.1 / 50.0 * std::sin(50.0 * t), 1e-14);
  EXPECT_NEAR(second.velocity.z, 0.1 * std::cos(50.0 * t), 1e-14);
  const dem::PrimitiveWall& third = dem::primitiveWall(built.run->grains, 2);
  EXPECT_NEAR(third.axis.x, -std::sin(20.0 * t * t), 1e-14);
  EXPECT_NEAR(third.angularVelocity.z, 40.0 * t, 1e-8);
}

TEST_F(SceneMotion, MeshWallsFollowTheirPaths) {
  const io::test::ScratchFolder folder;
  const std::vector<Vec3> x{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}};
  const std::vector<geometry::Facet> facets{{0, 1, 2}};
  mesh_io::writeStl(folder / "w.stl", x, facets);
  Built built = started(sceneOf(R"("walls": [{"shape": "mesh", "file": "w.stl", "velocity": [0, 0, "t"],
      "turn": {"axis": [0, 0, 1], "angle": "0.3 + t"}}],)",
                                folder.path()));
  const auto expectPlace = [&] {
    const double t = built.run->time(), angle = 0.3 + t;
    const auto& wall = dem::meshWall(built.run->grains, 0).wall;
    EXPECT_NEAR(wall.x[1].x, 1.0 + 2.0 * std::cos(angle) + std::sin(angle), 1e-14);
    EXPECT_NEAR(wall.x[1].z, 0.5 * t * t, 1e-14);
    EXPECT_NEAR(wall.v[1].z, t, 1e-14);
    EXPECT_NEAR(wall.v[1].y, 2.0 * std::cos(angle) + std::sin(angle), 1e-7);
  };
  expectPlace();
  built.run->advance(500);
  expectPlace();
}

/// What the ledger miss of grains in a box that is shaken, J; and the work of its walls.
std::array<double, 2> missedBy(double dt) {
  Scene scene = sceneFromText(R"({"contact": {"law": "linear", "stiffness": 1e4},
      "particles": [{"from": "lattice", "lattice": "simple-cubic", "box": [[0, 0, 0], [0.2, 0.1, 0.1]], "radius": 0.02,
        "distance": 0.039, "density": 2500}],
      "walls": [{"shape": "box", "box": [[0, 0, 0], [0.2, 0.1, 0.12]], "displacement": ["(1 - cos(300*t))*5e-3", 0, 0]}],
      "stages": [{"do": "run", "time": 0.05}]})",
                              "s.json", "/");
  scene.steps.dt = {dt, ""};
  Built built = started(scene);
  double missed = 0.0;
  for (int k = 0; k < 100; ++k) {
    built.run->advance(std::llround(2e-4 / dt));
    missed = std::max(missed, std::abs(built.run->ledger().residual()));
  }
  return {missed, std::abs(built.run->ledger().joules("particles: work of walls and drives (minus)"))};
}

TEST_F(SceneMotion, BooksOfShakenWallsCloseAtSecondOrder) {
  const auto coarse = missedBy(4e-5), fine = missedBy(1e-5);
  EXPECT_GT(fine[1], 0.05);
  EXPECT_LT(fine[0], 1e-4 * fine[1]);
  EXPECT_LT(fine[0], coarse[0] / 8.0) << fine[0] << " " << coarse[0];
}

TEST_F(SceneMotion, SupportsFollowTheirPaths) {
  Built built = started(sceneOf(movedBlock + R"("supports": [{"on": "x-"},
      {"on": "x+", "components": ["x"], "displacement": ["sin(100*t)*1e-3", 0, 0]},
      {"on": "x+", "components": ["y"], "velocity": [0, "t", 0]}]}],)"));
  built.run->advance(1000);
  const fem::Nodes& nodes = built.run->solid(0).nodes();
  const double t = built.run->time();
  for (std::size_t n = 0; n < nodes.X.size(); ++n) {
    if (nodes.X[n].x == 0.0) {
      EXPECT_EQ(nodes.u[n], Vec3{});
    }
    if (nodes.X[n].x < 0.1) continue;
    EXPECT_NEAR(nodes.u[n].x, 1e-3 * std::sin(100.0 * t), 1e-16);
    EXPECT_NEAR(nodes.u[n].y, 0.5 * t * t, 1e-15);
    EXPECT_NEAR(nodes.v[n].y, t, 1e-10);
  }
  EXPECT_GT(std::abs(built.run->ledger().joules("b: supports")), 1e-4);
  EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-4 * std::abs(built.run->ledger().joules("b: supports")));
}

Vec3 forceAt(const fem::Model& model, const std::string& name, double t) {
  std::vector<Vec3> f(model.nodes.X.size());
  for (const auto& term : model.terms)
    if (term->name().starts_with(name)) term->addForces(model.nodes, {t, 0.0, nullptr}, f);
  Vec3 sum;
  for (const Vec3& one : f) sum += one;
  return sum;
}

TEST_F(SceneMotion, LoadsAreThoseOfTheirTime) {
  Built built = started(sceneOf(movedBlock + R"("supports": [{"on": "x-"}], "loads": [
      {"type": "pressure", "on": "x+", "pressure": "2e3*t"},
      {"type": "pressure", "on": "y+", "pressure": "1 kPa", "follows": false},
      {"type": "traction", "on": "z+", "traction": [0, "5*t", "2 Pa"]}]}],)"));
  const fem::Model& model = *built.run->solid(0).model;
  const auto expectNear = [](const Vec3& a, const Vec3& b) { EXPECT_LT(norm(a - b), 1e-12 * (1.0 + norm(b))); };
  expectNear(forceAt(model, "load 0", 3.0), {-6e3 * 0.02, 0, 0});
  expectNear(forceAt(model, "load 1", 3.0), {0, -1e3 * 0.01, 0});
  expectNear(forceAt(model, "load 2", 3.0), {0, 15.0 * 0.02, 2.0 * 0.02});
  built.run->advance(2000);
  EXPECT_LT(built.run->ledger().joules("b: load 1 on y+"), 0.5);  // what it stores: it is constant
  EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-6);
}

TEST_F(SceneMotion, GoOnFromAStateWithTheSameDigits) {
  const Scene scene = sceneOf(R"("let": {"a": 3},)" + movedBlock +
                              R"("supports": [{"on": "x-", "velocity": ["sin(a*100*t)*0.1", 0, 0]}],
        "loads": [{"type": "pressure", "on": "x+", "pressure": "2e3*t"}]
}],
      "particles": [{"from": "list", "name": "g", "density": 2500, "spheres": [{"at": [0.05, 0.1, 0.1299], "radius": 0.03}]},
                    {"from": "list", "name": "h", "density": 2500, "spheres": [{"at": [0.05, 0.14, 0.15], "radius": 0.03}]}],
      "drives": [{"group": "h", "velocity": [0, "cos(a*t)*-0.2", 0]}],
      "walls": [{"shape": "plane", "point": [0, 0, 0.17], "normal": [0, 0, -1], "velocity": [0, 0, "-5*t"]}],
      "couplings": [{"type": "surface", "solid": "b", "on": "skin"}],)");
  Built whole = started(scene);
  whole.run->advance(150);
  const std::vector<char> state = whole.run->save();
  whole.run->advance(250);
  // As a resumed run has it: from the scene in full.
  const std::string text = sceneText(scene);
  const Scene again = sceneFromText(text, "s.json", "/");
  EXPECT_EQ(sceneText(again), text);
  Built resumed = started(again);
  resumed.run->load(state);
  resumed.run->advance(250);
  EXPECT_EQ(whole.run->save(), resumed.run->save());
  EXPECT_NE(whole.run->ledger().joules("particles: work of walls and drives (minus)"), 0.0);
}

TEST_F(SceneMotion, WhatCannotBeIsRefused) {
  const std::string plane = R"("walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1],)";
  expectParts(refusalOfRun(plane + R"("velocity": [0, 0, "2*q"]}],)"), {"\"2*q\"", "time t", "walls.0"});
  expectParts(refusalOfRun(plane + R"("velocity": [0, 0, 1], "displacement": [0, 0, "t"]}],)"),
              {"velocity and a displacement", "walls.0"});
  expectParts(refusalOfRun(plane + R"("angular_velocity": [0, 0, 1], "turn": {"axis": [0, 0, 1], "angle": "t"}}],)"),
              {"angular velocity and a turn", "walls.0"});
  expectParts(refusalOfRun(plane + R"("turn": {"axis": [0, 0, 0], "angle": "t"}}],)"), {"no length", "walls.0"});
  expectParts(refusalOfRun(plane + R"("velocity": [0, 0, "5 mm"]}],)"), {"in m", "write one in m/s"});
  expectParts(refusalOfRun(R"("let": {"t": 1},)"), {"\"t\" cannot name a parameter"});
  expectParts(refusalOfRun("\"let\": {\"" + std::string(100, 'a') + "\": 1},"),
              {"cannot name a parameter", "less than 100"});
  Built built = started(sceneOf(plane + R"("velocity": [0, 0, "1/(5e-4 - t) > 0 ? 1 : sqrt(0 - t)*1"]}],)"));
  EXPECT_THROW(built.run->advance(100), NumericalError);
}

}  // namespace
}  // namespace dovetail::scene::test
