// What stands in a run that was made of a scene.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <numbers>
#include <sstream>

#include "../io/scratch_folder.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "dovetail/scene/build.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/solid_io/solid_files.hpp"
#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

using io::test::ScratchFolder;

TEST(SceneParts, ParticlesOfAllSources) {
  const ScratchFolder folder;
  std::ofstream(folder / "g.csv") << "x_m,y_m,z_m,radius_m,vx_m_per_s,vy_m_per_s,vz_m_per_s\n5,0,0,0.1,1,2,3\n";
  const Built built = build(sceneOf(R"("particles": [
      {"from": "lattice", "lattice": "simple-cubic", "box": [[0, 0, 0], [0.4, 0.2, 0.2]], "radius": 0.1, "density": 1},
      {"from": "list", "density": 3, "velocity": [1, 0, 0], "spheres": [{"at": [9, 0, 0], "radius": 0.1, "velocity": [0, 1, 0]}]},
      {"from": "csv", "file": "g.csv", "density": 2, "velocity": [1, 0, 0]},
      {"from": "packing", "box": [[1, 0, 0], [2, 1, 1]], "radius": {"smallest": 0.2, "largest": 0.2}, "solid_fraction": 0.3, "density": 1}],)",
                                    folder.path()));
  const dem::Particles& p = built.run->grains.particles;
  ASSERT_EQ(p.size(), 2U + 1U + 1U + 9U);  // 0.3/(4π/3 0.2³) = 8.95
  EXPECT_NEAR(p.x[1].x - p.x[0].x, 0.2, 1e-15);
  EXPECT_EQ(p.v[2], (Vec3{1, 1, 0}));
  EXPECT_EQ(p.v[3], (Vec3{2, 2, 3}));
  EXPECT_NEAR(p.mass[2] / p.mass[0], 3.0, 1e-14);
}

TEST(SceneParts, ParticlesOfFramesOfOtherRuns) {
  if (!WITH_FRAMES) GTEST_SKIP() << "frames need VTK";
  const ScratchFolder folder;
  std::ostringstream log;
  const Scene first = sceneOf(R"("particles": [
      {"from": "list", "density": 3, "spheres": [{"at": [9, 0, 0], "radius": 0.1, "velocity": [0, 1, 0]}, {"at": [1, 2, 3], "radius": 0.2}]}],
      "output": {"frames": 1},)");
  ASSERT_TRUE(run(first, {.folder = folder.path(), .progress = false}, log));
  std::string frame;
  for (const std::string& name : folder.content())
    if (name.ends_with(".vtu") && name.find("grains") != std::string::npos) frame = std::max(frame, name);
  const auto from = [&](const std::string& file) {
    return sceneOf(R"("particles": [{"from": "vtk", "file": ")" + file + R"(", "density": 3, "velocity": [1, 0, 0]}],)",
                   folder.path());
  };
  const Built built = build(from(frame));
  const dem::Particles& p = built.run->grains.particles;
  ASSERT_EQ(p.size(), 2U);
  const std::size_t moved = p.radius[0] == 0.1 ? 0 : 1;  // frames are sorted
  EXPECT_NEAR(p.x[moved].y, 1e-3, 1e-16);
  EXPECT_EQ(p.v[moved], (Vec3{1, 1, 0}));
  EXPECT_EQ(p.radius[1 - moved], 0.2);
  std::ofstream(folder / "points.vtp")
      << R"(<VTKFile type="PolyData" version="1.0"><PolyData><Piece NumberOfPoints="1"><PointData></PointData>)"
      << R"(<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">1 2 3</DataArray></Points>)"
      << "</Piece></PolyData></VTKFile>";
  try {
    build(from("points.vtp"));
    FAIL();
  } catch (const InputError& error) {
    expectParts(error.what(), {"no array \"radius\"", "points.vtp", "particles.0"});
  }
}

