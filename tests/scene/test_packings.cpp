// Packings by number, in cylinders and in closed surfaces.
#include <cmath>
#include <numbers>

#include "../io/scratch_folder.hpp"
#include "dovetail/geometry/triangle.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "refusal.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test {
namespace {

std::string packing(const std::string& region, const std::string& more) {
  return R"("particles": [{"from": "packing", "density": 2500, )" + region + ", " + more + "}],";
}
const std::string sizes = R"("radius": {"smallest": 0.004, "largest": 0.006})";

TEST(ScenePackings, HaveTheNumberThatIsAskedFor) {
  const std::string box = R"("box": [[0, 0, 0], [0.05, 0.05, 0.05]])";
  for (const int number : {1, 7, 110})
    EXPECT_EQ(
        build(sceneOf(packing(box, sizes + ", \"number\": " + std::to_string(number)))).run->grains.particles.size(),
        static_cast<std::size_t>(number));
  expectParts(refusalOfRun(packing(box, sizes + R"(, "number": 400)")), {"particles.0", "400 spheres", "fit"});
  expectParts(refusalOfRun(packing(box, sizes + R"(, "number": 140)")), {"particles.0", "holds 12", "not 140"});
  expectParts(refusalOfRun(packing(box, sizes + R"(, "number": 10, "solid_fraction": 0.5)")),
              {"particles.0", "both a number and a solid_fraction"});
}

TEST(ScenePackings, LieWhollyInsideATiltedCylinder) {
  const std::string cylinder = R"("cylinder": {"point": [1, 2, 3], "axis": [1, 2, 2], "radius": 0.03, "length": 0.1})";
  const Built built = build(sceneOf(packing(cylinder, sizes + R"(, "solid_fraction": 0.5)")));
  const dem::Particles& p = built.run->grains.particles;
  double volume = 0.0, lowest = 1.0, highest = 0.0, widest = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec3 d = p.x[i] - Vec3{1, 2, 3}, axis = Vec3{1, 2, 2} / 3.0;
    const double height = dot(d, axis), side = norm(d - height * axis), slack = 1e-3 * p.radius[i];
    EXPECT_GT(height, p.radius[i] - slack);
    EXPECT_LT(height, 0.1 - p.radius[i] + slack);
    EXPECT_LT(side, 0.03 - p.radius[i] + slack);
    lowest = std::min(lowest, height - p.radius[i]);
    highest = std::max(highest, height + p.radius[i]);
    widest = std::max(widest, side + p.radius[i]);
    volume += 4.0 / 3.0 * std::numbers::pi * std::pow(p.radius[i], 3);
  }
  EXPECT_NEAR(volume / (std::numbers::pi * 9e-4 * 0.1), 0.5, 0.005);
  EXPECT_LT(lowest, 0.002);
  EXPECT_GT(highest, 0.098);
  EXPECT_GT(widest, 0.028);
  expectParts(
      refusalOfRun(packing(R"("cylinder": {"point": [0, 0, 0], "axis": [0, 0, 0], "radius": 1, "length": 1})", sizes)),
      {"particles.0", "no length"});
  expectParts(refusalOfRun(packing(cylinder + R"(, "box": [[0, 0, 0], [1, 1, 1]])", sizes)),
              {"particles.0", "one of box, cylinder and surface"});
  expectParts(refusalOfRun(R"("particles": [{"from": "packing", "density": 1, )" + sizes + "}],"),
              {"particles.0", "one of box, cylinder and surface"});
}

/// An L of two boxes, whose inner edge grains must pass.
TEST(ScenePackings, LieWhollyInsideAClosedSurface) {
  const io::test::ScratchFolder folder;
  std::vector<Vec3> x;
  for (const double y : {0.0, 1.0})
    for (const Vec3& corner :
         {Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{2, 0, 1}, Vec3{1, 0, 1}, Vec3{1, 0, 2}, Vec3{0, 0, 2}})
      x.push_back({corner.x, y, corner.z});
  std::vector<geometry::Facet> facets{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  for (int k = 0; k < 4; ++k)
    facets.push_back({facets[static_cast<std::size_t>(k)][0] + 6, facets[static_cast<std::size_t>(k)][2] + 6,
                      facets[static_cast<std::size_t>(k)][1] + 6});
  for (int k = 0; k < 6; ++k) {
    const int next = (k + 1) % 6;
    facets.push_back({k, k + 6, next});
    facets.push_back({next, k + 6, next + 6});
  }
  mesh_io::writeStl(folder / "l.stl", x, facets);
  const std::string surface = R"("surface": {"file": "l.stl", "scale": 0.05, "shift": [10, 0, 0]})";
  for (const char* const amount : {R"("solid_fraction": 0.52)", R"("number": 300)"}) {
    const Built built = build(sceneOf(packing(surface, sizes + ", " + amount), folder.path()));
    const dem::Particles& p = built.run->grains.particles;
    EXPECT_GT(p.size(), 290U);
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vec3 at = (p.x[i] - Vec3{10, 0, 0}) / 0.05;
      EXPECT_GT(geometry::windingNumber(x, facets, at), 0.5) << i;
      double nearest = 1.0;
      for (const geometry::Facet& f : facets)
        nearest = std::min(nearest, norm(at - geometry::closestPointOnTriangle(at, x[static_cast<std::size_t>(f[0])],
                                                                               x[static_cast<std::size_t>(f[1])],
                                                                               x[static_cast<std::size_t>(f[2])])
                                                  .point));
      EXPECT_GT(0.05 * nearest, (1.0 - 1.5e-3) * p.radius[i]);
    }
  }
  facets.pop_back();
  mesh_io::writeStl(folder / "open.stl", x, facets);
  try {
    build(sceneOf(packing(R"("surface": {"file": "open.stl", "scale": 0.05})", sizes), folder.path()));
    FAIL();
  } catch (const InputError& error) {
    expectParts(error.what(), {"particles.0", "closed"});
  }
}

}  // namespace
}  // namespace dovetail::scene::test
