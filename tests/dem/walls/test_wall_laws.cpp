// Laws at walls that turn and at edges: spins, couples on facets, one potential whatever the law.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/dem/walls/facet_spin.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

using RollingLaw = ContactLaw<HertzDashpot, MindlinSpring, RollingAndTwisting>;
const RollingLaw rollingLaw{{1e6, 0.6}, {0.8, 0.4, 0.3}, {{0.2, 0.4, 0.3}, {0.1, 0.3, 0.3}}, {}};
constexpr double dt = 1e-4;
const Vec3 about{0.7, -1.1, 1.9};  // angular velocity, rad/s

Vec3 rigid(const Vec3& x) { return Vec3{0.3, -0.2, 0.1} + cross(about, x); }

/// A particle that moves with its wall as one body.
Particles rider() {
  Particles particles;
  addParticle(particles, {1.3, 1.1, 0.95}, rigid({1.3, 1.1, 0.95}), 1.0, Mass{2.0});
  switchOnRotation(particles);
  particles.omega[0] = about;
  return particles;
}

TriangulatedWall turningMesh() {
  TriangulatedWall mesh = squares(2, 2, 1.5);
  for (std::size_t k = 0; k < mesh.x.size(); ++k) mesh.v[k] = rigid(mesh.x[k]);
  return mesh;
}

WallContacts contactsOf(const Particles& particles, const TriangulatedWall& mesh) {
  WallCandidates candidates;
  WallContacts contacts;
  findWallCandidates(particles, mesh, 0.5, candidates);
  findWallContacts(particles, mesh, candidates, EdgeRule::projected, contacts);
  return contacts;
}

TEST(WallLaws, NothingRubsOnAWallThatTurnsWithTheParticle) {
  const auto laws = makeContactLaws(rollingLaw);
  Particles onPlane = rider(), onMesh = rider();
  PrimitiveWall plane = makePlane({}, {0, 0, 1});
  plane.velocity = rigid({});
  plane.angularVelocity = about;
  findContacts(onPlane, plane, {});
  const TriangulatedWall mesh = turningMesh();
  WallContacts contacts = contactsOf(onMesh, mesh);
  ASSERT_EQ(contacts.size(), 1u);
  for (int step = 0; step < 20; ++step) {
    for (Particles* particles : {&onPlane, &onMesh}) clearForces(*particles);
    findContacts(onPlane, plane, {});
    laws->wall(onPlane, plane, dt, Booking::on);
    laws->wall(onMesh, mesh, contacts, dt, Booking::on);
  }
  for (const Particles& particles : {onPlane, onMesh}) {
    EXPECT_GT(particles.f[0].z, 100.0);
    EXPECT_LE(norm(particles.torque[0]), 1e-11 * particles.f[0].z);
  }
}

TEST(WallLaws, SpringsTurnWithTheTurntable) {
  // Wall and particle turn about the normal as one: a stretch stays the same to both, so it turns with them.
  const auto laws = makeContactLaws(ContactLaw<LinearSpringDashpot, TangentialSpring>{{1e4}, {1e3, 10.0}});
  Particles particles;
  addParticle(particles, {0, 0, 0.95}, {0.1, 0, 0}, 1.0, Mass{1.0});
  switchOnRotation(particles);
  PrimitiveWall plane = makePlane({}, {0, 0, 1});
  findContacts(particles, plane, {});
  laws->wall(particles, plane, 1e-2, Booking::on);  // stretched by 1 mm along x
  particles.v[0] = {};
  const double speed = 2.0;
  plane.angularVelocity = particles.omega[0] = {0, 0, speed};
  const int steps = 1000;
  for (int step = 0; step < steps; ++step) {
    clearForces(particles);
    findContacts(particles, plane, {});
    laws->wall(particles, plane, 1e-3, Booking::on);
  }
  const double angle = speed * 1e-3 * steps;
  EXPECT_LE(norm(particles.f[0] - Vec3{-std::cos(angle), -std::sin(angle), 500.0}), 1e-5);
}

