// Frames and fields in the files of a run.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <sstream>

#include "../../src/scene/run/frame_fields.hpp"
#include "../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/io_vtk/frame_reader.hpp"
#include "dovetail/io_vtk/vtu_series.hpp"
#include "dovetail/scene/compare.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/scene/grid_fields.hpp"
#include "inspect/field_profile.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

using io::test::ScratchFolder;

/// Grains in a box that hands over to a solid, and another solid that lies on them. @param output  further keys of it
Scene scene(const std::string& output) {
  return sceneFromText(R"({"gravity": [0, 0, -9.81],
  "contact": {"law": "linear", "stiffness": 5e4, "restitution": 0.4, "friction": 0.5},
  "particles": [{"from": "packing", "box": [[0, 0, 0], [0.12, 0.12, 0.1]], "radius": {"smallest": 0.008, "largest": 0.012},
                 "solid_fraction": 0.5, "overlap": 1e-4, "density": 2500}],
  "walls": [{"shape": "box", "box": [[0, 0, 0], [0.12, 0.12, 1]], "open": ["z-", "z+"]}],
  "solids": [
    {"name": "soil", "mesh": "box", "cells": [3, 3, 4], "box": [[0, 0, -0.06], [0.12, 0.12, 0.06]],
     "material": {"law": "Drucker-Prager", "youngs_modulus": 2e6, "poisson_ratio": 0.25, "density": 1250,
                  "cohesion": 500, "friction_angle": 0.5},
     "supports": [{"on": "z-"}]},
    {"name": "plate", "mesh": "box", "cell": "tet10", "cells": [2, 2, 1], "box": [[0.02, 0.02, 0.101], [0.1, 0.1, 0.12]],
     "material": {"law": "neo-Hookean", "youngs_modulus": 1e7, "poisson_ratio": 0.3, "density": 1200},
     "velocity": [0, 0, -1], "supports": [{"on": "z+", "velocity": [0, 0, -1]}]}],
  "couplings": [{"type": "overlap", "solid": "soil", "solid_border": 0.06, "particle_border": 0},
                {"type": "surface", "solid": "plate"}],
  "steps": {"dt": 1e-5}, "stages": [{"do": "run", "time": 2e-3}],
  "output": {"frames": 1e-3)" +
                           output + "}}",
                       "s.json", "/");
}

void runIn(const ScratchFolder& folder, const std::string& output) {
  std::ostringstream log;
  ASSERT_TRUE(run(scene(output), {.folder = folder / "out", .progress = false}, log));
}

std::set<std::string> arraysIn(const std::filesystem::path& pvd) {
  const auto frames = io::readPvd(pvd);
  EXPECT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames.front().first, 0.0);
  const io::FrameContent frame = io::readFrame(frames.back().second);
  EXPECT_EQ(frame.time, frames.back().first);
  EXPECT_FALSE(frame.provenance.empty());
  std::set<std::string> names;
  for (const io::FrameArray& array : frame.arrays)
    if (!array.name.ends_with("-") && !array.name.ends_with("+")) names.insert(array.name);
  names.erase("skin");
  return names;
}
using Names = std::set<std::string>;

/// Laws, gravity and walls that a stage has changed are those of the fields.
TEST(SceneFields, FollowWhatStagesHaveChanged) {
  const Scene changing = sceneFromText(R"({"gravity": [0, 0, -9.81],
      "contact": {"law": "linear", "stiffness": 1e4, "restitution": 0.5},
      "particles": [{"from": "list", "density": 2500, "spheres": [{"at": [0, 0, 0.00999], "radius": 0.01}]}],
      "walls": [{"name": "floor", "shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}], "steps": {"dt": 1e-5},
      "stages": [{"do": "run", "time": 1e-4}, {"do": "run", "time": 1e-4, "changes": {
        "contact": {"law": "linear", "stiffness": 3e4, "restitution": 0.5},
        "walls": [{"wall": "floor", "present": false}]}}],
      "output": {"checkpoints": 1e-4}})",
                                       "s.json", "/");
  const ScratchFolder folder;
  std::ostringstream log;
  ASSERT_TRUE(run(changing, {.folder = folder / "out", .progress = false}, log));
  writeGridFields(folder / "out", {.width = 0.03, .spacing = 0.01, .file = folder / "f.vti"}, log);
  for (const io::FrameArray& array : io::readFrame(folder / "f.vti").arrays)
    if (array.name == "wall_force") {
      for (const double force : array.values) EXPECT_EQ(force, 0.0);
    }
}

