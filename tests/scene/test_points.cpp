// Solids of material points in scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>

#include "../../src/scene/run/frame_fields.hpp"
#include "../../src/scene/run/probes.hpp"
#include "../io/scratch_folder.hpp"
#include "../threads.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/coupling/run.hpp"
#include "point_scenes.hpp"
#include "surfaces.hpp"

namespace dovetail::scene::test::points {
namespace {

TEST(ScenePoints, FillWhatTheyAreToldTo) {
  const Built flat = build(sceneOf(body(box, plane)));
  EXPECT_EQ(pointsIn(flat).masses().size(), 4U * 4U * 8U);
  EXPECT_NEAR(massIn(flat), 1000.0 * 0.2 * 0.4 * 0.05, 1e-9);
  const Built fine = build(sceneOf(body(box + R"(, "per_axis": 3)", R"("spacing": 0.05)")));
  EXPECT_EQ(pointsIn(fine).masses().size(), 27U * 4U * 8U);
  EXPECT_NEAR(massIn(fine), 1000.0 * 0.2 * 0.4 * 0.05, 1e-9);
  const Built ball =
      build(sceneOf(body(R"("from": "sphere", "centre": [1, 2, 3], "radius": 0.2)", R"("spacing": 0.05)")));
  const Built rod =
      build(sceneOf(body(R"("from": "cylinder", "point": [0, 0, 0], "axis": [1, 1, 0], "radius": 0.1, "length": 0.3)",
                         R"("spacing": 0.05)")));
  const Built disc = build(sceneOf(
      body(R"("from": "cylinder", "point": [0, 1, 0], "axis": [0, 0, 1], "radius": 0.2, "length": 0.3)", plane)));
  EXPECT_NEAR(massIn(ball), 1000.0 * 4.0 / 3.0 * std::numbers::pi * 0.008, 1e-9);
  EXPECT_NEAR(massIn(rod), 1000.0 * std::numbers::pi * 0.003, 1e-9);
  EXPECT_NEAR(massIn(disc), 1000.0 * std::numbers::pi * 0.012, 1e-9);
  for (const Vec3& x : pointsIn(ball).places(ball.run->solid(0).nodes())) EXPECT_LT(norm(x - Vec3{1, 2, 3}), 0.2);
  for (const Vec3& x : pointsIn(disc).places(disc.run->solid(0).nodes())) {
    EXPECT_LT(norm(x - Vec3{0, 1, 0}), 0.2);
    EXPECT_EQ(x.z, 0.0);
  }
}

TEST(ScenePoints, FillClosedSurfacesAndComeFromFiles) {
  const io::test::ScratchFolder folder;
  writeBlock(folder / "block.stl");
  const Built block = build(
      sceneOf(body(R"("from": "surface", "surface": {"file": "block.stl"})", R"("spacing": 0.05)"), folder.path()));
  EXPECT_EQ(pointsIn(block).masses().size(), 16U * 8U * 4U);
  EXPECT_NEAR(massIn(block), 1000.0 * blockVolume, 1e-6);  // corners are floats
  std::ofstream(folder / "p.csv") << "x_m,y_m,z_m,volume_m3,vx_m_per_s,vy_m_per_s,vz_m_per_s\n"
                                     "0.01,0.01,0,1e-4,1,2,0\n0.03,0.01,0,1e-4,1,2,0\n0.01,0.03,0,3e-4,1,2,0\n"
                                     "0.03,0.03,0,1e-4,1,2,0\n";
  const std::string file = R"("from": "csv", "file": "p.csv")";
  const Built read = build(sceneOf(body(file, plane, R"("velocity": [1, 0, 0], )" + law), folder.path()));
  EXPECT_EQ(pointsIn(read).masses(), (std::vector<double>{0.1, 0.1, 0.3, 0.1}));
  const auto& side = read.run->solid(0);
  for (const Vec3& v : velocitiesOf(pointsIn(read), side.nodes())) EXPECT_LT(norm(v - Vec3{2, 2, 0}), 1e-12);
  const auto refused = [&](const char* text, const std::string& grid) {
    std::ofstream(folder / "p.csv") << text;
    return refusalOf(sceneOf(body(file, grid), folder.path()));
  };
  expectParts(refused("x_m,y_m,z_m\n0,0,0\n", plane), {"solids.0", "volume_m3", "thickness"});
  expectParts(refused("x_m,y_m\n0,0\n", plane), {"no column \"z_m\""});
  expectParts(refused("x_m,y_m,z_m,mass_kg\n0,0,0,1\n", R"("spacing": 1)"), {"mass_kg", "unknown"});
  expectParts(refused("x_m,y_m,z_m,vx_m_per_s\n0,0,0,1\n", R"("spacing": 1)"), {"some components"});
  expectParts(refused("x_m,y_m,z_m\n", R"("spacing": 1)"), {"no rows"});
}

TEST(ScenePoints, RefuseWhatNeedsElements) {
  const auto refused = [](const std::string& more) { return refusalOf(sceneOf(body(box, plane, law + more))); };
  expectParts(refused(R"(, "supports": [{"on": "y-"}])"), {"solids.0", "supports", "held or symmetry"});
  expectParts(refused(R"(, "loads": [{"on": "y+", "type": "force", "force": [1, 0, 0]}])"),
              {"solids.0", "forces on nodes", "pressure"});
  expectParts(refused(R"(, "loads": [{"on": "z+", "type": "pressure", "pressure": 1}])"), {"solids.0.loads.0", "z+"});
  expectParts(refused(R"(, "formulation": "enhanced")"), {"formulation"});
  expectParts(refused(R"(, "consistent_mass": 1)"), {"consistent mass"});
  expectParts(refusalOf(sceneOf(body(R"("from": "cylinder", "point": [0, 1, 0], "axis": [0, 0, 1], "radius": 0.2, )"
                                     R"("length": 0.3)",
                                     plane, law + R"(, "planes": [{"point": [0, 0, 0], "normal": [0, 1, 0]}])"))),
              {"solids.0", "faces of material points are those of a box"});
  expectParts(refused(R"(, "linear_solver": "direct")"), {"linear_solver"});
  expectParts(refusalOf(sceneOf(body(box, plane + R"(, "borders": [{"side": "y-", "at": 0.05}])"))),
              {"solids.0.grid.borders.0", "16 of 128 points", "border y-"});
  expectParts(refusalOf(sceneOf(body(box, plane + R"(, "borders": [{"side": "y-", "at": 0.01}])"))),
              {"solids.0.grid.borders.0", "between nodes"});
  expectParts(refusalOf(sceneOf(body(box, plane + R"(, "borders": [{"side": "z-", "at": 0}])"))),
              {"0 or 1 in the plane"});
  expectParts(refusalOf(sceneOf(body(box, plane + R"(, "transfer": "apic", "damping": 1)"))),
              {"damping is that of flip"});
  expectParts(refusalOf(sceneOf(body(box, plane + R"(, "transfer": "apic", "shape": "linear")"))), {"apic"});
  expectParts(refusalOf(sceneOf(body(R"("from": "sphere", "centre": [0, 0, 0], "radius": 1)", plane))),
              {"plane strain", "cylinder"});
  expectParts(refusalOfRun(body(R"("from": "box", "box": [[0, 0, 0], [1, 1, 0]])", plane)),
              {"solids.0.points", "no width along z"});
  expectParts(refusalOf(sceneOf(body(R"("from": "box", "box": [[0, 0, 0], [1e5, 1e5, 1]])", plane))),
              {"points of \"snow\""});
}

TEST(ScenePoints, RefuseStagesOfMeshes) {
  const auto refused = [](const std::string& stages) {
    return refusalOf(sceneFromText("{" + body(box, plane) + R"("stages": [)" + stages + "]}", "s.json", "/"));
  };
  expectParts(refused(R"({"do": "modes"})"), {"stages.0", "modes", "snow"});
  expectParts(refused(R"({"do": "statics", "control": "arc-length"})"), {"stages.0", "paths of equilibria"});
  expectParts(refused(R"({"do": "run", "time": 1, "changes": {"supports": [{"solid": "snow", "on": "a"}]}})"),
              {"stages.0.changes.supports.0", "no supports"});
}

/// Falls onto the border for 90 ms and is pressed flat.
Scene falling(const std::string& transfer, const std::string& steps) {
  return sceneFromText(R"({"gravity": [0, -9.81, 0],)" +
                           body(R"("from": "box", "box": [[0, 0.1, 0], [0.2, 0.5, 0.05]])", plane + base + transfer,
                                R"("velocity": [0.3, -1, 0], )" + law) +
                           R"("steps": {)" + steps + R"(}, "stages": [{"do": "run", "time": 0.15}],
      "output": {"series": 0.01, "probes": [{"name": "all", "of": "body", "solid": "snow"},
        {"name": "top", "of": "node", "solid": "snow", "at": [0.1, 0.5, 0]}]}})",
                       "s.json", "/");
}