TEST(SceneParts, WallsOfAllShapesMove) {
  const ScratchFolder folder;
  const std::vector<Vec3> x{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  const std::vector<geometry::Facet> facets{{0, 1, 2}};
  mesh_io::writeStl(folder / "w.stl", x, facets);
  Built built = started(sceneOf(R"("walls": [
      {"shape": "plane", "point": [0, 0, -9], "normal": [0, 0, 2], "velocity": [0, 0, 1]},
      {"shape": "box", "box": [[-9, -9, -9], [9, 9, 9]], "open": ["x+"]},
      {"shape": "cylinder", "point": [0, 0, 0], "axis": [0, 1, 0], "radius": 8, "angular_velocity": [0, "60 rpm", 0]},
      {"shape": "sphere", "centre": [0, 0, 0], "radius": 8},
      {"shape": "mesh", "file": "w.stl", "scale": 0.5, "shift": [0, 0, 1], "velocity": [1, 0, 0]}],)",
                                folder.path()));
  dem::Model& grains = built.run->grains;
  EXPECT_EQ(grains.terms.all<dem::PrimitiveWallTerm>().size(), 1U + 5U + 1U + 1U);
  built.run->advance(100);
  EXPECT_NEAR(dem::primitiveWall(grains, 0).point.z, -9.0 + 1e-3, 1e-12);
  EXPECT_NEAR(dem::primitiveWall(grains, 6).angularVelocity.y, 2.0 * std::acos(-1.0), 1e-14);
  EXPECT_NEAR(dem::meshWall(grains, 0).wall.x[1].x, 1.0 + 1e-3, 1e-12);
  EXPECT_EQ(dem::meshWall(grains, 0).wall.x[1].z, 1.0);
}

TEST(SceneParts, SolidsFromFilesHaveTheirSets) {
  const ScratchFolder folder;
  solid_io::writeSolid(fem::boxOf(fem::ElementShape::tet4, {2, 2, 2}, {0, 0, 0}, {1000, 100, 100}), folder / "b.inp");
  const Built built = build(sceneOf(R"("solids": [{"name": "b", "mesh": "file", "file": "b.inp", "scale": 1e-3,
      "material": {"law": "J2", "youngs_modulus": "1 GPa", "poisson_ratio": 0.3, "density": 1000, "yield_stress": "1 MPa"},
      "velocity": [1, 2, 3], "supports": [{"on": "x-", "components": ["x", "z"], "velocity": [4, 5, 6]}]}],)",
                                    folder.path()));
  const fem::Nodes& nodes = built.run->solid(0).nodes();
  for (std::size_t n = 0; n < nodes.X.size(); ++n) {
    EXPECT_LE(nodes.X[n].x, 1.0);
    EXPECT_EQ(nodes.v[n], nodes.X[n].x == 0.0 ? (Vec3{4, 2, 6}) : (Vec3{1, 2, 3}));
    EXPECT_EQ(nodes.fixed[n], nodes.X[n].x == 0.0 ? 5 : 0);
  }
  EXPECT_TRUE(built.notes.empty());
}

TEST(SceneParts, GrainsEnterLeaveAndAreCounted) {
  const ScratchFolder folder;
  std::ostringstream log;
  const Scene scene = sceneOf(R"("gravity": [0, 0, -10], "insertions": [{"region": [[0, 0, 0.1], [1, 1, 0.3]],
      "radius": {"smallest": 0.02, "largest": 0.02}, "density": 1000, "velocity": [0, 0, -100], "number_per_second": 1e5}],
      "outlets": [{"region": [[0, 0, -9], [1, 1, 0.15]]}], "output": {"series": 1e-4},)");
  ASSERT_TRUE(run(scene, {.folder = folder.path(), .progress = false}, log));
  const io::TimeSeries series = io::readCsv(folder / "series.csv");
  EXPECT_EQ(series.rows(), 11U);
  EXPECT_LT(series.column("particles_entered_minus_J").back(), 0.0);
  EXPECT_GT(series.column("particles_left_J").back(), 0.0);
  EXPECT_LT(std::abs(series.column("residual_J").back()), 1e-3 * series.column("particles_left_J").back());
}

TEST(SceneParts, StepsThatAreAutomaticAreAShareOfTheSmallestLimit) {
  Scene scene = sceneFromText(replaced(smallScene, "1e-4", "\"auto\", \"safety\": 0.1"), "s.json", "/");
  Built built = started(scene);
  double smallest = 1.0;
  for (const StepLimit& limit : limits(built, scene)) smallest = std::min(smallest, limit.dt);
  // An impact on the wall, with its dashpot: 2 √(m/k) (√(1 + 4ζ²) − 2ζ).
  const double damped = 2.0 * dem::LinearSpringDashpot{5e3, 0.5}.dampingRatio();
  EXPECT_NEAR(smallest,
              2.0 * std::sqrt(built.run->grains.particles.mass[0] / 5e3) * (std::sqrt(1.0 + damped * damped) - damped),
              1e-12);
  EXPECT_EQ(built.run->dt(), 0.1 * smallest);
}

