// Contact laws against closed forms, and the limit of the time step.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

/// One sphere against the wall z = 0, and the candidates that serve as long as it stays near the origin.
struct Bouncer {
  Particles particles;
  TriangulatedWall wall = squares(2, 2, 1.0);
  WallCandidates candidates;
  WallContacts contacts;

  Bouncer(const Vec3& x, const Vec3& v, double mass) {
    addParticle(particles, x, v, 0.1, Mass{mass});
    findWallCandidates(particles, wall, 0.4, candidates);
  }

  template <class Law>
  ContactWork forces(const Law& law, double dt, const Vec3& g = {}) {
    clearForces(particles);
    applyGravity(particles, g);
    findWallContacts(particles, wall, candidates, EdgeRule::projected, contacts);
    return sweepWall(law, particles, wall, contacts, dt);
  }

  template <class Law>
  ContactWork step(const Law& law, double dt, const Vec3& g = {}) {
    kick(particles, 0.5 * dt);
    drift(particles, dt);
    const ContactWork work = forces(law, dt, g);
    kick(particles, 0.5 * dt);
    return work;
  }
};

struct Rebound {
  double restitution, lost;  // lost: J booked to the dashpot
};

Rebound rebound(const LinearSpringDashpot& normal, int stepsPerContact) {
  const double mass = 0.7, speed = 0.3, dt = normal.contactTime(mass) / stepsPerContact;
  Bouncer b({1.0, 1.0, 0.1 + 0.37 * speed * dt}, {0, 0, -speed}, mass);
  const ElasticLaw law{normal};
  double lost = 0.0, power = 0.0;
  b.forces(law, dt);
  for (int i = 0; i < 6 * stepsPerContact; ++i) {
    const double now = b.step(law, dt).dissipatedPower;
    lost += 0.5 * dt * (power + now);
    power = now;
  }
  EXPECT_EQ(b.contacts.size(), 0u);
  return {b.particles.v[0].z / speed, lost};
}

TEST(Laws, TheReboundHasTheRestitutionAskedFor) {
  for (const bool tension : {false, true})
    for (const double e : {0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.0}) {
      const LinearSpringDashpot normal{1e4, e, tension};
      const Rebound coarse = rebound(normal, 100), fine = rebound(normal, 800);
      EXPECT_NEAR(coarse.restitution, e, 2e-4) << tension;
      EXPECT_NEAR(fine.restitution, e, 3e-6) << tension;
      const double impact = 0.5 * 0.7 * 0.09;
      EXPECT_NEAR(coarse.lost, impact * (1.0 - e * e), 1.5e-3 * impact) << tension;
      EXPECT_NEAR(fine.lost, impact * (1.0 - e * e), 2.5e-5 * impact) << tension;
    }
}

TEST(Laws, ANominalRestitutionIsExceededAsInClosedForm) {
  for (const double e : {0.1, 0.3, 0.5, 0.8, 0.95, 1.0}) {
    const double expected = restitutionWithoutTension(e);
    EXPECT_GE(expected, e);
    EXPECT_NEAR(rebound({1e4, e, false, false, true}, 800).restitution, expected, 3e-6);
  }
}

TEST(Laws, ClosedFormsOfContactTimeAndDamping) {
  const LinearSpringDashpot elastic{2e7};
  // Two equal spheres of 83.776 kg: t_c = π √(m/2k) = 4.5465 ms.
  EXPECT_NEAR(elastic.contactTime(0.5 * 83.7758), 4.5465e-3, 1e-7);
  EXPECT_EQ(elastic.damping(1.0), 0.0);
  const LinearSpringDashpot damped{3.0, 0.4, true};
  const double m = 0.7, t = damped.contactTime(m), lnE = std::log(0.4), pi = std::numbers::pi;
  EXPECT_NEAR(damped.stiffness, m * (pi * pi + lnE * lnE) / (t * t), 1e-14);
  EXPECT_NEAR(damped.damping(m), -2.0 * m * lnE / t, 1e-14);
}

TEST(Laws, BadParametersAreRefused) {
  EXPECT_THROW(validate(LinearSpringDashpot{0.0, 0.5}), InputError);
  EXPECT_THROW(validate(LinearSpringDashpot{NAN, 0.5}), InputError);
  EXPECT_THROW(validate(LinearSpringDashpot{1.0, 0.0}), InputError);
  EXPECT_THROW(validate(LinearSpringDashpot{1.0, 1.1}), InputError);
  EXPECT_THROW(validate(FrictionalLaw{{1.0}, {1.0, -0.1}}), InputError);
  EXPECT_NO_THROW(validate(FrictionalLaw{{1.0, 0.01}, {1.0, 0.0}}));
  Bouncer b({1, 1, 0.09}, {}, 1.0);
  EXPECT_THROW(b.forces(FrictionalLaw{{1.0}, {1.0, 0.1}}, 0.0), InputError);
}