class FallingPoints : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(FallingPoints, KeepTheLedgerAndTheirMass) {
  const auto& [transfer, steps] = GetParam();
  const Scene scene = falling(transfer, steps);
  Built built = started(scene);
  const Probes probes(built, scene);
  const auto rowOf = [&] {
    std::vector<double> row;
    probes.add(built, row);
    std::map<std::string, double> values;
    for (std::size_t k = 0; k < row.size(); ++k) values[probes.names().at(k)] = row[k];
    return values;
  };
  auto row = rowOf();
  EXPECT_NEAR(row["all_x_m"], 0.1, 1e-12);
  EXPECT_NEAR(row["all_y_m"], 0.3, 1e-12);
  EXPECT_NEAR(row["all_vy_m_per_s"], -1.0, 1e-12);
  EXPECT_NEAR(row["all_most_x_m"], 0.1875, 1e-12);
  const double joules = built.run->kineticEnergy();
  while (built.run->time() < 0.15) built.run->advance(10);
  EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-2 * joules);
  EXPECT_LT(norm(built.run->totals().residual.linear), 1e-9 * massIn(built));
  row = rowOf();
  EXPECT_NEAR(row["all_x_m"], 0.1 + 0.3 * built.run->time(), 1e-9);  // nothing pushes along x
  EXPECT_NEAR(row["all_vx_m_per_s"], 0.3, 1e-9);
  EXPECT_GT(row["all_least_y_m"], 0.0);
  EXPECT_GT(row["top_ux_m"], 0.01);
  EXPECT_GT(pointsIn(built).renewals(), 2);
}

