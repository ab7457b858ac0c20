// Walls that keep a load, belts, and what stages change of walls, laws, gravity and loads.
#include <filesystem>
#include <map>

#include "../io/scratch_folder.hpp"
#include "build/changes.hpp"
#include "dovetail/coupling/rest.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "run/probes.hpp"
#include "scene_parts.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene::test {
namespace {

const std::string soft = R"("contact": {"law": "linear", "stiffness": 1e4, "restitution": 0.5, "friction": 0.3},)";
/// Four grains of 0.1 m on a floor.
const std::string four =
    R"("particles": [{"from": "lattice", "lattice": "simple-cubic", "box": [[0, 0, 0], [0.4, 0.4, 0.2]],
      "radius": 0.1, "density": 2500}],)";
const std::string lidAt = R"({"shape": "plane", "point": [0, 0, 0.2], "normal": [0, 0, -1], "name": "lid",)";
const std::string floorWall = R"({"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "name": "floor"})";

std::string wallsOf(const std::string& lid) { return R"("walls": [)" + floorWall + ", " + lidAt + lid + "}],"; }

Scene sceneWith(const std::string& parts, const std::string& stages, const std::string& steps = R"("dt": 1e-4)") {
  return sceneFromText("{" + soft + parts + R"("steps": {)" + steps + R"(}, "stages": [)" + stages + "]}", "s.json",
                       "/");
}
const std::string aRun = R"({"do": "run", "time": 0.1})";

const dem::PrimitiveWall& wallOf(const Built& built, std::size_t i) {
  return dem::primitiveWall(std::as_const(built.run->grains), i);
}
std::map<std::string, double> valuesOf(const Built& built, const Scene& scene) {
  const Probes probes(built, scene);
  std::vector<double> row;
  probes.add(built, row);
  std::map<std::string, double> values;
  for (std::size_t k = 0; k < row.size(); ++k) values[probes.names().at(k)] = row[k];
  return values;
}
double residualOf(Built& built) { return std::abs(built.run->ledger().residual()); }

/// Starts a stage as a run does.
void begin(Built& built, const Scene& scene, std::size_t stage) {
  beginStage(built, scene, stage, startOf(built, scene, stage), Grains::areThere);
}

class KeptLoadsOfSteps : public testing::TestWithParam<const char*> {};

TEST_P(KeptLoadsOfSteps, AreCarriedAtRest) {
  const Scene scene = sceneWith(
      four + wallsOf(R"("servo": {"keeps": "pressure", "pressure": 500, "area": 0.16, "axis": [0, 0, -3]})") +
          R"("output": {"probes": [{"name": "lid", "of": "wall", "wall": "lid"}, {"name": "floor", "of": "wall", "wall": 0}]},)",
      R"({"do": "relax"})", GetParam());
  Built built = started(scene);
  ASSERT_TRUE(coupling::relax(*built.run, {.tolerance = 1e-8}).atRest);
  auto values = valuesOf(built, scene);
  EXPECT_NEAR(values["lid_z_N"], 80.0, 1e-3 * 80.0);
  EXPECT_NEAR(values["floor_z_N"], -80.0, 1e-3 * 80.0);
  // 20 N on each of four columns of two springs of 1e4 N/m.
  EXPECT_NEAR(values["lid_uz_m"], -2.0 * 20.0 / 1e4, 1e-3 * 4e-3);
  EXPECT_NEAR(values["lid_mx_Nm"], 0.2 * values["lid_z_N"], 1e-3 * 16.0);
  EXPECT_NEAR(values["lid_my_Nm"], -0.2 * values["lid_z_N"], 1e-3 * 16.0);
  EXPECT_LT(residualOf(built), 2e-3 * built.run->ledger().joules("particles: contacts"));
}
INSTANTIATE_TEST_SUITE_P(Steps, KeptLoadsOfSteps,
                         testing::Values(R"("dt": 1e-4)", R"("dt": 1e-4, "per_macro_step": 4)"));

