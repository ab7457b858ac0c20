// Friction, rolling and twisting between grains and skins: identities at random states.
#include <gtest/gtest.h>

#include "contact_scene.hpp"
#include "dovetail/dem/walls/wall_collide.hpp"

namespace dovetail::surface {
namespace {

constexpr double radius = 0.35;

fem::SolidMesh crookedBlock(fem::ElementShape shape, unsigned seed) {
  fem::SolidMesh mesh = fem::boxOf(shape, {4, 4, 2}, {0, 0, -2}, {4, 4, 0});
  Random random(seed);
  for (Vec3& X : mesh.X) X += random.vector(0.02);
  return mesh;
}

dem::Particles scattered(Random& random) {
  dem::Particles particles;
  for (int i = 0; i < 6; ++i)
    dem::addParticle(particles, {random(0.5, 3.5), random(0.5, 3.5), radius - 0.05}, random.vector(1.0), radius,
                     dem::Mass{2.0});
  dem::addParticle(particles, {-0.7 * radius, 2.1, 0.5 * radius}, random.vector(1.0), radius, dem::Mass{2.0});
  dem::switchOnRotation(particles);
  for (Vec3& omega : particles.omega) omega = random.vector(3.0);
  return particles;
}

class FrictionOn : public ::testing::TestWithParam<fem::ElementShape> {};
struct ShapeName {
  template <class Info>
  std::string operator()(const Info& info) const {
    return fem::name(info.param);
  }
};
INSTANTIATE_TEST_SUITE_P(Shapes, FrictionOn,
                         ::testing::Values(fem::ElementShape::hex8, fem::ElementShape::hex20, fem::ElementShape::tet4,
                                           fem::ElementShape::tet10),
                         ShapeName{});

/// Forces and couples on grains and nodes: their sum, their moment, and their power, which is that of the contacts.
TEST_P(FrictionOn, ForcesMomentsAndPowersBalance) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    Random random(seed);
    const fem::SolidMesh mesh = crookedBlock(GetParam(), seed);
    const Variant variant = seed % 2 == 0 ? Variant{"local"} : Variant{"lucy", 1.3};
    SurfaceCoupler seam(carriedSkin(mesh, variant));
    dem::Particles particles = scattered(random);
    std::vector<Vec3> u = random.field(mesh.X.size(), 0.02), v = random.field(mesh.X.size(), 1.0);
    const auto laws = rollingLaws(0.8);
    const double dt = 1e-3;
    for (int step = 0; step < 4; ++step) {  // springs grow
      for (std::size_t i = 0; i < u.size(); ++i) u[i] += dt * v[i];
      for (std::size_t i = 0; i < particles.size(); ++i) particles.x[i] += dt * particles.v[i];
      dem::clearForces(particles);
      seam.exchange(particles, u, v, *laws, dt);
    }
    const dem::WallContacts& contacts = seam.contacts();
    ASSERT_GE(contacts.size(), 5u);
    const dem::detail::AgainstFacets motion{particles, seam.wall(), contacts, true};
    double couples = 0.0, power = 0.0, atBoth = 0.0, size = 0.0;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      couples += norm(contacts.couple[c]);
      power += dot(contacts.force[c], motion.velocity(c)) +
               dot(contacts.couple[c], particles.omega[contacts.particle[c]] - motion.spin(c));
    }
    Vec3 force, moment;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      force += particles.f[i];
      moment += cross(particles.x[i], particles.f[i]) + particles.torque[i];
      atBoth += dot(particles.f[i], particles.v[i]) + dot(particles.torque[i], particles.omega[i]);
      size += norm(particles.f[i]);
    }
    for (std::size_t i = 0; i < u.size(); ++i) {
      force += seam.load().force[i];
      moment += cross(mesh.X[i] + u[i], seam.load().force[i]);
      atBoth += dot(seam.load().force[i], v[i]);
    }
    EXPECT_GT(couples, 1e-4 * size);
    EXPECT_LT(norm(force), 1e-12 * size);
    EXPECT_LT(norm(moment), 1e-11 * size);
    EXPECT_NEAR(power, atBoth, 1e-11 * size);
  }
}

