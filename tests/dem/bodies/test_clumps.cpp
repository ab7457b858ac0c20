// Clumps: placed right, forces gathered adjointly, energy counted once.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bodies/clumps.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/dem/setup/insertion.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

const std::vector<Vec3> rod{{0, 0, 0}, {0.06, 0, 0}, {0.12, 0.02, 0}};
const std::vector<double> rodRadius{0.05, 0.04, 0.05};

struct Scene {
  Particles particles;
  Bodies bodies;
  Clumps clumps;
  PairList list;
};

/// Rods and single spheres that fly about.
Scene gas(bool spinning) {
  Scene scene;
  Random random(8);
  const ClumpShape shape = makeClumpShape(rod, rodRadius, Density{1000.0});
  for (int i = 0; i < 60; ++i) {
    const Vec3 x{0.25 * (i % 4), 0.25 * (i / 4 % 4), 0.25 * (i / 16)};
    if (i % 3 == 0) {
      addParticle(scene.particles, x, random.vector(1.0), 0.05, Density{1000.0});
    } else {
      addClump(scene.particles, scene.bodies, scene.clumps, shape, x, fromRotationVector(random.vector(3.0)),
               random.vector(1.0), random.vector(5.0));
    }
  }
  if (spinning) switchOnRotation(scene.particles);
  placeMembers(scene.bodies, scene.clumps, {}, scene.particles);
  scene.list.setSkin(0.02);
  findPairs(scene.particles, scene.list);
  muteMemberPairs(scene.clumps, scene.list);
  return scene;
}

ContactWork step(Scene& s, const std::shared_ptr<const ContactLaws>& law, double dt) {
  kick(s.particles, 0.5 * dt);
  kickBodies(s.bodies, 0.5 * dt);
  drift(s.particles, dt);
  driftBodies(s.bodies, dt);
  placeMembers(s.bodies, s.clumps, {}, s.particles);
  if (updatePairs(s.particles, s.list)) muteMemberPairs(s.clumps, s.list);
  clearForces(s.particles);
  clearForces(s.bodies);
  const ContactWork work = law->pairs(s.particles, s.list, dt, Booking::on);
  gatherForces(s.particles, s.clumps, s.bodies);
  kick(s.particles, 0.5 * dt);
  kickBodies(s.bodies, 0.5 * dt);
  placeMembers(s.bodies, s.clumps, {}, s.particles);
  return work;
}

Vec3 totalMomentum(const Scene& s, Vec3* angular) {
  Vec3 linear = momentum(s.bodies);
  *angular = angularMomentum(s.bodies);
  std::vector<char> member(s.particles.size(), 0);
  for (const int i : s.clumps.particle) member[i] = 1;
  for (std::size_t i = 0; i < s.particles.size(); ++i) {
    if (member[i]) continue;
    linear += s.particles.mass[i] * s.particles.v[i];
    *angular += s.particles.mass[i] * cross(s.particles.x[i], s.particles.v[i]);
    if (s.particles.rotates()) *angular += momentOfInertia(s.particles, int(i)) * s.particles.omega[i];
  }
  return linear;
}

TEST(Clumps, MembersLieAndMoveWithTheirBody) {
  Particles particles;
  Bodies bodies;
  Clumps clumps;
  const ClumpShape shape = makeClumpShape(rod, rodRadius, Density{1000.0});
  const Quaternion turn = normalized(Quaternion{0.2, 1.0, -0.3, 0.5});
  const Vec3 x{1, 2, 3}, v{0.1, 0.2, 0.3}, omega{3, -2, 1};
  EXPECT_EQ(addClump(particles, bodies, clumps, shape, x, turn, v, omega), 0);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 arm = rotate(turn, rod[k] - shape.properties.centre);
    EXPECT_LE(norm(particles.x[k] - x - arm), 1e-15);
    EXPECT_LE(norm(particles.v[k] - v - cross(omega, arm)), 1e-15);
    EXPECT_EQ(particles.radius[k], rodRadius[k]);
    EXPECT_EQ(particles.mass[k], shape.properties.mass);
  }
  const std::vector<Vec3> before = particles.x;
  particles.x[1] += Vec3{0.3, 0, 0.4};
  EXPECT_NEAR(placeMembers(bodies, clumps, {}, particles), 0.5, 1e-12);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(norm(particles.x[k] - before[k]), 1e-15);
  EXPECT_GT(makeClumpShape(rod, rodRadius, Density{1000.0}, Overlap::everySphere).properties.mass,
            1.05 * shape.properties.mass);
}