/// The first frame is the equilibrium that a stage without time ends with.
TEST(SceneFrames, AStageWithoutTimeReplacesTheFrameBefore) {
  const Scene loaded = sceneFromText(R"({"solids": [{"name": "bar", "mesh": "box", "cells": [1, 1, 4],
      "box": [[0, 0, 0], [1, 1, 4]], "supports": [{"on": "z-"}],
      "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e6, "poisson_ratio": 0, "density": 1000},
      "loads": [{"on": "z+", "type": "traction", "traction": [0, 0, 1000]}]}], "steps": {"dt": 1e-4},
      "stages": [{"do": "statics"}, {"do": "run", "time": 2e-3}], "output": {"frames": 1e-3}})",
                                     "s.json", "/");
  const ScratchFolder folder;
  std::ostringstream log, checked;
  ASSERT_TRUE(run(loaded, {.folder = folder / "out", .progress = false}, log));
  const auto frames = io::readPvd(folder / "out/solid_bar.pvd");
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames.front().first, 0.0);
  double most = 0.0;
  for (const io::FrameArray& array : io::readFrame(frames.front().second).arrays)
    if (array.name == "displacement") most = *std::ranges::max_element(array.values);
  EXPECT_NEAR(most, 4e-3, 1e-5);  // σ L/E
  check(loaded, checked);
  EXPECT_NE(checked.str().find("frames: 3 of"), std::string::npos) << checked.str();
}

TEST(FieldProfile, HasMeansOfLayersAndTheErrorsOfHandCalculations) {
  // Two layers of 3 × 2 points, one kernel's diameter apart.
  const cg::Grid grid{{0, 0, 5}, {2.0, 2.0, 0.5}, {3, 2, 2}};
  cg::Fields fields;
  for (int p = 0; p < 12; ++p) {
    fields.density.push_back(p < 6 ? 1.0 + p : 7.0);
    fields.solidFraction.push_back(0.5);
    fields.momentum.push_back({3.0 * fields.density.back(), p % 2 == 0 ? 1.0 : -1.0, 0.0});
    fields.temperature.push_back(0.0);
    fields.contactStress.push_back(Eigen::Matrix3d::Identity() * -2.0);
    fields.kineticStress.push_back(Eigen::Matrix3d::Identity() * -1.0);
  }
  const io::TimeSeries profile = profileOf(grid, fields, 2, 1.0);
  ASSERT_EQ(profile.rows(), 2U);
  EXPECT_EQ(profile.column("z_m")[1], 5.5);
  EXPECT_EQ(profile.column("independent_places")[0], 6.0);
  EXPECT_DOUBLE_EQ(profile.column("density_kg_per_m3")[0], 3.5);
  EXPECT_NEAR(profile.column("density_error_kg_per_m3")[0], std::sqrt(3.5 / 6.0), 1e-14);  // variance of 1 … 6: 3.5
  EXPECT_EQ(profile.column("density_error_kg_per_m3")[1], 0.0);
  EXPECT_DOUBLE_EQ(profile.column("velocity_x_m_per_s")[0], 3.0);
  EXPECT_NEAR(profile.column("velocity_x_error_m_per_s")[0], 0.0, 1e-14);
  EXPECT_NEAR(profile.column("velocity_y_error_m_per_s")[1], std::sqrt(6.0 / 5.0 / 6.0) / 7.0, 1e-14);
  EXPECT_DOUBLE_EQ(profile.column("stress_zz_Pa")[0], -3.0);  // of contacts and fluctuations
  EXPECT_DOUBLE_EQ(profile.column("pressure_Pa")[0], 3.0);
  // Wider kernels leave one place: no error is known.
  EXPECT_TRUE(std::isnan(profileOf(grid, fields, 2, 5.0).column("density_error_kg_per_m3")[0]));
  EXPECT_EQ(profileOf(grid, fields, 0, 1.0).rows(), 3U);
}