TEST(KeptLoads, AreCarriedInARunAndOverPeriods) {
  const Scene scene = sceneWith(
      R"("periodic": {"box": [[0, 0, -1], [0.6, 0.6, 1]], "axes": ["x", "y"]}, "particles": [{"from": "lattice",
        "lattice": "simple-cubic", "box": [[0, 0, 0], [0.6, 0.6, 0.2]], "radius": 0.1, "density": 2500}],)" +
          wallsOf(R"("servo": {"keeps": "force", "force": 40, "axis": [0, 0, -1], "mass": 3, "speed_limit": 0.05})"),
      aRun);
  Built built = started(scene);
  double fastest = 0.0;
  for (int k = 0; k < 200; ++k) {
    built.run->advance(50);
    fastest = std::max(fastest, std::abs(wallOf(built, 1).servo->speed));
  }
  EXPECT_LE(fastest, 0.05);
  EXPECT_NEAR(wallOf(built, 1).force.z, 40.0, 1e-3 * 40.0);
  EXPECT_NEAR(wallOf(built, 0).force.z, -40.0, 1e-3 * 40.0);
  EXPECT_LT(residualOf(built), 1e-3 * wallOf(built, 1).servo->work);
}

TEST(KeptLoads, LidsFallFreely) {
  const Scene scene =
      sceneWith(R"("gravity": [0, 0, -10],)" + four +
                    R"("walls": [{"shape": "plane", "point": [0, 0, 9], "normal": [0, 0, -1], "name": "lid",
             "servo": {"keeps": "force", "force": 0, "axis": [0, 0, -1], "mass": 3, "weight": true, "damping": 0}}],)",
                aRun);
  Built built = started(scene);
  built.run->advance(1000);
  EXPECT_NEAR(wallOf(built, 0).point.z, 9.0 - 0.5 * 10.0 * 0.01, 1e-12);
  EXPECT_NEAR(wallOf(built, 0).servo->speed, 1.0, 1e-12);
  EXPECT_LT(residualOf(built), 1e-9);
}

TEST(KeptLoads, FollowTheTime) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP() << "expressions need muParser";
  const Scene scene = sceneWith(
      four + wallsOf(R"("servo": {"keeps": "force", "force": "400*t", "axis": [0, 0, -1], "mass": 1})"), aRun);
  Built built = started(scene);
  built.run->advance(10000);
  EXPECT_NEAR(wallOf(built, 1).servo->load, 400.0, 1e-9);
  EXPECT_NEAR(wallOf(built, 1).force.z, 400.0, 0.02 * 400.0);
}

/// A rough disc turns on grains that hardly roll until the springs carry its torque.
TEST(KeptLoads, TorquesAreCarriedByTurning) {
  const Scene scene = sceneFromText(
      R"({"contact": {"law": "linear", "stiffness": 1e4, "restitution": 0.5, "friction": 0.3, "rolling": {"friction": 0.4,
        "stiffness_ratio": 0.3, "damping_ratio": 0.3}},)" +
          four + R"("walls": [)" + floorWall +
          R"(, {"shape": "plane", "point": [0.2, 0.2, 0.1998], "normal": [0, 0, -1],
        "name": "lid", "servo": {"keeps": "torque", "torque": 0.02, "axis": [0, 0, 1]}}],
        "output": {"probes": [{"name": "lid", "of": "wall", "wall": "lid"}]},
        "steps": {"dt": 1e-4}, "stages": [{"do": "relax"}]})",
      "s.json", "/");
  Built built = started(scene);
  ASSERT_TRUE(coupling::relax(*built.run, {.tolerance = 1e-8}).atRest);
  EXPECT_NEAR(valuesOf(built, scene)["lid_mz_Nm"], -0.02, 1e-3 * 0.02);
  EXPECT_GT(wallOf(built, 1).servo->travel, 0.0);
  EXPECT_LT(residualOf(built), 2e-3 * built.run->ledger().joules("particles: contacts"));
}

