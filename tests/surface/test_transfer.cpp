// Forces, power and moments between particles and nodes.
#include <gtest/gtest.h>

#include "scenes.hpp"

namespace dovetail::surface {
namespace {

constexpr double radius = 0.35;
const auto elastic = elasticLaws(1e4), damped = elasticLaws(1e4, 0.3);

/// Particles all over the block: on faces, near edges and at a corner.
dem::Particles scattered(Random& random) {
  dem::Particles particles;
  const double sunk = radius - 0.03;
  const auto add = [&](const Vec3& x) { dem::addParticle(particles, x, random.vector(1.0), radius, dem::Mass{2.0}); };
  for (int i = 0; i < 5; ++i) add({random(0.5, 3.5), random(0.5, 3.5), sunk});
  for (int i = 0; i < 3; ++i) add({-sunk, random(0.5, 3.5), random(-1.5, -0.5)});
  for (int i = 0; i < 3; ++i) add({random(0.5, 3.5), random(0.5, 3.5), -2.0 - sunk});
  for (int i = 0; i < 3; ++i) add({random(0.5, 3.5), 4.0 + 0.7 * sunk, 0.7 * sunk});
  add({4.0 + 0.57 * sunk, 4.0 + 0.57 * sunk, 0.57 * sunk});
  return particles;
}

struct Scene {
  fem::SolidMesh mesh = unitBlock();
  Random random;
  dem::Particles particles;
  std::vector<Vec3> u, v;
  explicit Scene(unsigned seed)
      : random(seed),
        particles(scattered(random)),
        u(random.field(mesh.X.size(), 0.02)),
        v(random.field(mesh.X.size(), 3.0)) {}
};

double power(std::span<const Vec3> f, std::span<const Vec3> v) {
  double sum = 0.0;
  for (std::size_t i = 0; i < f.size(); ++i) sum += dot(f[i], v[i]);
  return sum;
}

struct Balance {
  double size = 0.0;
  Vec3 force, moment;
};

Balance balanceOf(const Scene& scene, std::span<const Vec3> onParticles, std::span<const Vec3> onNodes) {
  Balance balance;
  for (std::size_t p = 0; p < onParticles.size(); ++p) {
    balance.force += onParticles[p];
    balance.moment += cross(scene.particles.x[p], onParticles[p]);
    balance.size += norm(onParticles[p]);
  }
  for (std::size_t i = 0; i < onNodes.size(); ++i) {
    balance.force += onNodes[i];
    balance.moment += cross(scene.mesh.X[i] + scene.u[i], onNodes[i]);
  }
  return balance;
}

class Transfer : public ::testing::TestWithParam<Variant> {};

/// Power at contacts and vertices, with the weights that carry the force.
struct ContactPower {
  double atContacts = 0.0, atVertices = 0.0;
};

ContactPower powerOf(const SurfaceCoupler& seam) {
  ContactPower power;
  dem::TriangulatedWall wall = seam.wall();
  wall.f.assign(wall.x.size(), Vec3{});
  dem::addWallForces(seam.contacts(), wall);
  power.atVertices = dem::forcePower(wall);
  for (std::size_t c = 0; c < seam.contacts().size(); ++c)
    power.atContacts -= dot(seam.contacts().force[c], dem::wallVelocity(seam.contacts(), wall, c));
  return power;
}

TEST_P(Transfer, PowerIsTheSameAtContactsVerticesAndNodes) {
  for (unsigned seed : {1u, 2u, 3u}) {
    Scene scene(seed);
    SurfaceCoupler seam = makeSeam(scene.mesh, GetParam());
    const Response response = respond(seam, scene.particles, scene.u, scene.v, *damped);
    ASSERT_GE(response.contacts, 12);
    const double atNodes = power(response.onNodes, scene.v);
    const ContactPower there = powerOf(seam);
    double size = 0.0;
    for (std::size_t i = 0; i < scene.v.size(); ++i) size += norm(response.onNodes[i]) * norm(scene.v[i]);
    EXPECT_GT(std::abs(atNodes), 1e-3 * size);
    EXPECT_NEAR(there.atVertices, atNodes, 1e-14 * size);
    EXPECT_NEAR(there.atContacts, atNodes, 1e-14 * size);
  }
}

TEST_P(Transfer, ForcesBalance) {
  for (unsigned seed : {4u, 5u}) {
    Scene scene(seed);
    SurfaceCoupler seam = makeSeam(scene.mesh, GetParam());
    const Response response = respond(seam, scene.particles, scene.u, scene.v, *damped);
    const Balance balance = balanceOf(scene, response.onParticles, response.onNodes);
    EXPECT_LE(norm(balance.force), 1e-13 * balance.size);
  }
}

/// In the deformed configuration, turned as a whole by any angle, for elastic contacts.
TEST_P(Transfer, MomentsBalanceAtAnyTurn) {
  for (unsigned seed : {6u, 7u, 8u}) {
    Scene scene(seed);
    SurfaceCoupler seam = makeSeam(scene.mesh, GetParam());
    const Quaternion turn = fromRotationVector(seed == 6u ? Vec3{} : scene.random.vector(2.0));
    const Vec3 shift = scene.random.vector(3.0);
    for (std::size_t i = 0; i < scene.u.size(); ++i)
      scene.u[i] = rotate(turn, scene.mesh.X[i] + scene.u[i]) + shift - scene.mesh.X[i];
    for (Vec3& x : scene.particles.x) x = rotate(turn, x) + shift;
    const Response response = respond(seam, scene.particles, scene.u, scene.v, *elastic);
    ASSERT_GE(response.contacts, 10);
    const Balance balance = balanceOf(scene, response.onParticles, response.onNodes);
    EXPECT_LE(norm(balance.force), 1e-13 * balance.size);
    EXPECT_LE(norm(balance.moment), 1e-11 * balance.size);
  }
}

INSTANTIATE_TEST_SUITE_P(Variants, Transfer, ::testing::ValuesIn(allVariants()), VariantName{});

Response spread(Scene& scene, const cg::SurfaceKernel& kernel) {
  const auto faces = scene.mesh.faceSets.at("skin");
  SurfaceCoupler seam(makeSkin(scene.mesh.X, faces));
  seam.spreadLoad(SpreadLoad(kernel, scene.mesh.X, seam.skin(), faces));
  dem::Particles particles = scene.particles;
  seam.exchange(particles, scene.u, scene.v, *elastic, 1e-3);
  return {0.0, particles.f, seam.load().force, static_cast<int>(seam.contacts().size())};
}

TEST(SpreadTransfer, ForcesBalanceForEveryWidth) {
  Scene scene(8);
  for (auto shape : {cg::KernelShape::lucy, cg::KernelShape::gauss})
    for (double width : {0.0, 0.1, 0.7, 1.3, 6.0}) {
      const Response response = spread(scene, {{shape, 2, width}, {}});
      const Balance balance = balanceOf(scene, response.onParticles, response.onNodes);
      EXPECT_LE(norm(balance.force), 1e-14 * balance.size) << "width " << width;
    }
}

TEST(SpreadTransfer, WidthZeroIsThePointTransfer) {
  Scene scene(9);
  SurfaceCoupler local = makeSeam(scene.mesh, {"local"});
  const Response point = respond(local, scene.particles, scene.u, scene.v, *elastic);
  const Response zero = spread(scene, {{cg::KernelShape::lucy, 2, 0.0}, {}});
  const Response wide = spread(scene, {{cg::KernelShape::lucy, 2, 1.3}, {}});
  double size = 0.0, difference = 0.0, toWide = 0.0;
  for (std::size_t i = 0; i < point.onNodes.size(); ++i) {
    size = std::max(size, norm(point.onNodes[i]));
    difference = std::max(difference, norm(point.onNodes[i] - zero.onNodes[i]));
    toWide = std::max(toWide, norm(point.onNodes[i] - wide.onNodes[i]));
  }
  EXPECT_EQ(point.onParticles, zero.onParticles);
  EXPECT_LE(difference, 1e-14 * size);
  EXPECT_GT(toWide, 0.1 * size);
}

TEST(SpreadTransfer, CreatesPower) {
  Scene scene(10);
  const auto faces = scene.mesh.faceSets.at("skin");
  SurfaceCoupler seam(makeSkin(scene.mesh.X, faces));
  seam.spreadLoad(SpreadLoad({{cg::KernelShape::lucy, 2, 1.3}, {}}, scene.mesh.X, seam.skin(), faces));
  seam.exchange(scene.particles, scene.u, scene.v, *elastic, 1e-3);
  const double atNodes = power(seam.load().force, scene.v), atContacts = powerOf(seam).atContacts;
  EXPECT_GT(std::abs(atNodes - atContacts), 0.01 * std::abs(atContacts));
}

TEST(NodalLoad, ClearsOnlyWhatItTouched) {
  coupling::NodalLoad load(4);
  load.add(2, {1, 0, 0});
  load.add(0, {0, 1, 0});
  load.add(2, {1, 0, 0});
  EXPECT_EQ(load.touched, (std::vector<int>{2, 0}));
  EXPECT_EQ(load.force[2], (Vec3{2, 0, 0}));
  load.clear();
  EXPECT_TRUE(load.touched.empty());
  for (const Vec3& f : load.force) EXPECT_EQ(f, Vec3{});
  load.add(2, {0, 0, 1});
  EXPECT_EQ(load.touched, (std::vector<int>{2}));
}

}  // namespace
}  // namespace dovetail::surface