TEST(Clumps, PlacingAndGatheringAreAdjoint) {
  Scene scene = gas(true);
  Random random(4);
  double power = 0.0;
  for (std::size_t m = 0; m < scene.clumps.size(); ++m) {
    const auto i = static_cast<std::size_t>(scene.clumps.particle[m]);
    scene.particles.f[i] = random.vector(1.0);
    scene.particles.torque[i] = random.vector(0.1);
    power += dot(scene.particles.f[i], scene.particles.v[i]) + dot(scene.particles.torque[i], scene.particles.omega[i]);
  }
  clearForces(scene.bodies);
  gatherForces(scene.particles, scene.clumps, scene.bodies);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    power -= dot(scene.bodies.f[b], scene.bodies.v[b]) +
             dot(scene.bodies.torque[b], angularVelocity(scene.bodies, static_cast<int>(b)));
  EXPECT_NEAR(power, 0.0, 1e-12);
  applyGravity(scene.particles, {0, 0, -9.81});
  clearForces(scene.bodies);
  gatherForces(scene.particles, scene.clumps, scene.bodies, {0, 0, -9.81});
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    EXPECT_NEAR(scene.bodies.f[b].z, -9.81 * scene.bodies.mass[b], 1e-12);
    EXPECT_LE(norm(scene.bodies.torque[b]), 1e-14);
  }
}

TEST(Clumps, AGasOfRodsAndSpheresKeepsMomentumAndEnergy) {
  Scene scene = gas(false);
  const auto law = makeContactLaws(ElasticLaw{{.stiffness = 2e4}});
  Vec3 spin, spinNow;
  const Vec3 linear = totalMomentum(scene, &spin);
  clearForces(scene.particles);
  const double energy = kineticEnergy(scene.particles, scene.bodies) +
                        law->pairs(scene.particles, scene.list, 0.0, Booking::on).storedEnergy();
  gatherForces(scene.particles, scene.clumps, scene.bodies);
  double worst = 0.0, mostStored = 0.0;
  for (int k = 0; k < 6000; ++k) {
    const double stored = step(scene, law, 2e-5).storedEnergy();
    mostStored = std::max(mostStored, stored);
    worst = std::max(worst, std::abs(kineticEnergy(scene.particles, scene.bodies) + stored - energy));
  }
  EXPECT_GT(mostStored, 0.01 * energy);
  EXPECT_LE(worst, 2e-4 * energy);
  EXPECT_LE(norm(totalMomentum(scene, &spinNow) - linear), 1e-12 * 60);
  EXPECT_LE(norm(spinNow - spin), 1e-12 * 60);
  EXPECT_GT(scene.list.builds(), 3);
}

TEST(Clumps, WithFrictionAndDampingMomentumStaysAndTheThreadsDoNotMatter) {
  const auto law =
      makeContactLaws(FrictionalLaw{{.stiffness = 2e4, .restitution = 0.7}, {.stiffness = 6e3, .friction = 0.4}});
  std::vector<Vec3> first;
  for (const int count : {1, 2}) {
    setThreads(count);
    Scene scene = gas(true);
    Vec3 spin, spinNow;
    const Vec3 linear = totalMomentum(scene, &spin);
    for (int k = 0; k < 2500; ++k) step(scene, law, 4e-5);
    EXPECT_LE(norm(totalMomentum(scene, &spinNow) - linear), 1e-12 * 60);
    EXPECT_LE(norm(spinNow - spin), 1e-12 * 60);
    if (count == 1) first = scene.particles.x;
    EXPECT_EQ(scene.particles.x, first);
  }
  setThreads(1);
}

TEST(Clumps, AreStableUpToTheirCriticalStepAndNotBeyond) {
  Particles particles;
  Bodies bodies;
  Clumps clumps;
  const std::vector<Vec3> centre{{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}};
  const ClumpShape shape = makeClumpShape(centre, std::vector<double>{0.05, 0.05, 0.05}, Density{1000.0});
  addClump(particles, bodies, clumps, shape, {});
  const double k = 1e4;
  ContactDemand demand;
  ContactSlopes slopes;
  slopes.normal.stiffness = k;
  detail::addContact(demand, particles, 0, -1, slopes, 1.0, bodies.mass[0]);
  addDemand(demand, particles, bodies, clumps);
  const ContactStep limit = criticalStep(demand, particles);
  // A spring of stiffness k across the rod at its first member, small motion.
  const auto largest = [&](double dt) {
    Bodies b = bodies;
    Particles p = particles;
    b.v[0] = {0, 1e-6, 0};
    double far = 0.0;
    for (int step = 0; step < 400; ++step) {
      driftBodies(b, dt);
      placeMembers(b, clumps, {}, p);
      clearForces(b);
      clearForces(p);
      p.f[0].y = -k * p.x[0].y;
      gatherForces(p, clumps, b);
      kickBodies(b, dt);
      far = std::max(far, std::abs(p.x[0].y));
    }
    return far;
  };
  EXPECT_LT(largest(0.99 * limit.dt), 1e-7);
  EXPECT_GT(largest(1.01 * limit.dt), 1e-4);
}