TEST(WallLaws, AFacetTurnsAsARigidBodyDoes) {
  Random random(3);
  const Vec3 a = random.vector(1.0), b = random.vector(1.0), c = random.vector(1.0);
  const FacetSpin spin(a, b, c);
  EXPECT_LE(norm(spin(rigid(a), rigid(b), rigid(c)) - about), 1e-12);
  const Vec3 couple = random.vector(2.0);
  const auto f = spin.forces(couple);
  EXPECT_LE(norm(f[0] + f[1] + f[2]), 1e-12);
  EXPECT_LE(norm(cross(a, f[0]) + cross(b, f[1]) + cross(c, f[2]) - couple), 1e-12);
  const Vec3 va = random.vector(1.0), vb = random.vector(1.0), vc = random.vector(1.0);
  EXPECT_NEAR(dot(f[0], va) + dot(f[1], vb) + dot(f[2], vc), dot(couple, spin(va, vb, vc)), 1e-12);
}

TEST(WallLaws, CouplesReactOnTheFacets) {
  const auto laws = makeContactLaws(rollingLaw);
  Particles particles = rider();
  particles.omega[0] += Vec3{3.0, -2.0, 5.0};
  TriangulatedWall mesh = turningMesh();
  WallContacts contacts = contactsOf(particles, mesh);
  ContactWork work;
  for (int step = 0; step < 5; ++step) {
    clearForces(particles);
    work = laws->wall(particles, mesh, contacts, dt, Booking::on);
  }
  EXPECT_GT(norm(contacts.couple[0]), 0.1);
  clearForces(mesh);
  addWallForces(contacts, mesh);
  const double moment = norm(particles.torque[0]);
  EXPECT_LE(norm(totalForce(mesh) + particles.f[0]), 1e-12 * norm(particles.f[0]));
  EXPECT_LE(norm(totalMoment(mesh) + particles.torque[0] + cross(particles.x[0], particles.f[0])), 1e-12 * moment);
  // So does the power: the vertices give what their spin and the couple say.
  const Vec3 point = contactPoint(contacts, mesh, 0);
  EXPECT_NEAR(forcePower(mesh), -dot(contacts.force[0], rigid(point)) - dot(contacts.couple[0], about), 1e-10 * moment);
}

/// Largest change of kinetic, gravitational and elastic energy on a drop into a valley and up again, over the height
/// fallen.
double valleyError(const std::shared_ptr<const ContactLaws>& laws, double degrees, const Vec3& offset) {
  const double radius = 0.1, bend = std::numbers::pi * (1.0 - degrees / 180.0), h = 2.0;
  const TriangulatedWall wall = fold(bend, h);
  const Vec3 up = normalized(Vec3{std::sin(bend), 0.0, 1.0 + std::cos(bend)});  // along the bisector
  Particles particles;
  addParticle(particles, radius * 1.02 / std::cos(0.5 * bend) * up + offset, {}, radius, Mass{1.0});
  WallCandidates candidates;
  findWallCandidates(particles, wall, 0.2, candidates);
  WallContacts contacts;
  const Vec3 g = -9.81 * up;
  const double step = 2e-6;
  double stored = 0.0, least = 0.0, most = 0.0, deepest = 0.0;
  const auto height = [&] { return -dot(g, particles.x[0]); };
  const double start = height();
  applyGravity(particles, g);
  for (int s = 0; s < 40000; ++s) {
    kick(particles, 0.5 * step);
    drift(particles, step);
    clearForces(particles);
    applyGravity(particles, g);
    findWallContacts(particles, wall, candidates, EdgeRule::projected, contacts);
    stored = laws->wall(particles, wall, contacts, step, Booking::on).storedEnergy();
    kick(particles, 0.5 * step);
    const double error = kineticEnergy(particles) + height() + stored - start;
    least = std::min(least, error);
    most = std::max(most, error);
    deepest = std::max(deepest, stored);
  }
  EXPECT_GT(deepest, 0.1 * 9.81 * 0.02 * radius);
  return (most - least) / deepest;
}

TEST(WallLaws, HertzKeepsItsEnergyInValleys) {
  const auto hertz = makeContactLaws(HertzLaw{{1e6}});
  for (const double degrees : {100.0, 110.0, 130.0, 150.0})
    EXPECT_LE(valleyError(hertz, degrees, {4e-4, 0.3, 0.0}), 1e-6) << degrees;
}

}  // namespace
}  // namespace dovetail::dem