/// On other numbers of threads, and from a state halfway.
TEST_P(FallingPoints, GoOnWithTheSameBytes) {
  const auto& [transfer, steps] = GetParam();
  const Scene scene = falling(transfer, steps);
  const auto bytes = [&](int threads) {
    return onThreads(threads, [&] {
      Built built = started(scene);
      built.run->advance(60);
      const std::vector<char> halfway = built.run->save();
      built.run->advance(60);
      EXPECT_GT(pointsIn(built).renewals(), 0);
      return std::pair{halfway, built.run->save()};
    });
  };
  const auto [halfway, end] = bytes(1);
  EXPECT_EQ(bytes(3).second, end);
  const auto resumed = onThreads(2, [&, from = halfway] {
    Built built = started(scene);
    built.run->load(from);
    built.run->advance(60);
    return built.run->save();
  });
  EXPECT_EQ(resumed, end);
}
INSTANTIATE_TEST_SUITE_P(All, FallingPoints,
                         testing::Values(std::pair{R"(, "transfer": "apic")", R"("dt": 2e-4)"},
                                         std::pair{"", R"("dt": 2e-4)"},
                                         std::pair{R"(, "damping": 5)", R"("dt": 1e-4, "per_macro_step": 2)"}));

/// A ball of points falls on a bead that lies on a floor.
Scene onBead(const std::string& coupling,
             const std::string& filling = R"("from": "sphere", "centre": [0, 0, 0.1], "radius": 0.05)") {
  return sceneFromText(
      R"({"gravity": [0, 0, -9.81],
    "contact": {"law": "linear", "stiffness": 2000, "restitution": 1, "friction": 0.3},
    "particles": [{"from": "list", "density": 1000, "spheres": [{"at": [0, 0, 0.02], "radius": 0.02}]}],
    "walls": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "name": "floor"}],)" +
          body(filling, R"("spacing": 0.02, "transfer": "apic")", R"("velocity": [0, 0, -1], )" + law) +
          R"("couplings": [)" + coupling + R"(],
    "steps": {"dt": 2e-5}, "stages": [{"do": "run", "time": 0.1}],
    "output": {"series": 0.01, "frames": 0.01, "probes": [{"name": "bead", "of": "grain", "at": [0, 0, 0.1]},
       {"name": "floor", "of": "wall", "wall": "floor"}, {"name": "near", "of": "region", "box": [[-1, -1, 0], [1, 1, 1]]}]}})",
      "s.json", "/");
}

