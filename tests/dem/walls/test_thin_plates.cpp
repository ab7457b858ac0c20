// Closed plates thinner than the overlap: away from their rims they act as thick ones.
#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "dovetail/core/quaternion.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "plate_wall.hpp"

namespace dovetail::dem {
namespace {

constexpr double radius = 0.1, mass = 0.5, stiffness = 1e5, edge = radius,  // rims are 2 R and more away
    phase = 2.0 * std::numbers::pi / 400.0;                                 // of a contact's oscillation in a step

using Laws = std::shared_ptr<const ContactLaws>;

struct Rebound {
  Vec3 x, v, omega;
  double fastest = 0.0;   // of the impact's speed
  double residual = 0.0;  // of the impact's energy
};

/// A ball hits the middle of a plate, aslant, as fast as an overlap asks for.
Rebound hit(double thickness, double overlap, double slant, const Laws& laws, unsigned seed) {
  Random random(seed);
  const Quaternion turn = fromRotationVector(random.vector(2.0));
  Model m;
  m.laws = laws;
  TriangulatedWall wall = plate(random, edge, 0.0, thickness);
  for (Vec3& x : wall.x) x = rotate(turn, x);
  addWall(m, MeshWall{}).wall = std::move(wall);
  const double omega = std::sqrt(stiffness / mass), speed = overlap * omega, dt = phase / omega;
  const Vec3 start{random(2.2, 2.8) * edge, random(2.2, 2.8) * edge, radius + 5.5 * speed * dt};
  addParticle(m.particles, rotate(turn, start), rotate(turn, speed * Vec3{slant, -0.5 * slant, -1.0}), radius,
              Mass{mass});
  switchOnRotation(m.particles);
  findForces(m);
  const double before = energies(m).balance(), energy = energies(m).kinetic, fast = norm(m.particles.v[0]);
  Rebound rebound;
  for (int step = 0; step < 220; ++step) {
    run(m, dt, 1);
    rebound.fastest = std::max(rebound.fastest, norm(m.particles.v[0]) / fast);
  }
  rebound.x = rotateBack(turn, m.particles.x[0]);
  rebound.v = rotateBack(turn, m.particles.v[0]) / speed;
  rebound.omega = rotateBack(turn, m.particles.omega[0]) * radius / speed;
  rebound.residual = (energies(m).balance() - before) / energy;
  return rebound;
}

void expectAsOnThickPlates(const Laws& laws, double slant) {
  unsigned seed = 1;
  for (const double thickness : {1e-4, 1e-3, 1e-2, 0.1, 0.3, 1.0})
    for (const double overlap : {0.01, 0.05, 0.1, 0.2, 0.35, 0.5}) {
      const Rebound thin = hit(thickness * radius, overlap * radius, slant, laws, ++seed),
                    thick = hit(20.0 * radius, overlap * radius, slant, laws, seed);
      EXPECT_LE(norm(thin.x - thick.x), 1e-10 * radius) << thickness << " R thick, overlap " << overlap << " R";
      EXPECT_LE(norm(thin.v - thick.v), 1e-10);
      EXPECT_LE(norm(thin.omega - thick.omega), 1e-10);
      EXPECT_GT(thin.v.z, 0.5);
      EXPECT_LE(thin.fastest, 1.0 + 1e-9);
      EXPECT_LE(std::abs(thin.residual - thick.residual), 1e-10);
      EXPECT_LE(std::abs(thin.residual), phase * phase);
    }
}

TEST(ThinPlates, ElasticBallsReboundAsFromThickOnes) {
  expectAsOnThickPlates(makeContactLaws(ElasticLaw{{stiffness}}), 0.0);
  expectAsOnThickPlates(makeContactLaws(ElasticLaw{{stiffness}}), 0.3);
}

TEST(ThinPlates, RoughDampedBallsReboundAsFromThickOnes) {
  ContactLaw<LinearSpringDashpot, TangentialSpring> law;
  law.normal = {.stiffness = stiffness, .restitution = 0.7};
  law.tangential = {.stiffness = 0.3 * stiffness, .friction = 0.4};
  expectAsOnThickPlates(makeContactLaws(law), 0.3);
}

}  // namespace
}  // namespace dovetail::dem
