// Faces of solids of material points in scenes.
#include <gtest/gtest.h>

#include <cmath>

#include "../../src/scene/run/frame_fields.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/coupling/run.hpp"
#include "point_scenes.hpp"

namespace dovetail::scene::test::points {
namespace {

/// A column between frictionless borders under a pressure on its top, in load steps.
TEST(PointFaces, BearPressureOnTheirFaces) {
  const Scene scene =
      sceneFromText("{" +
                        body(box, plane + R"(, "borders": [{"side": "y-", "at": 0}, {"side": "x-", "at": 0},
                 {"side": "x+", "at": 0.2}])",
                             law + R"(, "loads": [{"on": "y+", "type": "pressure", "pressure": 100}])") +
                        R"("steps": {"safety": 0.8}, "stages": [{"do": "statics", "load_steps": 2, "time": 1}]})",
                    "s.json", "/");
  Built built = started(scene);
  for (int step = 0; step < 2; ++step) built.run->loadStep(step, 2, 0.0);
  const double confined = 1e5 * 0.7 / (1.3 * 0.4);
  const std::vector<Vec3> u = displacementsOf(pointsIn(built), built.run->solid(0).nodes());
  double mean = 0.0;
  for (std::size_t p = 0; p < u.size(); ++p) {
    mean += u[p].y / static_cast<double>(u.size());
    EXPECT_NEAR(u[p].y, -100.0 / confined * built.meshes[0].X[p].y, 0.02 * 100.0 / confined * 0.4);
  }
  EXPECT_NEAR(mean, -100.0 / confined * 0.2, 0.005 * 100.0 / confined * 0.2);
}

/// Falls on a plane in place of a border, and leaves it.
TEST(PointFaces, BounceOnPlanes) {
  const Scene scene = sceneFromText(
      "{" +
          body(R"("from": "box", "box": [[0, 0.02, 0], [0.2, 0.42, 0.05]])", plane + R"(, "transfer": "apic")",
               R"("velocity": [0.3, -1, 0], )" + law +
                   R"(, "planes": [{"on": "y-", "point": [0, 0, 0], "normal": [0, 1, 0], "friction": 0.3}])") +
          R"("steps": {"dt": 1e-4}, "stages": [{"do": "run", "time": 0.2}]})",
      "s.json", "/");
  Built built = started(scene);
  const double joules = built.run->kineticEnergy();
  built.run->advance(2000);
  EXPECT_GT(pointsIn(built).renewals(), 2);
  EXPECT_LT(std::abs(built.run->ledger().residual()), 1e-2 * joules);
  const std::vector<Vec3> v = velocitiesOf(pointsIn(built), built.run->solid(0).nodes());
  Vec3 mean;
  for (const Vec3& one : v) mean += 1.0 / static_cast<double>(v.size()) * one;
  EXPECT_GT(mean.y, 0.2);
  EXPECT_LT(mean.x, 0.25);  // friction
  for (const Vec3& x : pointsIn(built).places(built.run->solid(0).nodes())) EXPECT_GT(x.y, 0.0);
}

struct Resultant {
  Vec3 force, moment;  // N, N m about the origin
};

Resultant forcesOn(const std::string& keys) {
  const Built built = started(sceneOf(body(box, plane, law + ", " + keys)));
  const fem::Nodes& nodes = built.run->solid(0).nodes();
  Resultant sum;
  for (std::size_t n = 0; n < nodes.f.size(); ++n) {
    sum.force += nodes.f[n];
    sum.moment += cross(nodes.X[n], nodes.f[n]);
  }
  return sum;
}

TEST(PointFaces, HaveSetsByPlace) {
  const Resultant left = forcesOn(
      R"("sets": [{"name": "left", "place": "box", "box": [[-1, 0.39, -1], [0.1, 0.41, 1]]}],
         "loads": [{"on": "left", "type": "pressure", "pressure": 100}])");
  EXPECT_NEAR(norm(left.force - Vec3{0, -0.5, 0}), 0.0, 1e-14);
  EXPECT_NEAR(norm(left.moment - Vec3{0, 0, -0.025}), 0.0, 1e-14);
  const Resultant corner = forcesOn(
      R"("sets": [{"name": "right", "place": "faces", "direction": [1, 0, 0], "angle": "5 deg"},
                  {"name": "low", "place": "box", "box": [[-1, -1, -1], [1, 0.2, 1]]},
                  {"name": "corner", "place": "common", "of": "right", "and": "low"},
                  {"name": "foot", "place": "common", "of": "y-", "and": "low"}],
         "loads": [{"on": "corner", "type": "traction", "traction": [0, 10, 0]},
                   {"on": "foot", "type": "traction", "traction": [20, 0, 0]}])");
  EXPECT_NEAR(norm(corner.force - Vec3{0.2, 0.1, 0}), 0.0, 1e-14);
  EXPECT_NEAR(norm(corner.moment - Vec3{0, 0, 0.02}), 0.0, 1e-14);
}

TEST(PointFaces, RefuseSetsWithoutFaces) {
  const auto refused = [](const std::string& set) {
    return refusalOfRun(body(box, plane,
                             law + R"(, "sets": [{"name": "a", )" + set +
                                 R"(}], "loads": [{"on": "a", "type": "pressure", "pressure": 1}])"));
  };
  expectParts(refused(R"("place": "sphere", "centre": [0.1, 0.2, 0], "radius": 0.05)"),
              {"solids.0.sets.0", "no nodes"});
  expectParts(refused(R"("place": "sphere", "centre": [0.1, 0.4, 0], "radius": 0.01)"), {"solids.0.loads.0", "\"a\""});
  expectParts(refused(R"("place": "faces", "direction": [0, 0, 1], "angle": "5 deg")"),
              {"solids.0.sets.0", "no face of the boundary"});
}

}  // namespace
}  // namespace dovetail::scene::test::points