TEST(ScenePoints, MeetGrainsAndWalls) {
  const Scene scene = onBead(R"({"type": "points", "solid": "snow"})");
  Built built = started(scene);
  EXPECT_EQ(countOfGrains(built.run->grains.particles), 1U);
  EXPECT_EQ(grainsAlone(built.run->grains.particles).radius, (std::vector<double>{0.02}));
  const Probes probes(built, scene);
  std::vector<double> row;
  probes.add(built, row);
  EXPECT_EQ(row[2], 0.02);  // the bead, though points are nearer
  EXPECT_EQ(row[15], 1.0);  // grains in the region
  const double joules = built.run->ledger().stored();
  built.run->advance(3000);
  EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-2 * joules);
  const Momenta& residual = built.run->totals().residual;
  EXPECT_LT(norm(residual.linear), 1e-9 * built.run->totals().turnedOver);
  row.clear();
  probes.add(built, row);
  EXPECT_LT(row[8], -0.1);  // N: the floor is pushed
  for (const Vec3& x : pointsIn(built).places(built.run->solid(0).nodes())) EXPECT_GT(x.z, 0.0);
}

const std::string block = R"("from": "box", "box": [[-0.04, -0.04, 0.06], [0.04, 0.04, 0.12]])";

/// Of a body that keeps its faces, whatever the grid; on with the same bytes from a state halfway.
TEST(ScenePoints, MeetGrainsWithTheirFaces) {
  const Scene scene = onBead(R"({"type": "surface", "solid": "snow"})", block);
  const auto run = [&](int threads, std::int64_t steps, const std::vector<char>& from) {
    return onThreads(threads, [&] {
      Built built = started(scene);
      const double joules = built.run->ledger().stored();
      if (!from.empty()) built.run->load(from);
      built.run->advance(steps);
      EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-2 * joules);
      EXPECT_LT(norm(built.run->totals().residual.linear), 1e-9 * built.run->totals().turnedOver);
      EXPECT_GT(built.run->totals().ontoSolids.z, 0.01);  // kg m/s: the bead pushes
      EXPECT_GT(pointsIn(built).renewals(), 1);
      return built.run->save();
    });
  };
  const std::vector<char> halfway = run(1, 2000, {});
  EXPECT_EQ(run(1, 3000, {}), run(3, 1000, halfway));
}

TEST(ScenePoints, RefuseCouplingsOfMeshes) {
  expectParts(refusalOf(onBead(R"({"solid": "snow", "type": "overlap", "solid_border": 0, "particle_border": 1})")),
              {"couplings.0", "made of material points", "\"type\": \"points\""});
  expectParts(refusalOf(onBead(R"({"solid": "snow", "type": "surface"})")),
              {"solids.0", "faces of material points are those of a box", "points"});
  expectParts(refusalOf(onBead(R"({"solid": "snow", "type": "surface", "kernel": 0.01})", block)),
              {"couplings.0", "without a kernel"});
  const std::string points = R"({"type": "points", "solid": "snow"})";
  expectParts(refusalOf(onBead(points + ", " + points)), {"couplings.0", "two couplings"});
  expectParts(
      refusalOfRun(R"("solids": [{"name": "snow", "mesh": "box", "cells": [1, 1, 1], "box": [[0, 0, 0], [1, 1, 1]], )" +
                   law + R"(}], "couplings": [)" + points + "],"),
      {"couplings.0", "has a mesh", "surface"});
}

TEST(ScenePoints, ShowTheirFields) {
  const Scene scene = sceneOf(body(box, plane, R"("velocity": [1, 2, 0], )" + law));
  const Built built = started(scene);
  fem::Model& model = *built.run->solid(0).model;
  std::map<std::string, std::vector<double>> found;
  for (const MeshField& field : solidFields(model, 0, scene.solids[0], {"stress", "strain", "history"})) {
    EXPECT_FALSE(field.perCell);
    found[field.name] = field.values;
  }
  EXPECT_EQ(found.at("displacement").size(), 3U * 128U);
  EXPECT_NEAR(found.at("velocity")[1], 2.0, 1e-12);
  EXPECT_NEAR(found.at("radius")[0], 0.0125, 1e-15);
  EXPECT_EQ(found.at("stress").size(), 9U * 128U);
  EXPECT_EQ(found.at("strain").size(), 9U * 128U);
  EXPECT_EQ(found.count("history"), 0U);
}

}  // namespace
}  // namespace dovetail::scene::test::points
