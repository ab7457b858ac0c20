// Held grains, meshes that turn, lattices and clumps in periodic space, insertions without room: what scenes say of
// them.
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "../../src/scene/run/probes.hpp"
#include "../io/scratch_folder.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "dovetail/scene/execute.hpp"
#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

const std::string held =
    R"("particles": [{"from": "list", "name": "g", "density": 2500, "spheres": [{"at": [0, 0, 0], "radius": 0.01}]}],)";

TEST(SceneDrives, TellTheForceAndTheTorqueThatTheyTake) {
  Scene file = sceneOf(held + R"("drives": [{"group": "g"}], "walls": [{"shape": "plane", "point": [0, 0, 0.009],
      "normal": [0, 0, -1], "velocity": [0.5, 0, 0]}],)");
  file.output.probes = {{"d", DriveProbe{0}, ""}, {"w", WallProbe{"0"}, ""}};
  Built built = started(file);
  const Probes probes(built, file);
  built.run->advance(2000);
  std::vector<double> row;
  probes.add(built, row);
  EXPECT_EQ(probes.names()[4], "d_my_Nm");
  const double friction = 0.3 * 1e4 * 0.001;
  EXPECT_NEAR(row[0], -friction, 1e-9);
  EXPECT_NEAR(row[4], -friction * 0.009, 1e-11);
  EXPECT_NEAR(row[6], -friction, 1e-9);
  file.output.probes = {{"d", DriveProbe{1}, ""}};
  EXPECT_THROW(Probes(built, file), InputError);
}

TEST(SceneDrives, GiveTheSpinThatIsAskedFor) {
  Built built = started(sceneOf(held + R"("drives": [{"group": "g", "spin": [0, 0, 7]}],)"));
  built.run->advance(10);
  EXPECT_EQ(built.run->grains.particles.omega[0], (Vec3{0, 0, 7}));
  const Scene relaxes = sceneFromText("{" + law + held + R"("drives": [{"group": "g", "spin": [0, 0, 7]}],
      "stages": [{"do": "relax"}]})",
                                      "s.json", "/");
  EXPECT_THROW(build(relaxes), InputError);
}

/// A strip in the plane y = 0 whose left half is cut into many triangles.
TEST(SceneWalls, AMeshTurnsAboutTheCentroidOfItsSurfaceHoweverItIsCutOrAboutItsPoint) {
  const io::test::ScratchFolder folder;
  std::vector<Vec3> x;
  std::vector<geometry::Facet> facets;
  const double at[] = {0.0, 0.01, 0.02, 0.03, 0.04, 0.05, 1.0};
  for (const double place : at)
    for (const double z : {0.0, 1.0}) x.push_back({place, 0.0, z});
  for (int k = 0; k < 12; k += 2) {
    facets.push_back({k, k + 2, k + 1});
    facets.push_back({k + 1, k + 2, k + 3});
  }
  mesh_io::writeStl(folder / "strip.stl", x, facets);
  const auto speed = [&](const std::string& more) {
    Built built = started(
        sceneOf(R"("walls": [{"shape": "mesh", "file": "strip.stl", "angular_velocity": [0, 2, 0])" + more + "}],",
                folder.path()));
    built.run->advance(1);
    return dem::meshWall(built.run->grains, 0).wall.v[0];
  };
  EXPECT_LT(norm(speed("") - Vec3{-1, 0, 1}), 1e-4);
  EXPECT_LT(norm(speed(R"(, "point": [0, 0, 0.25])") - Vec3{-0.5, 0, 0}), 1e-4);
}

TEST(SceneLattices, RepeatAlongPeriodicAxesThatTheySpan) {
  const auto lattice = [](const std::string& length, const std::string& axes) {
    return R"("periodic": {"box": [[0, 0, 0], [)" + length + "," + length + "," + length + R"(]], "axes": [)" + axes +
           R"(]}, "particles": [{"from": "lattice", "lattice": "face-centred", "radius": 0.005, "density": 2500,
              "box": [[0, 0, 0], [)" +
           length + "," + length + "," + length + "]]}],";
  };
  const std::string three = "0.042426406871192854";
  const auto count = [&](const std::string& axes) {
    const Built built = started(sceneOf(lattice(three, axes)));
    const dem::Model& m = built.run->grains;
    for (std::size_t k = 0; k < m.pairs.size(); ++k) {
      const auto& [i, j] = m.pairs.pairs()[k];
      const Vec3 apart = m.particles.x[static_cast<std::size_t>(i)] - m.particles.x[static_cast<std::size_t>(j)];
      EXPECT_GT(norm(apart + m.pairs.shift(k)), 0.01 * (1.0 - 1e-9));
    }
    return m.particles.size();
  };
  EXPECT_EQ(count(R"("x", "y", "z")"), 108U);
  EXPECT_EQ(count(R"("z")"), 75U);
  expectParts(refusalOfRun(lattice("0.045", R"("x")")), {"no multiple of the lattice's cell", "make it 0.0424264"});
}

TEST(SceneClumps, HaveSpheresWithoutVelocitiesOfTheirOwn) {
  expectParts(refusalOfRun(R"("clumps": [{"density": 2500, "at": [0, 0, 0], "spheres": [
      {"at": [0, 0, 0], "radius": 0.01, "velocity": [5, 0, 0]}]}],)"),
              {"velocity"});
}

TEST(SceneClumps, LongerThanAPeriodAreRefusedByName) {
  expectParts(refusalOfRun(R"("periodic": {"box": [[0, 0, 0], [0.1, 0.1, 0.1]], "axes": ["y"]},
      "clumps": [{"density": 2500, "at": [0, 0, 0], "spheres": [{"at": [0, 0, 0], "radius": 0.01}]},
                 {"density": 2500, "at": [0.05, 0, 0], "spheres": [{"at": [0, 0, 0], "radius": 0.01},
                  {"at": [0.09, 0, 0], "radius": 0.01}]}],)"),
              {"clumps.1", "m long", "0.1 m along y"});
}

TEST(SceneInsertions, TellHowManyNewcomersFoundNoRoom) {
  const io::test::ScratchFolder folder;
  const Scene file = sceneFromText("{" + law + R"("insertions": [{"region": [[0, 0, 0], [0.02, 0.02, 0.02]],
      "radius": {"smallest": 0.002, "largest": 0.002}, "density": 1000, "number_per_second": 20000}],
      "steps": {"dt": 5e-5}, "stages": [{"do": "run", "time": 0.02}], "output": {"series": 0.01}})",
                                   "s.json", "/");
  std::ostringstream log;
  run(file, {.folder = folder / "out", .progress = false}, log);
  const io::TimeSeries series = io::readCsv(folder / "out" / "series.csv");
  const double entered = series.column("particles").back(), dropped = series.column("no_room").back();
  EXPECT_GT(dropped, 100.0);
  EXPECT_EQ(entered + dropped, 400.0);
  expectParts(log.str(), {"WARNING", "insertion 0", "found no room"});
  std::ifstream summary(folder / "out" / "summary.json");
  const std::string text{std::istreambuf_iterator<char>(summary), {}};
  expectParts(text, {"\"no_room\": ", "grains found no room and were not inserted"});
}

}  // namespace
}  // namespace dovetail::scene::test