/// Two spheres of mass 4.19 kg that are about to meet.
Scene twoSpheres(const std::string& contact, const std::string& safety) {
  return sceneFromText(R"({"contact": {"law": "linear", "stiffness": 1e4, )" + contact + R"(},
      "particles": [{"from": "list", "density": 1000, "spheres": [
        {"at": [0, 0, 0], "radius": 0.1, "velocity": [0.4, 0.2, 0]}, {"at": [0.20001, 0, 0], "radius": 0.1}]}],
      "steps": {"dt": "auto", "safety": )" +
                           safety + R"(}, "stages": [{"do": "run", "time": 0.1}], "output": {"series": 1e-3}})",
                       "s.json", "/");
}

TEST(SceneParts, AutomaticStepsGoThroughImpacts) {
  const std::string rebounds = R"("restitution": 0.8, "friction": 0.3)";
  const Built bold = started(twoSpheres(rebounds, "1")), careful = started(twoSpheres(rebounds, "0.05"));
  const double halfPeriod = std::numbers::pi * std::sqrt(0.5 * bold.run->grains.particles.mass[0] / 1e4);
  EXPECT_NEAR(bold.run->dt(), 0.4 / std::numbers::pi * halfPeriod, 1e-12 * halfPeriod);
  ASSERT_EQ(bold.notes.size(), 1U);
  expectParts(bold.notes[0], {"eight steps", "impact", "steps.dt"});
  // Dashpots take some of 2/ω: √(1 + 4ζ²) − 2ζ = 0.862.
  EXPECT_LT(careful.run->dt(), 0.1 / std::numbers::pi * halfPeriod);
  EXPECT_GT(careful.run->dt(), 0.086 / std::numbers::pi * halfPeriod);
  EXPECT_TRUE(careful.notes.empty());
  const Built bonded = started(twoSpheres(R"("bonded": true)", "0.9"));  // meets nobody anew
  EXPECT_NEAR(bonded.run->dt(), 1.8 / std::numbers::pi * halfPeriod, 1e-12 * halfPeriod);
}

TEST(SceneParts, GivenStepsThatAreCoarseForImpactsAreTold) {
  const auto given = [](double stepsInAnImpact) {
    Scene scene = twoSpheres(R"("restitution": 0.8, "friction": 0.3)", "1");
    const double resolved = started(scene).run->dt();
    scene.steps.dt = {8.0 * resolved / stepsInAnImpact, ""};
    return started(scene);
  };
  const Built coarse = given(4.0);
  ASSERT_EQ(coarse.notes.size(), 1U);
  expectParts(coarse.notes[0], {"an impact of the smallest grains 4 steps", "eight need"});
  EXPECT_TRUE(given(8.1).notes.empty());
}

TEST(SceneParts, CoarseStepsNameTheMaterialsThatMeet) {
  const auto law = [](const char* a, const char* b, const char* stiffness) {
    return std::string(R"({"between": ")") + a + R"(", "and": ")" + b + R"(", "law": "linear", "stiffness": )" +
           stiffness + R"(, "restitution": 0.8})";
  };
  const Built coarse =
      started(sceneFromText(R"({"contacts": [)" + law("rock", "rock", "1e4") + "," + law("rock", "steel", "4e4") + R"(],
      "particles": [{"from": "list", "density": 1000, "contact_material": "rock", "spheres": [
        {"at": [0, 0, 0], "radius": 0.1}]}],
      "walls": [{"shape": "plane", "point": [0, 0, -0.1], "normal": [0, 0, 1], "contact_material": "steel"}],
      "steps": {"dt": "auto", "safety": 1}, "stages": [{"do": "run", "time": 0.1}]})",
                            "s.json", "/"));
  ASSERT_EQ(coarse.notes.size(), 1U);
  expectParts(coarse.notes[0], {R"(("rock" on "steel") takes eight steps)"});
}