/// A grain that turns with the solid under it meets neither friction nor resistance to rolling and twisting.
TEST(SkinFriction, AGrainThatTurnsWithTheSolidIsNotBraked) {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {4, 4, 2}, {0, 0, -2}, {4, 4, 0});
  for (const Variant& variant : {Variant{"local"}, Variant{"lucy", 1.3}}) {
    SurfaceCoupler seam(carriedSkin(mesh, variant));
    const Vec3 spin{0.4, -0.3, 2.0}, start{1.7, 2.2, radius - 0.02};
    const double dt = 1e-3;
    const auto laws = rollingLaws(0.8);
    double worst = 0.0, pressed = 0.0;
    for (int step = 0; step < 500; ++step) {
      const Quaternion turn = fromRotationVector(step * dt * spin);
      dem::Particles particles;
      const Vec3 x = rotate(turn, start);
      dem::addParticle(particles, x, cross(spin, x), radius, dem::Mass{2.0});
      dem::switchOnRotation(particles);
      particles.omega[0] = spin;
      particles.revision = 0;
      std::vector<Vec3> u, v;
      for (const Vec3& X : mesh.X) {
        u.push_back(rotate(turn, X) - X);
        v.push_back(cross(spin, rotate(turn, X)));
      }
      seam.exchange(particles, u, v, *laws, dt);
      ASSERT_TRUE(seam.inContact());
      pressed = norm(particles.f[0]);
      worst = std::max(
          worst, norm(particles.torque[0]) / radius + norm(particles.f[0] - pressed * rotate(turn, Vec3{0, 0, 1})));
    }
    EXPECT_LT(worst, 1e-9 * pressed) << variant.name;
  }
}

/// What a contact remembers goes across the border of two patches, whether or not the skin is split there.
TEST(SkinFriction, GoesAcrossSplitEdges) {
  std::vector<Vec3> X;
  const double slope = 5.0 * std::numbers::pi / 180.0;
  for (int j = 0; j <= 4; ++j)
    for (int i = -2; i <= 2; ++i) X.push_back({std::cos(slope) * i, 1.0 * j, -std::sin(slope) * std::abs(i)});
  std::vector<fem::Face> faces;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) faces.push_back(quad(5 * j + i, 5 * j + i + 1, 5 * j + i + 6, 5 * j + i + 5));
  const Skin whole = makeSkin(X, faces, QuadSplit::four, 0.1);  // the ridge is sharp
  Skin split = whole;
  splitAtSharpEdges(split);
  ASSERT_GT(split.X.size(), whole.X.size());
  const auto stored = [&](const Skin& skin) {
    SurfaceCoupler seam(skin);
    const std::vector<Vec3> rest(X.size());
    const auto laws = rollingLaws(1.0, 10.0);
    std::vector<double> energy;
    for (int step = 0; step < 100; ++step) {
      dem::Particles particles;
      dem::addParticle(particles, {-0.05 + 0.001 * step, 2.3, radius - 0.02}, {0.1, 0, 0}, radius, dem::Mass{1.0});
      dem::switchOnRotation(particles);
      particles.revision = 0;
      energy.push_back(seam.exchange(particles, rest, rest, *laws, 0.01).tangentialEnergy);
    }
    return energy;
  };
  const std::vector<double> ofWhole = stored(whole), ofSplit = stored(split);
  EXPECT_GT(ofWhole.back(), 5.0 * ofWhole[40]);
  for (std::size_t k = 0; k < ofWhole.size(); ++k) EXPECT_NEAR(ofSplit[k], ofWhole[k], 1e-12 * ofWhole.back()) << k;
}

}  // namespace
}  // namespace dovetail::surface