TEST(Laws, AnAbsentPartTakesNoMemory) { EXPECT_EQ(sizeof(ElasticLaw), sizeof(LinearSpringDashpot)); }

/// Largest |z − z₀| over some steps of a sphere that is pressed onto the wall and sits in its spring throughout.
double swing(const LinearSpringDashpot& normal, double dt, int steps) {
  const double mass = 0.7, sag = 0.02, start = 1e-7;
  const Vec3 g{0, 0, -sag * normal.stiffness / mass};
  Bouncer b({1, 1, 0.1 - sag + start}, {}, mass);
  const ElasticLaw law{normal};
  b.forces(law, dt, g);
  double largest = 0.0;
  for (int i = 0; i < steps; ++i) {
    b.step(law, dt, g);
    largest = std::max(largest, std::abs(b.particles.x[0].z - 0.1 + sag) / start);
  }
  return largest;
}

TEST(Laws, VerletIsBoundedBelowItsLimitAndGrowsAbove) {
  const LinearSpringDashpot normal{1e4};
  const double omega = std::sqrt(1e4 / 0.7);
  EXPECT_LE(swing(normal, 1.99 / omega, 3000), 1.0 / std::sqrt(1.0 - 0.995 * 0.995));
  EXPECT_GE(swing(normal, 2.01 / omega, 40), 100.0);
}

TEST(Laws, TheCriticalStepIsBelowTheLimitAndAtItWithoutDashpot) {
  for (const double e : {1.0, 0.5, 0.1}) {
    const LinearSpringDashpot normal{1e4, e, true};
    const double mass = 0.7, dashpot = normal.damping(mass) / mass, omega = std::sqrt(normal.stiffness / mass);
    // Of a dashpot that knows what its spring does.
    const double exact = dashpot > 0.0 ? std::min(2.0 / omega, 1.0 / dashpot) : 2.0 / omega;
    EXPECT_LE(swing(normal, 0.99 * exact, 2000), 20.0) << e;
    EXPECT_GE(swing(normal, 1.01 * exact, 2000), 20.0) << e;
    Particles two;
    addParticle(two, {}, {}, 0.5, Mass{2.0 * mass});
    addParticle(two, {0.999, 0, 0}, {}, 0.5, Mass{2.0 * mass});
    PairList list;
    findPairs(two, list);
    const double limit = criticalStep(two, list, *makeContactLaws(ElasticLaw{normal})).dt;
    EXPECT_NEAR(limit, detail::verletLimit(normal.stiffness / mass, 2.0 * dashpot), 1e-12 * limit);
    EXPECT_LE(limit, exact * (1.0 + 1e-12));
    EXPECT_GE(limit, 0.6 * exact);
  }
}

TEST(Laws, SlidingFrictionObeysCoulombAndIsBooked) {
  const double mass = 0.7, dt = 1e-4, mu = 0.3;
  const Vec3 g{0, 0, -10.0};
  const FrictionalLaw law{{1e5}, {7e4, mu}};
  Bouncer b({0.9, 1.03, 0.1 - mass * 10.0 / 1e5}, {0.5, 0, 0}, mass);
  const double start = kineticEnergy(b.particles);
  b.forces(law, dt, g);
  double lost = 0.0, stored = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const ContactWork work = b.step(law, dt, g);
    lost += work.frictionPower * dt;
    stored = work.tangentialEnergy;
  }
  EXPECT_NEAR(b.particles.v[0].x, 0.5 - mu * 10.0 * 0.1, 1e-3);
  EXPECT_NEAR(start - kineticEnergy(b.particles), lost + stored, 1e-3 * start);
}

TEST(Laws, ASphereThrownOntoFrictionRollsAtFiveSevenths) {
  const double mass = 0.7, dt = 1e-4;
  const Vec3 g{0, 0, -10.0};
  const FrictionalLaw law{{1e5}, {7e4, 0.5}};
  Bouncer b({0.6, 1.03, 0.1 - mass * 10.0 / 1e5}, {0.35, 0, 0}, mass);
  switchOnRotation(b.particles);
  b.forces(law, dt, g);
  double mean = 0.0;
  for (int i = 0; i < 4000; ++i) {
    b.step(law, dt, g);
    if (i >= 3000) mean += b.particles.v[0].x / 1000.0;
  }
  EXPECT_NEAR(mean, 0.35 * 5.0 / 7.0, 1e-3 * 0.35);
}

}  // namespace
}  // namespace dovetail::dem
