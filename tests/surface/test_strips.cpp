// Lines of plane meshes that discs touch.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "scenes.hpp"

namespace dovetail::surface {
namespace {

constexpr double radius = 0.35;
const auto laws = elasticLaws(1e4);

fem::SolidMesh square(fem::ElementShape shape) { return fem::boxOf(shape, {4, 4, 1}, {0, 0, 0}, {4, 4, 0.5}); }
Skin stripsOf(const fem::SolidMesh& mesh, const char* set = "skin") {
  return makeStrips(mesh.X, fem::faceSet(mesh, set), mesh.thickness);
}

std::vector<Vec3> planeField(std::size_t count, double size, Random& random) {
  std::vector<Vec3> u = random.field(count, size);
  for (Vec3& one : u) one.z = 0.0;
  return u;
}

TEST(Strips, LieOnBothSidesOfThePlane) {
  for (const fem::ElementShape shape : {fem::ElementShape::quad4, fem::ElementShape::quad8}) {
    const fem::SolidMesh mesh = square(shape);
    const Skin skin = stripsOf(mesh);
    EXPECT_TRUE(skin.wall.oneSided);
    EXPECT_FALSE(stripsOf(mesh, "x+").wall.oneSided);
    cg::requireRowsSumToOne(skin.carrier);
    for (std::size_t v = 0; v < skin.X.size(); ++v) {
      Vec3 off = skin.X[v] - cg::applyRow(skin.carrier, static_cast<int>(v), std::span<const Vec3>(mesh.X));
      EXPECT_LE(std::abs(off.z), 0.25);
      off.z = 0.0;
      EXPECT_LE(norm(off), 1e-15);
    }
    for (const auto& [a, b, c] : skin.wall.facets) {
      const Vec3 normal = cross(skin.X[b] - skin.X[a], skin.X[c] - skin.X[a]);
      EXPECT_GT(dot(normal, skin.X[a] - Vec3{2.0, 2.0, 0.0}), 0.0);
      EXPECT_EQ(normal.z, 0.0);
    }
  }
}

/// On faces and over corners: the forces on disc and nodes are the gradient of the stored energy, and lie in the plane.
TEST(Strips, ForcesAreTheGradientOfTheEnergy) {
  for (const fem::ElementShape shape : {fem::ElementShape::quad4, fem::ElementShape::quad8}) {
    const fem::SolidMesh mesh = square(shape);
    Random random(5);
    for (int trial = 0; trial < 20; ++trial) {
      SurfaceCoupler coupler(stripsOf(mesh));
      std::vector<Vec3> u = planeField(mesh.X.size(), 0.02, random);
      const std::vector<Vec3> way = planeField(mesh.X.size(), 1.0, random), still(u.size());
      const double along = random(0.0, 4.0);
      const bool corner = trial % 2 == 1;
      dem::Particles particles;
      dem::addParticle(particles, corner ? Vec3{4.15, 4.2, 0.0} : Vec3{along, 4.28, 0.0}, {}, radius, dem::Mass{1.0});
      const Vec3 push{0.6, 0.8, 0.0}, start = particles.x[0];
      const std::vector<Vec3> from = u;
      const auto energyAt = [&](double step) {
        for (std::size_t n = 0; n < u.size(); ++n) u[n] = from[n] + step * way[n];
        particles.x[0] = start + step * push;
        particles.f[0] = {};
        return coupler.exchange(particles, u, still, *laws, 1e-3).storedEnergy();
      };
      constexpr double step = 1e-6;
      const double above = energyAt(step), below = energyAt(-step), stored = energyAt(0.0);
      ASSERT_GT(stored, 0.0);
      double power = dot(particles.f[0], push);
      Vec3 sum = particles.f[0];
      for (const int node : coupler.load().touched) {
        const auto n = static_cast<std::size_t>(node);
        power += dot(coupler.load().force[n], way[n]);
        sum += coupler.load().force[n];
      }
      EXPECT_NEAR(power, (below - above) / (2.0 * step), 1e-5 * (norm(particles.f[0]) + std::abs(power)));
      EXPECT_LE(norm(sum), 1e-12 * norm(particles.f[0]));
      EXPECT_LE(std::abs(particles.f[0].z), 1e-12 * norm(particles.f[0]));
    }
  }
}

TEST(Strips, RefuseOtherFaces) {
  const fem::SolidMesh mesh = square(fem::ElementShape::quad4), bricks = unitBlock();
  EXPECT_THROW(makeStrips(bricks.X, fem::faceSet(bricks, "skin"), 1.0), InputError);
  EXPECT_THROW(makeStrips(mesh.X, fem::faceSet(mesh, "skin"), 0.0), InputError);
  std::vector<fem::Face> faces = fem::faceSet(mesh, "skin");
  faces[2].node[1] = 99;
  EXPECT_THROW(makeStrips(mesh.X, faces, 1.0), InputError);
  EXPECT_THROW(makeStrips(mesh.X, {}, 1.0), InputError);
}

}  // namespace
}  // namespace dovetail::surface