/// A rod that lies against fixed springs: stiffness along and across the contact at each given member and direction.
struct Spring {
  std::size_t member;
  Vec3 normal;
};

/// Largest angular frequency of small motions of a body on springs that act where its members touch, 1/s.
double fastest(const Bodies& bodies, const Clumps& clumps, const Particles& particles,
               const std::vector<Spring>& springs, double normal, double tangential) {
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero(), rootMass = stiffness;
  for (const Spring& spring : springs) {
    const Vec3 arm = clumps.offset[spring.member] - particles.radius[spring.member] * spring.normal;
    Eigen::Matrix<double, 3, 6> motion = Eigen::Matrix<double, 3, 6>::Zero();  // of the point, from v and ω
    motion.leftCols<3>().setIdentity();
    motion.rightCols<3>() << 0, arm.z, -arm.y, -arm.z, 0, arm.x, arm.y, -arm.x, 0;
    const Eigen::Vector3d n(spring.normal.x, spring.normal.y, spring.normal.z);
    const Eigen::Matrix3d local = tangential * Eigen::Matrix3d::Identity() + (normal - tangential) * n * n.transpose();
    stiffness += motion.transpose() * local * motion;
  }
  for (int k = 0; k < 3; ++k) {
    rootMass(k, k) = 1.0 / std::sqrt(bodies.mass[0]);
    rootMass(3 + k, 3 + k) = 1.0 / std::sqrt(bodies.inertia[0][k]);
  }
  const Eigen::Matrix<double, 6, 6> form = rootMass * stiffness * rootMass;
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(form).eigenvalues()[5]);
}

TEST(Clumps, TheirDemandIsSafeForContactsAnywhereAndNotFarFromTheLimit) {
  Random random(17);
  double closest = 10.0;
  for (int trial = 0; trial < 300; ++trial) {
    Particles particles;
    Bodies bodies;
    Clumps clumps;
    std::vector<Vec3> centre{{0, 0, 0}, {0.05 + 0.03 * random(0.0, 1.0), 0, 0}, {0.1, random(0.0, 0.06), 0.0}};
    const ClumpShape shape = makeClumpShape(centre, std::vector<double>{0.05, 0.04, 0.05}, Density{1000.0});
    addClump(particles, bodies, clumps, shape, {});
    switchOnRotation(particles);
    const double normal = 1e5, tangential = 1e5 * random(0.0, 0.8);
    std::vector<Spring> springs;
    ContactDemand demand;
    for (int c = 0; c < 1 + trial % 4; ++c) {
      springs.push_back({static_cast<std::size_t>(random(0.0, 2.999)), normalized(random.vector(1.0))});
      ContactSlopes slopes;
      slopes.normal.stiffness = normal;
      slopes.tangential.stiffness = tangential;
      detail::addContact(demand, particles, static_cast<int>(springs.back().member), -1, slopes, 1.0, bodies.mass[0]);
    }
    addDemand(demand, particles, bodies, clumps);
    const double exact = 2.0 / fastest(bodies, clumps, particles, springs, normal, tangential);
    const double safe = criticalStep(demand, particles).dt;
    EXPECT_LE(safe, exact * (1.0 + 1e-12));
    closest = std::min(closest, exact / safe);
  }
  EXPECT_LT(closest, 1.5);
}

TEST(Clumps, MassesOfMembersAreNotScaled) {
  Scene scene = gas(true);
  ContactDemand demand;
  ContactSlopes slopes;
  slopes.normal.stiffness = 1e9;
  detail::addContact(demand, scene.particles, scene.clumps.particle[0], -1, slopes, 1.0, 1.0);
  addDemand(demand, scene.particles, scene.bodies, scene.clumps);
  EXPECT_THROW(scaleMasses(scene.particles, demand, 1.0), InputError);
}

