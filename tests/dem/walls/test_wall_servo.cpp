// Walls that keep a force: energy, balance, step; and where particles push on a wall.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/dem/walls/facet_tractions.hpp"
#include "dovetail/dem/walls/mesh_wall.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

/// One ball on the ground, and a lid over it that a servo presses down.
template <class Lid>
struct Press {
  Particles particles;
  PrimitiveWall ground = makePlane({}, {0, 0, 1});
  Lid lid;
  ElasticLaw law{{1e4, 1.0}};
  double time = 0.0;
  ContactWork work{};

  explicit Press(Lid plate, double ball = 0.5) : lid(std::move(plate)) {
    addParticle(particles, {0.5, 0.5, 0.1}, {}, 0.1, Mass{ball});
  }
  void step(double dt) {
    time += dt;
    kick(particles, 0.5 * dt);
    kickWall(lid, 0.5 * dt);
    drift(particles, dt);
    const Moves moves = movesOf(particles, dt);
    startForces(particles, {});
    findContacts(particles, ground, moves);
    work = sweepWall(law, particles, ground, dt);
    if constexpr (std::is_same_v<Lid, MeshWall>) {
      moveWall(lid, time, dt);
      findContacts(particles, lid, moves);
      work += sweepWall(law, particles, lid.wall, lid.contacts, dt);
      gatherForces(lid);
    } else {
      drift(lid, dt);
      findContacts(particles, lid, moves);
      work += sweepWall(law, particles, lid, dt);
    }
    kick(particles, 0.5 * dt);
    kickWall(lid, 0.5 * dt);
  }
  const WallServo& servo() const {
    if constexpr (std::is_same_v<Lid, MeshWall>)
      return std::get<WallServo>(lid.motion);
    else
      return *lid.servo;
  }
  double balance() const {
    return kineticEnergy(particles) + work.storedEnergy() + servo().kineticEnergy() + servo().lost - servo().work;
  }
};

PrimitiveWall plateLid(const WallServo& servo) {
  PrimitiveWall lid = makePlane({0, 0, 0.2}, {0, 0, -1});
  lid.servo = servo;
  return lid;
}

MeshWall meshLid(const WallServo& servo) {
  MeshWall lid;
  lid.wall = squares(4, 4, 0.25);
  for (Vec3& x : lid.wall.x) x.z = 0.2;
  prescribe(lid, servo);
  return lid;
}

TEST(WallServo, EnergyIsConservedToSecondOrderAndTheMeshDoesAsThePlane) {
  const auto worst = [](auto lid, double dt) {
    Press press(std::move(lid));
    press.step(1e-9);
    const double start = press.balance();
    double largest = 0.0;
    for (double t = 0.0; t < 0.4; t += dt) {
      press.step(dt);
      largest = std::max(largest, std::abs(press.balance() - start));
    }
    EXPECT_GT(press.servo().lost, 0.01);
    return largest;
  };
  const WallServo servo = makeServo({0, 0, -2}, 50.0, 2.0, 4.0);
  const double coarse = worst(plateLid(servo), 4e-4), fine = worst(plateLid(servo), 2e-4);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(fine, coarse / 3.0);
  EXPECT_NEAR(worst(meshLid(servo), 4e-4), coarse, 1e-9);
}

TEST(WallServo, TheLoadIsCarriedInTheEnd) {
  Press press(plateLid(makeServo({0, 0, -1}, 50.0, 0.5, 60.0)));
  press.law.normal.restitution = 0.3;
  for (int i = 0; i < 20000; ++i) press.step(2e-4);
  EXPECT_NEAR(press.servo().unbalanced(), 0.0, 1e-8);
  EXPECT_NEAR(press.ground.force.z, -50.0, 1e-8);
  // Two springs of 1e4 N/m in a row.
  EXPECT_NEAR(press.servo().travel, 2.0 * 50.0 / 1e4, 1e-10);
}

TEST(WallServo, ItsMassEntersTheStep) {
  // Ball of 0.5 kg between the ground and a lid of 0.02 kg: the lid sets the pace.
  const double k = 1e4, ball = 0.5, plate = 0.02;
  Press press(plateLid(makeServo({0, 0, -1}, 1.0, plate)), ball);
  for (int i = 0; i < 40; ++i) press.step(1e-5);
  ContactDemand demand;
  const auto laws = makeContactLaws(press.law);
  laws->addDemand(demand, press.particles, press.ground);
  const std::size_t first = demand.links.size();
  laws->addDemand(demand, press.particles, press.lid);
  const double fixed = criticalStep(demand, press.particles).dt;
  demand.standOn(first, &*press.lid.servo, 1.0 / plate);
  const double safe = criticalStep(demand, press.particles).dt;
  EXPECT_NEAR(fixed, 2.0 / std::sqrt(2.0 * k / ball), 1e-12);
  EXPECT_NEAR(safe, 2.0 / std::sqrt(2.0 * k / ball + k / plate), 1e-12);
  // The exact frequency of lid and ball.
  const double a = 2.0 * k / ball + k / plate, b = 4.0 * (2.0 * k * k - k * k) / (ball * plate);
  const double exact = 2.0 / std::sqrt(0.5 * (a + std::sqrt(a * a - b)));
  EXPECT_LE(safe, exact);
  EXPECT_GT(safe, 0.9 * exact);
}

TEST(WallServo, BadOnesAreRefused) {
  EXPECT_THROW(makeServo({}, 1.0, 1.0), InputError);
  EXPECT_THROW(makeServo({0, 0, 1}, NAN, 1.0), InputError);
  EXPECT_THROW(makeServo({0, 0, 1}, 1.0, 0.0), InputError);
  EXPECT_THROW(makeServo({0, 0, 1}, 1.0, 1.0, -1.0), InputError);
}

TEST(FacetTractions, TheirSumIsTheForceAndTheMeanThatOverTime) {
  Random random(2);
  MeshWall mesh;
  mesh.wall = squares(3, 3, 0.3);
  FacetTractions tractions;
  Vec3 impulse;
  double time = 0.0;
  for (int step = 0; step < 10; ++step) {
    Particles particles;
    for (int i = 0; i < 30; ++i)
      addParticle(particles, {random(0, 0.9), random(0, 0.9), random(0.02, 0.06)}, random.vector(1.0), 0.05, Mass{1.0});
    findContacts(particles, mesh, {});
    sweepWall(FrictionalLaw{{1e4, 0.5}, {3e3, 0.4}}, particles, mesh.wall, mesh.contacts, 1e-4);
    gatherForces(mesh);
    const double dt = random(0.1, 0.3);
    gatherTractions(tractions, mesh.wall, mesh.contacts, dt);
    impulse += dt * totalForce(mesh.wall);
    time += dt;
  }
  const std::vector<Vec3> mean = meanTractions(tractions, mesh.wall);
  Vec3 sum;
  for (const Vec3& t : mean) sum += 0.0225 * t;  // area of each facet
  EXPECT_LT(norm(sum - impulse / time), 1e-10 * norm(sum));
  EXPECT_LT(sum.z, 0.0);
  EXPECT_EQ(norm(meanTractions({}, mesh.wall)[0]), 0.0);
}

}  // namespace
}  // namespace dovetail::dem
