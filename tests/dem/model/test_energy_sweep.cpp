// Any law, any angle, pair and wall: what comes out is what went in less what was booked.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/dem/laws/adhesion.hpp"
#include "dovetail/dem/laws/elastic_plastic.hpp"
#include "dovetail/dem/laws/rolling.hpp"
#include "impact_scenes.hpp"

namespace dovetail::dem {
namespace {

constexpr double radius = 0.01, density = 2500.0;

struct Outcome {
  double residual, left, gain, leastPower, out;  // relative to the energy at the start; W
};

template <class Law>
Outcome impactAt(const Law& law, bool wall, double degrees, double speed, double time, int steps) {
  const double angle = degrees * std::numbers::pi / 180.0;
  const Vec3 v{speed * std::sin(angle), 0.0, -speed * std::cos(angle)};
  const Vec3 line = normalized({0.3, -0.5, 0.8});
  Particles who = aboveWall(radius, density, v, {}, 1e-6);
  if (!wall) {
    // The same impact along another line, on a partner of other size at rest, both spinning.
    const Vec3 across = normalized(cross(line, {1, 0, 0}));
    who = headOn(radius, 1.3 * radius, density, line, speed * std::cos(angle) * line + speed * std::sin(angle) * across,
                 {}, 1e-6);
    who.omega[1] = (0.2 * speed / radius) * Vec3{1, -1, 1};
  }
  who.omega[0] = (0.3 * speed / radius) * Vec3{1, 2, -1};
  Impact impact(who, law, wall);
  const Vec3 linear = momentum(impact.particles), angular = angularMomentum(impact.particles);
  impact.run(time / steps, 2.5 * time);
  if (!wall) {
    EXPECT_LE(norm(momentum(impact.particles) - linear), 1e-13 * norm(linear));
    EXPECT_LE(norm(angularMomentum(impact.particles) - angular), 1e-12 * norm(linear) * radius);
  }
  const double end = kineticEnergy(impact.particles) + impact.stored;
  return {impact.worstResidual / impact.start, std::abs(end + impact.lost - impact.start) / impact.start,
          impact.worstGain / impact.start, impact.leastPower * time / impact.start, end / impact.start};
}

/// At any moment the ledger closes to 5e-5 of the energy at 500 steps per impact.
/// @param time duration of an impact at the given speed
template <class Law, class Time>
void sweep(const std::string& name, const Law& law, const Time& time) {
  constexpr double tolerance = 5e-5;
  validate(law);
  double worst = 0.0, worstFine = 0.0, left = 0.0, leftFine = 0.0;
  for (const bool wall : {false, true})
    for (const double degrees : {5.0, 20.0, 35.0, 50.0, 65.0, 80.0, 85.0})
      for (const double speed : {0.05, 0.5, 5.0}) {
        const double duration = time(speed * std::cos(degrees * std::numbers::pi / 180.0));
        const Outcome coarse = impactAt(law, wall, degrees, speed, duration, 500),
                      fine = impactAt(law, wall, degrees, speed, duration, 2000);
        const auto where = [&] {
          return name + (wall ? ", wall, " : ", pair, ") + std::to_string(degrees) + "°, " + std::to_string(speed) +
                 " m/s";
        };
        EXPECT_LE(fine.gain, 0.25 * tolerance) << where();
        EXPECT_GE(fine.leastPower, -1e-4) << where();
        EXPECT_LE(fine.out, 1.0 + 0.25 * tolerance) << where();
        worst = std::max(worst, coarse.residual);
        worstFine = std::max(worstFine, fine.residual);
        left = std::max(left, coarse.left);
        leftFine = std::max(leftFine, fine.left);
      }
  EXPECT_LE(worst, tolerance) << name;
  EXPECT_LE(left, tolerance) << name;
  EXPECT_LE(worstFine, 0.4 * worst) << name;  // a quarter of the step
}

const Material glass{5e9, 0.25, density};
constexpr double mass = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * density;

template <class Law>
auto hertzTime(const Law& law) {
  return [law](double speed) { return law.normal.contactTime(0.8 * mass, radius, speed); };
}
auto linearTime(double stiffness) {
  return [stiffness](double) { return std::numbers::pi * std::sqrt(0.8 * mass / stiffness); };
}

TEST(EnergySweep, HertzMindlin) {
  for (const double e : {1.0, 0.7})
    for (const double damping : {0.0, 1.0}) {
      const auto law = hertzMindlin(glass, glass, {e, 0.4, damping});
      sweep("Hertz-Mindlin " + std::to_string(e) + " " + std::to_string(damping), law, hertzTime(law));
    }
}

TEST(EnergySweep, LinearSprings) {
  for (const double e : {1.0, 0.7})
    for (const double damping : {0.0, 1.0}) {
      const FrictionalLaw law{{1e6, e, false}, {7e5, 0.4, damping}};
      sweep("linear " + std::to_string(e) + " " + std::to_string(damping), law, linearTime(1e6));
    }
}

TEST(EnergySweep, ElasticPlasticWithAndWithoutCohesion) {
  for (const double cohesion : {0.0, 2e5}) {
    const ContactLaw<ElasticPlastic, TangentialSpring> law{{4e5, 1e6, cohesion, 0.1}, {7e5, 0.4}};
    sweep("plastic " + std::to_string(cohesion), law, linearTime(4e5));
  }
}

TEST(EnergySweep, RollingAndTwisting) {
  ContactLaw<HertzDashpot, MindlinSpring, RollingAndTwisting> law;
  const auto base = hertzMindlin(glass, glass, {0.8, 0.4});
  law.normal = base.normal;
  law.tangential = base.tangential;
  law.rolling = {{0.1, 0.4, 0.5}, {0.1, 0.4, 0.5}};
  sweep("rolling", law, hertzTime(law));
}

TEST(EnergySweep, Adhesion) {
  ContactLaw<HertzDashpot, MindlinSpring, NoRolling, LinearCohesion> law;
  const auto base = hertzMindlin(glass, glass, {0.8, 0.4});
  law.normal = base.normal;
  law.tangential = base.tangential;
  law.adhesion = {1e4, 1e5};
  sweep("linear cohesion", law, hertzTime(law));
}

TEST(EnergySweep, DmtAdhesion) {
  ContactLaw<HertzDashpot, MindlinSpring, NoRolling, DmtAdhesion> law;
  const auto base = hertzMindlin(glass, glass, {0.8, 0.4});
  law.normal = base.normal;
  law.tangential = base.tangential;
  law.adhesion = {0.02};
  sweep("DMT", law, hertzTime(law));
}

TEST(EnergySweep, ASphereAThousandTimesLargerActsAsAWall) {
  ContactLaw<HertzDashpot, MindlinSpring, RollingAndTwisting> law;
  const auto base = hertzMindlin(glass, glass, {0.8, 0.4, 1.0});
  law.normal = base.normal;
  law.tangential = base.tangential;
  law.rolling = {{0.1, 0.4, 0.5}, {0.1, 0.4, 0.5}};
  const double time = law.normal.contactTime(mass, radius, 1.0);
  const auto meet = [&](bool wall, int steps) {
    const Vec3 v{0.8, 0.0, -1.0}, omega = (1.0 / radius) * Vec3{0.3, 0.6, -0.3};
    Particles who = aboveWall(radius, density, v, omega, 1e-6);
    if (!wall) {
      who = headOn(radius, 1000.0 * radius, density, {0, 0, -1}, v, {}, 1e-9);
      who.omega[0] = omega;
    }
    Impact impact(who, law, wall);
    impact.run(time / steps, 2.5 * time);
    EXPECT_LE(impact.worstResidual, 2e-4 * impact.start);
    return std::array<Vec3, 2>{impact.particles.v[0], radius * impact.particles.omega[0]};
  };
  const auto wall = meet(true, 2000), pair = meet(false, 2000);
  // The small sphere weighs 1e-9 of the large one and is a thousand times more curved; arms differ by half the overlap.
  EXPECT_LE(norm(wall[0] - pair[0]), 4e-3);
  EXPECT_LE(norm(wall[1] - pair[1]), 4e-3);
}

}  // namespace
}  // namespace dovetail::dem