TEST(KeptLoads, MeshesDoAsPlanes) {
  const io::test::ScratchFolder folder;
  using Vertices = std::vector<Vec3>;
  const std::vector<geometry::Facet> facets{{0, 2, 1}};
  mesh_io::writeStl(folder / "a.stl", Vertices{{-1, -1, 0.2}, {1, -1, 0.2}, {-1, 1, 0.2}}, facets);
  mesh_io::writeStl(folder / "b.stl", Vertices{{1, -1, 0.2000001}, {1, 1, 0.2}, {-1, 1, 0.2}}, facets);
  const std::string servo = R"("servo": {"keeps": "force", "force": 40, "axis": [0, 0, -1]})";
  const auto workOf = [&](const std::string& lid) {
    Built built = started(sceneFromText("{" + soft + four + R"("walls": [)" + floorWall + "," + lid + servo +
                                            R"(}], "steps": {"dt": 1e-4}, "stages": [{"do": "relax"}]})",
                                        "s.json", folder.path()));
    EXPECT_TRUE(coupling::relax(*built.run, {.tolerance = 1e-8}).atRest);
    EXPECT_LT(residualOf(built), 2e-3 * built.run->ledger().joules("particles: contacts"));
    return -built.run->ledger().joules("particles: work of external forces (minus)");
  };
  const double plane = workOf(lidAt);
  EXPECT_NEAR(workOf(R"({"shape": "mesh", "file": "a.stl", "more_files": ["b.stl"], "tolerance": 1e-6,)"), plane,
              1e-3 * plane);
  EXPECT_NEAR(plane, 40.0 * 2.0 * 10.0 / 1e4, 2e-3 * plane);
}

TEST(KeptLoads, WhatCannotBeIsRefused) {
  const auto refused = [](const std::string& lid) { return refusalOfRun(four + wallsOf(lid)); };
  const std::string servo = R"("servo": {"keeps": "force", "force": 40, "axis": [0, 0, -1]})";
  expectParts(refused(servo + R"(, "velocity": [0, 0, 1])"), {"servo and a path", "walls.1", "surface_velocity"});
  expectParts(refused(R"("servo": {"keeps": "force", "force": 40, "axis": [0, 0, 0]})"), {"no length", "walls.1"});
  expectParts(refused(R"("servo": {"keeps": "pressure", "pressure": 40, "axis": [0, 0, 1]})"), {"\"area\"", "missing"});
  expectParts(refusalOfRun(R"("walls": [)" + lidAt + servo + "}],"), {"no spheres", "mass"});
  expectParts(refusalOfRun(four + R"("walls": [{"shape": "box", "box": [[0, 0, 0], [1, 1, 1]], )" + servo + "}],"),
              {"box", "plane of its own"});
  expectParts(refusalOfRun(four + R"("periodic": {"box": [[0, 0, -1], [1, 1, 1]], "axes": ["x"]},)" +
                           wallsOf(R"("servo": {"keeps": "torque", "torque": 1, "axis": [0, 1, 0]})")),
              {"period along x"});
  expectParts(refusalOfRun(four + wallsOf(R"("surface_velocity": [0, 0, 1])")), {"surface velocity", "walls.1"});
  expectParts(refusalOfRun(four + R"("walls": [)" + floorWall + "," + floorWall + "],"), {"two walls", "floor"});
}

// ---- belts, turns

TEST(Belts, CarryBallsUntilTheyRoll) {
  const Scene scene = sceneWith(R"("gravity": [0, 0, -10], "particles": [{"from": "list", "density": 2500,
      "spheres": [{"at": [0, 0, 0.00999], "radius": 0.01}]}], "walls": [{"shape": "plane", "point": [0, 0, 0],
      "normal": [0, 0, 1], "surface_velocity": [0.7, 0, 0]}],)",
                                aRun);
  Built built = started(scene);
  built.run->advance(20000);
  EXPECT_NEAR(built.run->grains.particles.v[0].x, 2.0 / 7.0 * 0.7, 2e-3);
  const double mass = built.run->grains.particles.mass[0];
  // Impulse times the belt's velocity.
  EXPECT_NEAR(-built.run->ledger().joules("particles: work of walls and drives (minus)"), mass * 0.2 * 0.7,
              0.02 * mass * 0.14);
  EXPECT_LT(residualOf(built), 0.02 * mass * 0.14);
}

/// However its angle goes, in any state of a run.
TEST(Belts, StayAlongTheirPlaneAsItTurns) {
  const Scene scene = sceneWith(R"("particles": [{"from": "list", "density": 2500,
      "spheres": [{"at": [0, 0, 0.0099], "radius": 0.01}]}], "walls": [{"shape": "plane", "point": [0, 0, 0],
      "normal": [0, 0, 1], "surface_velocity": [0.7, 0.1, 0], "turn": {"axis": [0, 1, 0], "angle": "90*t^2"}}],)",
                                aRun);
  Built whole = started(scene), rest = started(scene);
  whole.run->advance(400);
  const dem::PrimitiveWall& wall = wallOf(whole, 0);
  EXPECT_GT(std::abs(wall.axis.x), 0.01);
  EXPECT_NEAR(dot(wall.surfaceVelocity, wall.axis), 0.0, 1e-14);
  EXPECT_NEAR(norm(wall.surfaceVelocity), std::sqrt(0.5), 1e-12);
  rest.run->load(whole.run->save());
  whole.run->advance(200);
  rest.run->advance(200);
  EXPECT_TRUE(whole.run->save() == rest.run->save());
}