TEST(Frames, HoldWhatIsAskedFor) {
  const ScratchFolder few, all;
  runIn(few, R"(, "contents": ["grains"])");
  EXPECT_EQ(arraysIn(few / "out/grains.pvd"), (Names{"id", "radius", "velocity"}));
  EXPECT_FALSE(std::filesystem::exists(few / "out/solid_soil.pvd"));
  runIn(
      all,
      R"(, "contents": ["grains", "spin", "forces", "weights", "contacts", "bonds", "solids", "stress", "history", "walls"])");
  EXPECT_EQ(arraysIn(all / "out/grains.pvd"), (Names{"id", "radius", "velocity", "force", "spin", "weight"}));
  EXPECT_EQ(arraysIn(all / "out/contacts.pvd"),
            (Names{"first", "second", "force", "normal_force", "tangential_force"}));
  EXPECT_EQ(arraysIn(all / "out/solid_soil.pvd"), (Names{"displacement", "velocity", "solid_weight", "stress",
                                                         "von_mises", "pressure", "plastic_strain", "plastic_volume"}));
  EXPECT_EQ(arraysIn(all / "out/solid_plate.pvd"),
            (Names{"displacement", "velocity", "stress", "von_mises", "pressure"}));
  for (const char* const none : {"bonds.pvd", "wall_0.pvd"})
    EXPECT_FALSE(std::filesystem::exists(all / "out" / none)) << none;
  EXPECT_TRUE(compare(few / "out/grains.pvd", few / "out/grains.pvd").within(0.0));
  // Arrays that only one has are told, and no more: the two are the same run.
  const Comparison found = compare(few / "out/grains.pvd", all / "out/grains.pvd");
  ASSERT_EQ(found.unlike.size(), 3U);  // a line for each, not for each frame
  for (const std::string& line : found.unlike)
    EXPECT_NE(line.find("Likewise in 2 more frames."), std::string::npos) << line;
  for (const Difference& one : found.differences) EXPECT_EQ(one.largest, 0.0) << one.what;
}

TEST(Frames, SetsWithTheNamesOfFieldsHaveOthersWhichCheckSays) {
  const ScratchFolder folder;
  Scene with = scene(R"(, "contents": ["solids"])");
  with.solids[1].sets.push_back({.name = "velocity", .place = PlaceAtSide{"z-"}, .where = ""});
  std::ostringstream checked, log;
  check(with, checked);
  ASSERT_TRUE(run(with, {.folder = folder / "out", .progress = false}, log));
  const std::string note = R"-(In frames of "plate" the node set "velocity" is "velocity (set)")-";
  EXPECT_NE(checked.str().find(note), std::string::npos) << checked.str();
  EXPECT_NE(log.str().find(note), std::string::npos) << log.str();
  const io::FrameContent frame = io::readFrame(folder / "out/solid_plate/solid_plate_000000.vtu");
  ASSERT_NE(frame.find("velocity", false), nullptr);
  ASSERT_NE(frame.find("velocity (set)", false), nullptr);
  EXPECT_EQ(frame.find("velocity", false)->components, 3);
  EXPECT_EQ(frame.find("velocity (set)", false)->components, 1);
}

TEST(Frames, WordsThatWouldDoNothingAreRefused) {
  const ScratchFolder folder;
  std::ostringstream log;
  for (const char* const words : {R"(["grains", "stress"])", R"(["solids", "spin"])"})
    EXPECT_THROW(
        run(scene(std::string(R"(, "contents": )") + words), {.folder = folder / "out", .progress = false}, log),
        InputError)
        << words;
}

TEST(Frames, WeightsOfBothSidesAddUpToOne) {
  const ScratchFolder folder;
  runIn(folder, R"(, "contents": ["grains", "solids", "weights"])");
  const io::FrameContent grains = io::readFrame(folder / "out/grains/grains_000000.vtu");
  const io::FrameContent soil = io::readFrame(folder / "out/solid_soil/solid_soil_000000.vtu");
  const io::FrameArray& fraction = *soil.find("solid_weight", false);
  const io::FrameArray& weight = *grains.find("weight", false);
  // The weight is linear within a layer of elements: between those of the layers' borders.
  const auto solidShareAt = [&](double z) {
    for (std::size_t n = 0; n < soil.position.size(); ++n)
      if (std::abs(soil.position[n].z - z) < 1e-12) return fraction.values[n];
    throw std::runtime_error("no such node");
  };
  int within = 0;
  for (std::size_t i = 0; i < grains.position.size(); ++i) {
    const double z = grains.position[i].z;
    if (z >= 0.06) continue;
    const double low = z < 0.03 ? 0.0 : 0.03, part = (z - low) / 0.03;
    EXPECT_NEAR(weight.values[i], 1.0 - (1.0 - part) * solidShareAt(low) - part * solidShareAt(low + 0.03), 1e-12) << z;
    ++within;
  }
  EXPECT_GT(within, 20);
}

