// Sizes of grains, and insertions that begin and end.
#include <gtest/gtest.h>

#include <numbers>
#include <sstream>

#include "../io/scratch_folder.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/setup/streams.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/scene/read.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

using io::test::ScratchFolder;

std::string insertion(const std::string& keys) {
  return R"("insertions": [{"region": [[0, 0, 0], [1, 1, 1]], "density": 1000, )" + keys + "}],";
}
const std::string sizes = R"("radius": {"smallest": 0.01, "largest": 0.02}, )";

const dem::Insertion& firstOf(Built& built) {
  return built.run->grains.terms.all<dem::InsertionTerm>().front()->insertion;
}

TEST(Insertions, HaveAllSizesOfTheLibrary) {
  const auto sizesOf = [](const std::string& radius) {
    Built built = build(sceneOf(insertion(R"("number_per_second": 9, "radius": {)" + radius + "}")));
    return firstOf(built).settings.sizes;
  };
  const auto normal = std::get<dem::NormalSizes>(
      sizesOf(R"("distribution": "normal", "mean": "1 cm", "deviation": "1 mm", "smallest": 0.005, "largest": 0.015)"));
  EXPECT_EQ(normal.mean, 0.01);
  EXPECT_EQ(normal.deviation, 1e-3);
  EXPECT_EQ(normal.largest, 0.015);
  const auto logNormal = std::get<dem::LogNormalSizes>(sizesOf(
      R"("distribution": "log-normal", "median": 0.01, "log_deviation": 0.2, "smallest": 0.005, "largest": 0.015)"));
  EXPECT_EQ(logNormal.median, 0.01);
  EXPECT_EQ(logNormal.logDeviation, 0.2);
  const auto classes = std::get<dem::SizeClasses>(
      sizesOf(R"("distribution": "classes", "classes": [{"radius": 0.01, "number": 3}, {"radius": 0.02}])"));
  EXPECT_EQ(classes.radius, (std::vector<double>{0.01, 0.02}));
  EXPECT_EQ(classes.number, (std::vector<double>{3.0, 1.0}));
  const auto curve =
      std::get<dem::GradingCurve>(sizesOf(R"("distribution": "sieves", "sieves": [{"opening": 0.01, "passing": 0},
                 {"opening": 0.02, "passing": "40 %"}, {"opening": 0.04, "passing": 1}])"));
  EXPECT_EQ(curve.diameter, (std::vector<double>{0.01, 0.02, 0.04}));
  EXPECT_EQ(curve.passing, (std::vector<double>{0.0, 0.4, 1.0}));
  EXPECT_EQ(std::get<dem::UniformSizes>(sizesOf(R"("smallest": 0.01, "largest": 0.02)")).largest, 0.02);
}

TEST(Insertions, AreWrittenBackInFull) {
  const Scene scene = sceneOf(insertion(R"("radius": {"distribution": "classes", "classes": [{"radius": 0.01}]},
      "number_per_second": 9, "from": 0.1, "until": "200 ms", "total_number": 7, "total_mass": "3 kg", "spin": [0, 0, 1])"));
  const Scene again = sceneFromText(sceneText(scene), "s.json", "/");
  EXPECT_EQ(sceneText(again), sceneText(scene));
  const Insertion& one = again.insertions.front();
  EXPECT_EQ(one.from, 0.1);
  EXPECT_EQ(one.until, 0.2);
  EXPECT_EQ(one.totalNumber, 7);
  EXPECT_EQ(one.totalMass, 3.0);
  EXPECT_EQ(one.spin.z, 1.0);
  EXPECT_EQ(std::get<SizeClasses>(one.radius->distribution).classes.front().number, 1.0);
}

TEST(Insertions, WhatCannotBeIsRefused) {
  const auto refused = [](const std::string& keys, std::initializer_list<const char*> parts) {
    std::string message;
    try {
      started(sceneOf(insertion(keys)));
    } catch (const InputError& error) {
      message = error.what();
    }
    expectParts(message, parts);
  };
  const std::string rate = R"("number_per_second": 9, )";
  refused(sizes + R"("from": 2, "until": 1, "number_per_second": 9)", {"insertions.0", "ends at 1 s", "\"until\""});
  refused(sizes + R"("number_per_second": 9, "mass_per_second": 1)", {"one rate", "replaces_leavers"});
  refused(sizes + R"("number_per_second": 9, "replaces_leavers": true)", {"one rate"});
  refused(sizes + R"("seed": 1)", {"one rate"});
  refused(R"("number_per_second": 9)", {"no grains", "clumps"});
  refused(rate + sizes + R"("clumps": [{"spheres": [{"at": [0, 0, 0], "radius": 0.1}]}])", {"a radius and clumps"});
  refused(rate + R"("clumps": [])", {"no grains"});
  refused(rate + R"("radius": {"distribution": "odd"})", {"\"odd\"", "sieves"});
  refused(rate + R"("radius": {"distribution": "sieves", "sieves": [{"opening": 0.02, "passing": 0},
      {"opening": 0.01, "passing": 1}]})",
          {"sieve 1", "out of order", "insertions.0"});
  refused(rate + R"("radius": {"distribution": "normal", "smallest": 0.01, "largest": 0.02})", {"\"mean\" is missing"});
  refused(rate + R"("radius": {"mean": 0.01, "smallest": 0.01, "largest": 0.02})", {"no key \"mean\""});
  refused(rate + R"("radius": {"smallest": 0.4, "largest": 0.6})", {"does not fit"});
}