TEST(Turns, GoAboutAnyPointOfAnyShape) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP() << "expressions need muParser";
  const std::string turn = R"("turn": {"axis": [0, 1, 0], "angle": "5*t", "point": [1, 0, 2]})";
  Built built = started(sceneOf(R"("walls": [{"shape": "cylinder", "point": [2, 0, 2], "axis": [0, 1, 0],
      "radius": 9, )" + turn + R"(}, {"shape": "box", "box": [[0, -1, -2], [2, 1, 6]], )" +
                                turn + "}],"));
  built.run->advance(1000);
  const double a = 5.0 * built.run->time();
  const Vec3 axis = wallOf(built, 0).point;
  EXPECT_NEAR(axis.x, 1.0 + std::cos(a), 1e-13);
  EXPECT_NEAR(axis.z, 2.0 - std::sin(a), 1e-13);
  for (std::size_t k = 1; k < 7; ++k) {
    const dem::PrimitiveWall& side = wallOf(built, k);  // all as far from the centre as at first
    const double first = std::abs(side.axis.y) > 0.5 ? 1.0 : (k - 1) % 3 == 0 ? 1.0 : 4.0;
    EXPECT_NEAR(dot(Vec3{1, 0, 2} - side.point, side.axis), first, 1e-12) << k;
  }
  EXPECT_NEAR(wallOf(built, 1).axis.z, -std::sin(a), 1e-13);
}

// ---- stages

const std::string stagesOfAll = aRun + R"(, {"do": "run", "time": 0.02, "changes": {"gravity": [1, 0, -5],
    "contact": {"law": "linear", "stiffness": 2e4, "restitution": 0.7, "friction": 0.1},
    "walls": [{"wall": "lid", "servo": {"keeps": "force", "force": 30, "axis": [0, 0, -1], "mass": 3}},
              {"wall": "side", "velocity": [0.1, 0, 0]}, {"wall": "gate", "present": false}],
    "loads": [{"solid": "b", "on": "x+", "type": "pressure", "pressure": 700}]}},
    {"do": "run", "time": 0.02, "changes": {"walls": [{"wall": "lid", "velocity": [0, 0, 0]},
              {"wall": "gate", "present": true}, {"wall": "side", "velocity": [0, 0, 0]}]}})";
const std::string partsOfAll = R"("gravity": [0, 0, -10],)" + four + R"("walls": [)" + floorWall + ", " + lidAt +
                               R"("servo": {"keeps": "force", "force": 60, "axis": [0, 0, -1], "mass": 3}},
    {"name": "side", "shape": "plane", "point": [0.0001, 0, 0], "normal": [1, 0, 0]},
    {"name": "gate", "shape": "plane", "point": [0.3999, 0, 0], "normal": [-1, 0, 0]}],
    "solids": [{"name": "b", "mesh": "box", "cells": [2, 2, 2], "box": [[0, 0, 5], [0.1, 0.2, 5.1]],
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000},
      "supports": [{"on": "x-"}], "loads": [{"on": "x+", "type": "pressure", "pressure": 200}]}],)";

class StageChangesOfSteps : public testing::TestWithParam<const char*> {};