/// However large a fraction of the limit is asked for.
TEST(SceneParts, AutomaticStepsKeepTheEnergyOfImpacts) {
  const ScratchFolder folder;
  std::ostringstream log;
  ASSERT_TRUE(run(twoSpheres(R"("restitution": 0.8, "friction": 0.3)", "1"),
                  {.folder = folder.path(), .progress = false}, log));
  const io::TimeSeries series = io::readCsv(folder / "series.csv");
  const auto kinetic = series.column("particles_kinetic_J"), residual = series.column("residual_J");
  const double changedHands = kinetic.front() - *std::min_element(kinetic.begin(), kinetic.end());
  EXPECT_GT(changedHands, 0.3 * kinetic.front());
  EXPECT_LT(kinetic.front() - kinetic.back(), 0.5 * changedHands);  // they have parted again
  EXPECT_LT(std::abs(residual.back()), 0.05 * changedHands);
}

/// In a process of its own, which has little address space.
TEST(SceneParts, WhatMemoryDoesNotHoldIsRefusedBeforeItIsTaken) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take more address space than the limit";
#endif
  const auto refused = [](const std::string& middle) {
    const pid_t child = ::fork();
    if (child == 0) {
      const rlimit limit{1ULL << 32, 1ULL << 32};
      setrlimit(RLIMIT_AS, &limit);
      const std::string message = refusalOfRun(middle);
      ::_exit(message.find("of memory, and") != std::string::npos && message.find("[s.json:") != std::string::npos ? 0
                                                                                                                   : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  };
  EXPECT_TRUE(
      refused(R"("particles": [{"from": "lattice", "box": [[0, 0, 0], [1, 1, 1]], "radius": 1.2e-3, "density": 1}],)"));
  EXPECT_TRUE(refused(
      R"("particles": [{"from": "packing", "box": [[0, 0, 0], [1, 1, 1]], "radius": {"smallest": 1e-3, "largest": 1.4e-3},
          "density": 1}],)"));
  EXPECT_TRUE(refused(
      R"("solids": [{"name": "b", "mesh": "box", "cells": [450, 450, 450], "box": [[0, 0, 0], [1, 1, 1]],
         "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000}}],)"));
}

TEST(SceneParts, WhatCannotBeIsRefusedWithItsPlace) {
  const auto expect = [](const std::string& middle, const std::string& part, const std::string& place) {
    const std::string message = refusalOfRun(middle);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find("[s.json:"), std::string::npos) << message;
    EXPECT_NE(message.find(place), std::string::npos) << message;
  };
  const std::string block =
      R"("solids": [{"name": "b", "mesh": "box", "cells": [2, 2, 2], "box": [[0, 0, 0], [1, 1, 1]],
      "material": {"law": "neo-Hookean", "youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 1000}}],)";
  expect(R"("particles": [{"from": "lattice", "box": [[0, 0, 0], [1, 1, 1]], "radius": 1e-9, "density": 1}],)",
         "1e8 spheres", "particles.0");
  expect(
      R"("particles": [{"from": "packing", "box": [[0, 0, 0], [1, 1, 1]], "radius": {"smallest": 0.1, "largest": 0.1},
            "solid_fraction": 0.73, "density": 1}],)",
      "jams", "particles.0");
  expect(replaced(block, "[2, 2, 2]", "[9999, 9999, 9999]"), "1e8 cells", "solids.0");
  expect(block + R"("couplings": [{"type": "surface", "solid": "c"}],)", "write \"b\"", "couplings.0");
  expect(block + R"("couplings": [{"type": "surface", "solid": "b", "on": "w"}],)", "\"w\"", "couplings.0");
  expect(block + R"("couplings": [{"type": "overlap", "solid": "b", "solid_border": 1, "particle_border": 1}],)",
         "coincide", "couplings.0");
  expect(block + R"("couplings": [{"type": "overlap", "solid": "b", "solid_border": 1, "particle_border": 0}],)",
         "overlap", "couplings.0");
  expect(R"("walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 0]}],)", "normal", "walls.0");
  expect(
      R"("insertions": [{"region": [[0, 0, 0], [1, 1, 1]], "radius": {"smallest": 0.1, "largest": 0.1}, "density": 1}],)",
      "rate", "insertions.0");
}

}  // namespace
}  // namespace dovetail::scene::test