TEST(Clumps, GoThroughPeriodsWithoutAJumpOfTheirMembers) {
  const geometry::Periodicity space{{{0, 0, 0}, {1, 1, 1}}, {true, false, true}};
  Scene scene;
  const ClumpShape shape = makeClumpShape(rod, rodRadius, Density{1000.0});
  addClump(scene.particles, scene.bodies, scene.clumps, shape, {0.95, 0.5, 0.02}, {0.9, 0.3, 0.1, -0.2}, {3.0, 0, -2.0},
           {1, 2, 3});
  wrapPositions(scene.particles, space);
  Scene open = scene;
  for (int s = 0; s < 500; ++s) {
    driftBodies(scene.bodies, 1e-3);
    driftBodies(open.bodies, 1e-3);
    EXPECT_LE(placeMembers(scene.bodies, scene.clumps, space, scene.particles), 0.006);
    placeMembers(open.bodies, open.clumps, {}, open.particles);
    if (s % 7 == 0) wrapPositions(scene.particles, space);
    if (s % 11 == 0) wrapPositions(scene.bodies, space);
  }
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LE(norm(space.minimumImage(scene.particles.x[i] - open.particles.x[i])), 1e-13);
  scene.particles.f = open.particles.f = {{1, 2, 3}, {-2, 1, 1}, {0, 0, 5}};
  gatherForces(scene.particles, scene.clumps, scene.bodies);
  gatherForces(open.particles, open.clumps, open.bodies);
  EXPECT_LE(norm(scene.bodies.torque[0] - open.bodies.torque[0]), 1e-15);
}

TEST(Clumps, ThatDoNotFitAreRefusedByBody) {
  const auto refused = [](auto&& change) {
    Scene scene = gas(true);
    EXPECT_NO_THROW(check(scene.particles, scene.bodies, scene.clumps));
    change(scene);
    EXPECT_THROW(check(scene.particles, scene.bodies, scene.clumps), InputError);
  };
  refused([](Scene& s) { s.clumps.particle[4] = 10000; });
  refused([](Scene& s) { s.clumps.particle[4] = s.clumps.particle[0]; });
  refused([](Scene& s) { std::swap(s.clumps.body[0], s.clumps.body[5]); });
  refused([](Scene& s) { s.clumps.body.back() = 1000; });
  refused([](Scene& s) { s.particles.mass[static_cast<std::size_t>(s.clumps.particle[2])] *= 2.0; });
  refused([](Scene& s) { s.clumps.offset.pop_back(); });
}

TEST(Clumps, StayTogetherWhenParticlesAreSorted) {
  Scene scene = gas(true);
  const std::vector<Vec3> before = scene.particles.x;
  const std::vector<int> number = sortParticles(scene.particles, scene.list);
  renumber(scene.bodies, scene.clumps, number);
  const std::vector<Vec3> sorted = scene.particles.x;
  placeMembers(scene.bodies, scene.clumps, {}, scene.particles);
  EXPECT_NE(sorted, before);
  for (std::size_t i = 0; i < sorted.size(); ++i) EXPECT_LE(norm(scene.particles.x[i] - sorted[i]), 1e-15);
}

TEST(Clumps, OneSphereAloneIsASpinningParticle) {
  const auto law =
      makeContactLaws(FrictionalLaw{{.stiffness = 2e4, .restitution = 0.8}, {.stiffness = 6e3, .friction = 0.3}});
  const ClumpShape ball = makeClumpShape(std::vector<Vec3>{{0, 0, 0}}, std::vector<double>{0.05}, Density{1000.0});
  Scene alone, clumped;
  Random random(11);
  for (int i = 0; i < 27; ++i) {
    const Vec3 x{0.11 * (i % 3), 0.11 * (i / 3 % 3), 0.11 * (i / 9)}, v = random.vector(1.0),
                                                                      omega = random.vector(20.0);
    addParticle(alone.particles, x, v, 0.05, Density{1000.0});
    switchOnRotation(alone.particles);
    alone.particles.omega.back() = omega;
    addClump(clumped.particles, clumped.bodies, clumped.clumps, ball, x, fromRotationVector(random.vector(3.0)), v,
             omega);
  }
  switchOnRotation(clumped.particles);
  placeMembers(clumped.bodies, clumped.clumps, {}, clumped.particles);
  for (Scene* scene : {&alone, &clumped}) {
    scene->list.setSkin(0.02);
    findPairs(scene->particles, scene->list);
  }
  double hit = 0.0;
  for (int k = 0; k < 1500; ++k) {
    hit = std::max(hit, step(alone, law, 4e-5).storedEnergy());
    step(clumped, law, 4e-5);
  }
  EXPECT_GT(hit, 0.01);
  for (std::size_t i = 0; i < 27; ++i) {
    EXPECT_LE(norm(alone.particles.x[i] - clumped.particles.x[i]), 1e-10);
    EXPECT_LE(norm(alone.particles.v[i] - clumped.particles.v[i]), 1e-8);
    EXPECT_LE(norm(alone.particles.omega[i] - clumped.particles.omega[i]), 1e-6);
  }
}

}  // namespace
}  // namespace dovetail::dem