TEST_P(StageChangesOfSteps, BooksCloseAndRunsGoOnToTheSameBytes) {
  const Scene scene = sceneWith(partsOfAll, stagesOfAll, GetParam());
  Built whole = started(scene);
  const std::int64_t part = 200 / scene.steps.stepsPerMacroStep;
  std::vector<StageStart> starts;
  std::vector<char> state;
  double most = 0.0;
  for (std::size_t stage = 0; stage < 3; ++stage) {
    starts.push_back(startOf(whole, scene, stage));
    const double before = whole.run->ledger().residual();
    beginStage(whole, scene, stage, starts.back(), Grains::areThere);
    EXPECT_NEAR(whole.run->ledger().residual(), before, 1e-12);
    whole.run->advance(part / 2);
    if (stage == 1) state = whole.run->save();
    whole.run->advance(part / 2);
    most = std::max(most, residualOf(whole));
  }
  EXPECT_LT(most, 5e-3);
  EXPECT_NE(whole.run->ledger().joules("changes (minus)"), 0.0);
  Built resumed = started(sceneFromText(sceneText(scene), "s.json", "/"));
  for (std::size_t stage = 0; stage < 2; ++stage) beginStage(resumed, scene, stage, starts[stage], Grains::follow);
  resumed.run->load(state);
  resumed.run->advance(part / 2);
  EXPECT_EQ(startOf(resumed, scene, 2).travels, starts[2].travels);
  beginStage(resumed, scene, 2, starts[2], Grains::areThere);
  resumed.run->advance(part);
  EXPECT_TRUE(whole.run->save() == resumed.run->save());
}
INSTANTIATE_TEST_SUITE_P(Steps, StageChangesOfSteps,
                         testing::Values(R"("dt": 1e-4)", R"("dt": 5e-5, "per_macro_step": 4)"));

TEST(StageChanges, TimesCountFromTheStage) {
  if (!WITH_EXPRESSIONS) GTEST_SKIP() << "expressions need muParser";
  const Scene scene = sceneWith(four + R"("walls": [{"name": "a", "shape": "plane", "point": [0, 0, -3],
      "normal": [0, 0, 1], "velocity": [0, 0, 1]}, {"name": "b", "shape": "plane", "point": [0, 0, -4], "normal": [0, 0, 1]}],)",
                                aRun + R"(, {"do": "run", "time": 1, "changes": {"walls": [
      {"wall": "a", "displacement": [0, 0, "t^2"]}, {"wall": "b", "turn": {"axis": [0, 0, 2], "angle": "3*t"}}]}})");
  Built built = started(scene);
  built.run->advance(1000);
  begin(built, scene, 1);
  built.run->advance(2000);
  EXPECT_NEAR(wallOf(built, 0).point.z, -3.0 + 0.1 + 0.2 * 0.2, 1e-12);
  EXPECT_NEAR(wallOf(built, 0).velocity.z, 0.4, 1e-6);
  EXPECT_NEAR(wallOf(built, 1).angularVelocity.z, 3.0, 1e-6);
}

TEST(StageChanges, GravityActsAnewAndGatesLetGo) {
  const Scene scene = sceneWith(
      R"("particles": [{"from": "list", "density": 2500, "spheres": [{"at": [0, 0, 0.0999], "radius": 0.1}]}],
         "walls": [)" +
          floorWall + R"(, {"name": "late", "shape": "plane", "point": [0, 0, 0.1], "normal": [0, 0, 1],
           "present": false}],)",
      aRun +
          R"(, {"do": "run", "time": 1, "changes": {"gravity": [0, 0, -10], "walls": [{"wall": "floor", "present": false}]}},
         {"do": "run", "time": 1, "changes": {"walls": [{"wall": "late", "present": true}]}})");
  Built built = started(scene);
  built.run->advance(1);
  begin(built, scene, 1);
  EXPECT_EQ(built.run->ledger().joules("particles: contacts"), 0.0);
  const double v = built.run->grains.particles.v[0].z;
  built.run->advance(1000);
  EXPECT_NEAR(built.run->grains.particles.v[0].z, v - 10.0 * 0.1, 1e-12);
  EXPECT_LT(residualOf(built), 1e-9);
  try {
    begin(built, scene, 2);
    ADD_FAILURE();
  } catch (const InputError& error) {
    expectParts(error.what(), {"1 grain lies behind the plane", "at t = ", "changes.walls.0"});
  }
}