/// @return the last row of the series of a run
std::map<std::string, double> lastRow(const Scene& scene) {
  const ScratchFolder folder;
  std::ostringstream log;
  EXPECT_TRUE(run(scene, {.folder = folder.path(), .progress = false}, log));
  const io::TimeSeries series = io::readCsv(folder / "series.csv");
  std::map<std::string, double> row;
  for (const std::string& name : series.names()) row[name] = series.column(name).back();
  return row;
}

TEST(Insertions, EndAndAreCounted) {
  const auto row = lastRow(sceneOf(R"("gravity": [0, 0, -10], "output": {"series": 1e-4}, )" +
                                   insertion(sizes + R"("number_per_second": 2e5, "from": 2e-4, "total_number": 60,
      "velocity": [0, 0, -200])") + R"("outlets": [{"region": [[0, 0, -9], [1, 1, 0.2]]}],)"));
  EXPECT_EQ(row.at("entered"), 60.0);
  EXPECT_GT(row.at("left"), 5.0);
  EXPECT_EQ(row.at("entered") - row.at("left"), row.at("particles"));
  EXPECT_GT(row.at("entered_kg"), row.at("left_kg"));
  const double weighed = row.at("entered_kg") * 10.0 * 200.0 * 1e-5;  // work of the weight in one step
  EXPECT_NEAR(row.at("residual_J"), 0.0, weighed);
}

TEST(Insertions, ReplaceThoseWhoLeave) {
  const auto row = lastRow(sceneOf(R"("output": {"series": 1e-4}, "particles": [{"from": "lattice",
      "box": [[0, 0, 2], [1, 1, 2.02]], "radius": 0.01, "distance": 0.1, "density": 1000, "velocity": [0, 0, 900]}],
      "outlets": [{"region": [[0, 0, 2.5], [1, 1, 9]]}], )" +
                                   insertion(sizes + R"("replaces_leavers": true)")));
  EXPECT_GT(row.at("left"), 50.0);
  EXPECT_EQ(row.at("entered") + row.at("no_room"), row.at("left"));
}

TEST(Insertions, BringClumps) {
  Built built = started(sceneOf(R"("gravity": [0, 0, -10],)" + insertion(R"("number_per_second": 2e4, "total_number": 8,
      "spin": [1, 2, 3], "clumps": [
      {"spheres": [{"at": [0, 0, 0], "radius": 0.02}, {"at": [0.05, 0, 0], "radius": 0.02}]},
      {"spheres": [{"at": [7, 0, 0], "radius": 0.03}]}])")));
  built.run->advance(100);
  const auto* const term = std::as_const(built.run->grains).terms.all<dem::BodyTerm>().front();
  ASSERT_EQ(term->bodies.size(), 8U);
  double mass = 0.0;
  for (const double m : term->bodies.mass) mass += m;
  EXPECT_NEAR(mass, firstOf(built).insertedMass, 1e-12);
  EXPECT_NEAR(built.run->totals().mass, mass, 1e-12);  // of bodies, not of their spheres
  EXPECT_NEAR(built.run->totals().massResidual, 0.0, 1e-12);
  const double one = 4.0 / 3.0 * std::numbers::pi * 1000.0;
  EXPECT_NEAR(firstOf(built).settings.shapes[0].properties.mass, 2.0 * one * 8e-6, 1e-9);
  EXPECT_NEAR(firstOf(built).settings.shapes[1].properties.mass, one * 27e-6, 1e-9);
}

TEST(Packings, HaveAllSizesOfTheLibrary) {
  const Built built = build(sceneOf(R"("particles": [{"from": "packing", "box": [[0, 0, 0], [1, 1, 1]], "density": 1,
      "radius": {"distribution": "classes", "classes": [{"radius": 0.05, "number": 4}, {"radius": 0.1}]},
      "solid_fraction": 0.5}],)"));
  const dem::Particles& p = built.run->grains.particles;
  double volume = 0.0;
  std::size_t large = 0;
  for (const double r : p.radius) {
    EXPECT_TRUE(r == 0.05 || r == 0.1);
    large += r == 0.1;
    volume += 4.0 / 3.0 * std::numbers::pi * r * r * r;
  }
  EXPECT_NEAR(volume, 0.5, 2.1e-3);  // to half of the largest
  EXPECT_NEAR(static_cast<double>(large) / static_cast<double>(p.size()), 0.2, 4.0 * 0.4 / std::sqrt(p.size()));
}

}  // namespace
}  // namespace dovetail::scene::test