TEST(Frames, AreComparedByIds) {
  const ScratchFolder folder;
  std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}, v{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  std::vector<double> radius{0.1, 0.2, 0.3};
  std::vector<std::int64_t> id{5, 7, 9};
  const auto write = [&](const char* name) {
    io::VtuSeries(folder.path(), name, {}).write(0.5, io::ParticleFrame{x, radius, v, {}, id, {}, {}});
  };
  write("a");
  std::swap(x[0], x[2]), std::swap(v[0], v[2]), std::swap(radius[0], radius[2]), std::swap(id[0], id[2]);
  write("b");
  v[1].y += 0.5;
  write("c");
  id[1] = 8;
  write("d");
  EXPECT_TRUE(compare(folder / "a.pvd", folder / "b.pvd").within(0.0));
  const Comparison found = compare(folder / "a.pvd", folder / "c.pvd");
  for (const Difference& one : found.differences)
    EXPECT_EQ(one.largest, one.what == "a velocity" ? 0.5 : 0.0) << one.what;
  EXPECT_FALSE(compare(folder / "a.pvd", folder / "d.pvd").unlike.empty());
}

TEST(Frames, DamagedFilesAreRefused) {
  const ScratchFolder folder;
  runIn(folder, R"(, "contents": ["grains"])");
  const auto file = folder / "out/grains/grains_000001.vtu";
  const std::string whole = io::test::readText(file);
  for (const std::size_t size : {std::size_t{0}, std::size_t{40}, whole.size() / 3, whole.size() - 100}) {
    io::test::writeText(folder / "cut.vtu", whole.substr(0, size));
    EXPECT_THROW(io::readFrame(folder / "cut.vtu"), InputError) << size;
  }
  io::test::writeText(folder / "cut.pvd", "<VTKFile/>");
  EXPECT_THROW(io::readPvd(folder / "cut.pvd"), InputError);
  EXPECT_THROW(io::readFrame(folder / "none.vtu"), InputError);
  std::ostringstream out;
  for (const char* const name :
       {"out/grains.pvd", "out/grains/grains_000001.vtu", "out/summary.json", "out/summary.txt", "out"})
    EXPECT_NO_THROW(tell(folder / name, out)) << name;
}

TEST(GridFields, HoldTheMassOfTheGrains) {
  const ScratchFolder folder;
  runIn(folder, R"(, "checkpoints": 1e-3)");
  std::ostringstream log;
  const geometry::Box box{{-0.1, -0.1, -0.1}, {0.22, 0.22, 0.22}};
  writeGridFields(folder / "out", {.width = 0.03, .spacing = 0.01, .box = box, .file = folder / "f.vti"}, log);
  const io::FrameContent grid = io::readFrame(folder / "f.vti");
  const io::FrameContent grains = io::readFrame(folder / "out/grains/grains_000002.vtu");
  EXPECT_EQ(grid.position.size(), 33U * 33U * 33U);
  ASSERT_TRUE(grid.time.has_value());
  EXPECT_EQ(*grid.time, *grains.time);
  const Scene file = scene("");
  Built built = build(file);
  const dem::Particles& p = built.run->grains.particles;
  double expected = 0.0, found = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) expected += p.mass[i] * p.weightOf(i);
  for (const double density : grid.find("density", false)->values) found += 1e-6 * density;
  EXPECT_NEAR(found, expected, 5e-3 * expected);  // midpoint rule at a third of the width
  EXPECT_THROW(writeGridFields(folder / "out", {.spacing = 1e-5, .file = folder / "g.vti"}, log), InputError);
  EXPECT_THROW(writeGridFields(folder.path(), {.file = folder / "g.vti"}, log), InputError);
}

TEST(GridFields, TakeTheWidthThatTheyAdvise) {
  const ScratchFolder folder;
  runIn(folder, R"(, "checkpoints": 1e-3)");
  std::ostringstream log;
  const geometry::Box box{{0.03, 0.03, 0.03}, {0.09, 0.09, 0.09}};
  writeGridFields(folder / "out", {.advisesWidth = true, .box = box, .file = folder / "f.vti"}, log);
  const std::string told = log.str();
  std::istringstream best(told.substr(told.find("width, m", told.find("within 5 %")) + 8));
  double width = 0.0;
  best >> width;
  EXPECT_GT(width, 0.0);
  std::ostringstream kernel;
  kernel << "kernel of " << width << " m";
  EXPECT_NE(told.find(kernel.str()), std::string::npos) << told;
}

}  // namespace
}  // namespace dovetail::scene::test
