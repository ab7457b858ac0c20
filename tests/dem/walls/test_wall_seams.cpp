// Surfaces that go on over seams: of one mesh without common vertices, and of several walls.
#include <gtest/gtest.h>

#include <functional>

#include "dovetail/dem/model/walls.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

ContactLaw<LinearSpringDashpot, TangentialSpring> rough() {
  ContactLaw<LinearSpringDashpot, TangentialSpring> law;
  law.normal = {.stiffness = 1e5};
  law.tangential = {.stiffness = 3e4, .friction = 0.5};
  return law;
}

using Part = std::pair<std::vector<Vec3>, std::vector<geometry::Facet>>;

Part rectangle(double from, double to, double z = 0.0, int rows = 1) {
  Part part;
  for (int j = 0; j <= rows; ++j)
    for (const double x : {from, to}) part.first.push_back({x, -2.0 + 4.0 * j / rows, z});
  for (int j = 0; j < rows; ++j) {
    const int a = 2 * j;
    part.second.insert(part.second.end(), {{a, a + 1, a + 3}, {a, a + 3, a + 2}});
  }
  return part;
}

/// Half-planes left and right of x = 0, in one wall or in two.
void addHalves(Model& m, const Part& left, const Part& right, bool two) {
  const auto add = [&](Part part) { addWall(m, MeshWall{}).wall = makeWall(part.first, part.second); };
  if (two) {
    add(left);
    return add(right);
  }
  Part both = left;
  const auto shift = static_cast<int>(left.first.size());
  both.first.insert(both.first.end(), right.first.begin(), right.first.end());
  for (const auto& [a, b, c] : right.second) both.second.push_back({a + shift, b + shift, c + shift});
  add(both);
}

struct Rolled {
  Vec3 v, omega;
  double residual;
};

/// A ball rolls and slips a little over x = 0.
Rolled rollOver(const std::function<void(Model&)>& addGround) {
  Model m;
  m.laws = makeContactLaws(rough());
  addGround(m);
  m.gravity = {0, 0, -9.81};
  addParticle(m.particles, {-0.06, 0.1, 0.1 - 0.5 * 9.81 / 1e5}, {1.0, 0.1, 0}, 0.1, Mass{0.5});
  switchOnRotation(m.particles);
  m.particles.omega[0] = {0, 9.0, 0};
  findForces(m);
  const double start = energies(m).balance();
  run(m, 5e-5, 2400);
  return {m.particles.v[0], m.particles.omega[0], energies(m).balance() - start};
}

TEST(WallSeams, ABallRollsOverSeamsAsOverThePlane) {
  const Rolled plane = rollOver([](Model& m) { addWall(m, makePlane({}, {0, 0, 1})); });
  const auto expectPlane = [&](const Part& left, const Part& right, double tolerance, const char* what) {
    for (const bool two : {false, true}) {
      const Rolled seam = rollOver([&](Model& m) { addHalves(m, left, right, two); });
      EXPECT_LE(norm(seam.v - plane.v), tolerance) << what << two;
      EXPECT_LE(norm(seam.omega - plane.omega), 10.0 * tolerance) << what << two;
      EXPECT_NEAR(seam.residual, plane.residual, 0.1 * tolerance) << what << two;
    }
  };
  expectPlane(rectangle(-2, 0), rectangle(0, 2), 1e-9, "equal corners, two walls: ");
  expectPlane(rectangle(-2, 0, 0, 3), rectangle(0, 2, 0, 2), 1e-9, "vertices within edges, two walls: ");
  expectPlane(rectangle(-2, 1e-10), rectangle(0, 2), 1e-9, "a lap of 1e-9 R, two walls: ");
  expectPlane(rectangle(-2, -1e-10), rectangle(0, 2), 1e-9, "a gap of 1e-9 R, two walls: ");
  expectPlane(rectangle(-2, 1e-4), rectangle(0, 2), 1e-9, "a lap of 1e-3 R, two walls: ");
}

TEST(WallSeams, TwoWallsThatMeetPushOnceAtTheSeam) {
  for (const bool two : {false, true}) {
    Model m;
    m.laws = makeContactLaws(ElasticLaw{{1e5}});
    addHalves(m, rectangle(-2, 0), rectangle(0, 2), two);
    for (const double x : {-0.05, 0.0, 1e-3, 0.05})
      addParticle(m.particles, {x, 0.4 * static_cast<double>(m.particles.size()), 0.1 - 1e-3}, {}, 0.1, Mass{0.5});
    findForces(m);
    for (const Vec3& f : m.particles.f) EXPECT_LE(norm(f - Vec3{0, 0, 100.0}), 1e-9) << two;
    EXPECT_NEAR(m.work.elasticEnergy, 4 * 0.05, 1e-12);
  }
}

TEST(WallSeams, WallsOfOtherMaterialsActEachForItself) {
  Model m;
  m.laws = makeContactLaws(LawTable<ElasticLaw>(2, ElasticLaw{{1e5}}));
  addHalves(m, rectangle(-2, 0), rectangle(0, 2), true);
  meshWall(m, 1).wall.material = 1;
  addParticle(m.particles, {0, 0, 0.1 - 1e-3}, {}, 0.1, Mass{0.5});
  findForces(m);
  EXPECT_NEAR(m.particles.f[0].z, 200.0, 1e-9);
}

TEST(WallSeams, AMeshAtRestSweepsOnlyVerticesOfItsContacts) {
  Model m;
  m.laws = makeContactLaws(ElasticLaw{{1e5}});
  addWall(m, MeshWall{}).wall = squares(40, 40, 0.1);
  addParticle(m.particles, {0.52, 0.53, 0.1 - 1e-3}, {0.5, 0, 0}, 0.1, Mass{0.5});
  findForces(m);
  auto& wall = meshWall(m, 0).wall;
  wall.f.back() = {1, 2, 3};  // far from all contacts: nobody looks there
  run(m, 1e-5, 100);
  EXPECT_EQ(wall.f.back(), (Vec3{1, 2, 3}));
  wall.f.back() = {};
  EXPECT_NEAR(norm(totalForce(wall) + m.particles.f[0]), 0.0, 1e-12);
}

}  // namespace
}  // namespace dovetail::dem