TEST(StageChanges, LimitStepsAndAreTold) {
  const std::string stiff = aRun + R"(, {"do": "run", "time": 1, "changes": {
      "contact": {"law": "linear", "stiffness": 1e8, "restitution": 0.5}}})";
  const auto refusal = [&](const std::string& parts, const std::string& stages,
                           const std::string& steps) -> std::string {
    try {
      started(sceneWith(parts, stages, steps));
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  expectParts(refusal(four, stiff, R"("dt": 1e-3)"), {"stage 2", "critical step"});
  const double one = started(sceneWith(four, aRun, R"("dt": "auto")")).run->dt();
  const double other = started(sceneWith(four, stiff, R"("dt": "auto")")).run->dt();
  EXPECT_NEAR(other, one / 100.0, 0.05 * other);
  const auto changed = [&](const std::string& changes, const std::string& kind = R"("run", "time": 1)") {
    return refusal(four + wallsOf(R"("present": true)"),
                   aRun + R"(, {"do": )" + kind + R"(, "changes": {)" + changes + "}}", R"("dt": 1e-5)");
  };
  expectParts(changed(R"("walls": [{"wall": "lit", "present": false}])"), {"no wall \"lit\"", "\"lid\"", "stages.1"});
  expectParts(changed(R"("walls": [{"wall": 7, "present": false}])"), {"no wall 7"});
  expectParts(changed(R"("walls": [{"wall": "lid", "velocity": [0, 0, 1]}])", R"("relax")"), {"relaxes", "steady"});
  expectParts(changed(R"("walls": [{"wall": "lid", "surface_velocity": [1, 0, 0]}])", R"("relax")"),
              {"surface_velocity"});
  expectParts(changed(R"("contact": {"law": "Hertz", "youngs_modulus": 1e6, "poisson_ratio": 0.3})"),
              {"cannot be mixed"});
  expectParts(changed(R"("contact": {"law": "elastic-plastic", "stiffness": 1e4, "unloading_stiffness": 2e4})"),
              {"linear and elastic-plastic", "\"law\": \"linear\""});
  expectParts(changed(R"("walls": [{"wall": "12345678901234567890123", "present": false}])"), {"no wall 12345"});
  expectParts(changed(R"("loads": [{"solid": "b", "on": "x+", "type": "pressure", "pressure": 1}])"),
              {"no solid \"b\""});
  EXPECT_EQ(changed(R"("walls": [{"wall": 0, "present": false}])"), "");
}

/// Runs that were resumed have been asked for their energies at other times, and met the channels in another order.
TEST(Changes, AddTheSameBytesHoweverOftenEnergiesWereAskedFor) {
  for (const char* const gravity : {"[0, 0, -7]", "[1, 2, -9]", "[0.3, 0, -0.7]"}) {
    const Scene scene = sceneWith(
        R"("gravity": [0.1, 0, -10], "damping": {"rate": 3}, "particles": [{"from": "list", "density": 2500, "spheres": [
          {"at": [0, 0, 0.11], "radius": 0.1}, {"at": [0.01, 0, 0.33], "radius": 0.11, "velocity": [0, 0.1, 0]}]}],
          "walls": [)" +
            floorWall + "],",
        aRun + R"(, {"do": "run", "time": 0.1, "changes": {"gravity": )" + gravity + "}}");
    Built asked = started(scene), silent = started(scene);
    for (int k = 0; k < 20; ++k) {
      asked.run->advance(50);
      silent.run->advance(50);
      asked.run->ledger();
    }
    begin(asked, scene, 1);
    begin(silent, scene, 1);
    EXPECT_TRUE(asked.run->save() == silent.run->save()) << gravity;
  }
}

/// Where the grains lay at the start.
TEST(Changes, OfWallsThatHaveGoneFarAreTakenUp) {
  const Scene scene = sceneWith(R"("gravity": [0, 0, -10], )" + four + R"("walls": [)" + floorWall + "],",
                                aRun + R"(, {"do": "run", "time": 0.1, "changes": {"walls": [
          {"wall": "floor", "velocity": [0, 0, -5]}]}}, {"do": "run", "time": 0.1, "changes": {"walls": [
          {"wall": "floor", "velocity": [0, 0, 0]}]}})");
  Built whole = started(scene), rest = started(scene);
  std::vector<StageStart> begun;
  for (const std::size_t stage : {1U, 2U}) {
    begun.push_back(startOf(whole, scene, stage));
    begin(whole, scene, stage);
    whole.run->advance(1000);
  }
  for (const std::size_t stage : {1U, 2U}) beginStage(rest, scene, stage, begun[stage - 1], Grains::follow);
  rest.run->load(whole.run->save());
  whole.run->advance(500);
  rest.run->advance(500);
  EXPECT_TRUE(whole.run->save() == rest.run->save());
}

}  // namespace
}  // namespace dovetail::scene::test
