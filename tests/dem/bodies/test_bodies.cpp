// Rigid bodies: the free top, order, reversal, and energy under torques.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/bodies/bodies.hpp"

namespace dovetail::dem {
namespace {

const MassProperties asymmetric{2.0, {}, {1.0, 2.0, 2.7}, {}};

double distance(const Quaternion& a, const Quaternion& b) {
  const Quaternion d = conjugate(a) * b;  // of the rotations: q and −q are the same
  return 2.0 * norm(Vec3{d.x, d.y, d.z});
}

TEST(Bodies, TheFreeAsymmetricTopKeepsItsMomentumEnergyAndLength) {
  Bodies bodies;
  addBody(bodies, asymmetric, {}, {0.3, -0.4, 0.5, 0.7}, {1, 2, 3}, {0.1, 1.0, -0.05});  // near the unstable axis
  const Vec3 l = bodies.angularMomentum[0];
  const double energy = kineticEnergy(bodies);
  double lowest = energy, highest = energy, lastTenth = 0.0, firstTenth = 0.0;
  const int steps = 100000;
  double longest = 0.0;
  for (int step = 0; step < steps; ++step) {
    kickBodies(bodies, 0.005);
    driftBodies(bodies, 0.01);
    kickBodies(bodies, 0.005);
    const double now = kineticEnergy(bodies);
    lowest = std::min(lowest, now);
    highest = std::max(highest, now);
    if (step < steps / 10) firstTenth += now / (steps / 10);
    if (step >= steps - steps / 10) lastTenth += now / (steps / 10);
    longest = std::max(longest, std::abs(norm(bodies.orientation[0]) - 1.0));
  }
  EXPECT_EQ(bodies.angularMomentum[0], l);  // to the last bit
  EXPECT_LE(longest, 4e-16);
  EXPECT_LE(highest - lowest, 2e-5 * energy);                  // oscillates with dt²
  EXPECT_LE(std::abs(lastTenth - firstTenth), 2e-7 * energy);  // and does not drift
  EXPECT_LE(norm(bodies.x[0] - 1000.0 * Vec3{1, 2, 3}), 1e-8);
}

TEST(Bodies, TheSymmetricTopPrecessesAsInTheBooksToSecondOrder) {
  const MassProperties symmetric{1.0, {}, {1.0, 1.0, 1.8}, {}};
  const Vec3 omega{0.7, -0.2, 1.1};
  Bodies start;
  addBody(start, symmetric, {}, {}, {}, omega);
  const Vec3 l = start.angularMomentum[0];
  const double time = 5.0;
  const Quaternion exact =
      fromRotationVector((time / 1.0) * l) * fromRotationVector({0.0, 0.0, time * l.z * (1.0 / 1.8 - 1.0)});
  double last = 0.0;
  for (const int steps : {100, 200, 400, 800}) {
    Bodies bodies = start;
    for (int step = 0; step < steps; ++step) driftBodies(bodies, time / steps);
    const double error = distance(bodies.orientation[0], exact);
    if (last > 0.0) {
      EXPECT_NEAR(last / error, 4.0, 0.1);
    }
    last = error;
  }
  EXPECT_LE(last, 1e-4);
}

/// Torque of a spring on the end of a lever, and its energy.
double pull(Bodies& bodies) {
  const Vec3 arm = rotate(bodies.orientation[0], {0.5, 0.2, -0.3}), anchor{0.3, 0.6, 1.0};
  const Vec3 stretch = anchor - (bodies.x[0] + arm);
  clearForces(bodies);
  bodies.f[0] = 3.0 * stretch;
  bodies.torque[0] = cross(arm, 3.0 * stretch);
  return 1.5 * squaredNorm(stretch);
}

void step(Bodies& bodies, double dt) {
  kickBodies(bodies, 0.5 * dt);
  driftBodies(bodies, dt);
  pull(bodies);
  kickBodies(bodies, 0.5 * dt);
}

TEST(Bodies, UnderTorquesTheSchemeIsOfSecondOrderReversibleAndKeepsEnergy) {
  Bodies start;
  addBody(start, asymmetric, {0.1, 0, 0}, {}, {0.2, 0, -0.1}, {0.5, -1.2, 0.9});
  pull(start);
  const auto after = [&](int steps) {
    Bodies bodies = start;
    for (int k = 0; k < steps; ++k) step(bodies, 2.0 / steps);
    return bodies;
  };
  const Bodies a = after(100), b = after(200), c = after(400);
  EXPECT_NEAR(distance(a.orientation[0], b.orientation[0]) / distance(b.orientation[0], c.orientation[0]), 4.0, 0.1);
  EXPECT_NEAR(norm(a.x[0] - b.x[0]) / norm(b.x[0] - c.x[0]), 4.0, 0.1);

  Bodies back = c;
  back.v[0] = -back.v[0];
  back.angularMomentum[0] = -back.angularMomentum[0];
  for (int k = 0; k < 400; ++k) step(back, 2.0 / 400);
  EXPECT_LE(distance(back.orientation[0], start.orientation[0]), 1e-12);
  EXPECT_LE(norm(back.x[0] - start.x[0]), 1e-12);

  Bodies longRun = start;
  const double energy = kineticEnergy(longRun) + pull(longRun);
  double worst = 0.0;
  for (int k = 0; k < 20000; ++k) {
    step(longRun, 0.01);
    worst = std::max(worst, std::abs(kineticEnergy(longRun) + pull(longRun) - energy));
  }
  EXPECT_LE(worst, 5e-4 * energy);
}

TEST(Bodies, AngularVelocityAndMomentumFitTogether) {
  Bodies bodies;
  const Vec3 omega{0.3, 0.1, -0.8};
  addBody(bodies, {2.0, {}, {1.0, 2.0, 2.5}, normalized(Quaternion{1, 2, -1, 0.5})}, {1, 1, 0}, {0.2, 0.1, 0, 1},
          {0, 3, 0}, omega);
  EXPECT_LE(norm(angularVelocity(bodies, 0) - omega), 4e-15);
  EXPECT_NEAR(kineticEnergy(bodies), 9.0 + 0.5 * dot(omega, bodies.angularMomentum[0]), 1e-14);
  EXPECT_LE(norm(angularMomentum(bodies) - bodies.angularMomentum[0] - Vec3{0, 0, 6}), 1e-14);
  EXPECT_EQ(momentum(bodies), (Vec3{0, 6, 0}));
  applyGravity(bodies, {0, 0, -10});
  EXPECT_EQ(bodies.f[0], (Vec3{0, 0, -20}));
  const Quaternion q = fromRotationVector({0, 0, 0.5 * 3.14159265358979});
  EXPECT_LE(norm(rotate(q, {1, 0, 0}) - Vec3{0, 1, 0}), 1e-14);
}

TEST(Bodies, BadBodiesAreRefusedAndNothingIsAdded) {
  Bodies bodies;
  EXPECT_THROW(addBody(bodies, {0.0, {}, {1, 1, 1}, {}}, {}), InputError);
  EXPECT_THROW(addBody(bodies, {1.0, {}, {1, 1, 2.1}, {}}, {}), InputError);
  EXPECT_THROW(addBody(bodies, {1.0, {}, {1, 1, 1}, {}}, {0, std::nan(""), 0}), InputError);
  EXPECT_THROW(addBody(bodies, {1.0, {}, {1, 1, 1}, {}}, {}, {0, 0, 0, 0}), InputError);
  MassProperties noAxes = asymmetric;
  noAxes.axes = {0, 0, 0, 0};
  EXPECT_THROW(addBody(bodies, noAxes, {}), InputError);
  EXPECT_EQ(bodies.size(), 0u);
}

/// Whether the message of what a call throws holds the text.
template <class Exception, class Call>
bool says(Call&& call, const std::string& text) {
  try {
    call();
  } catch (const Exception& error) {
    return std::string(error.what()).find(text) != std::string::npos;
  }
  return false;
}

TEST(Bodies, AQuaternionOfAnyLengthIsMadeAUnitOneAndLaterOnesAreRefused) {
  Bodies twice, unit;
  addBody(twice, asymmetric, {}, {2, 0, 0, 0});
  addBody(unit, asymmetric, {}, {1, 0, 0, 0});
  EXPECT_EQ(distance(twice.orientation[0], unit.orientation[0]), 0.0);
  EXPECT_NO_THROW(validate(twice));
  twice.orientation[0] = {2, 0, 0, 0};
  EXPECT_TRUE(says<InputError>([&] { validate(twice); }, "body 0, orientation"));
  unit.mass.push_back(1.0);
  EXPECT_TRUE(says<InputError>([&] { validate(unit); }, "mass of bodies"));
}

TEST(Bodies, WhatIsNotFiniteIsNamed) {
  const auto named = [](auto&& change, const std::string& text) {
    Bodies bodies;
    for (int i = 0; i < 3; ++i) addBody(bodies, asymmetric, {});
    EXPECT_NO_THROW(requireFinite(bodies, "t = 0 s"));
    change(bodies);
    EXPECT_TRUE(says<NumericalError>([&] { requireFinite(bodies, "t = 0 s"); }, text)) << text;
  };
  const double nan = std::nan("");
  named([&](Bodies& b) { b.x[1].y = nan; }, "position");
  named([&](Bodies& b) { b.v[1].x = nan; }, "velocity");
  named([&](Bodies& b) { b.f[2].z = INFINITY; }, "force");
  named([&](Bodies& b) { b.torque[0].z = nan; }, "torque");
  named([&](Bodies& b) { b.angularMomentum[1].z = nan; }, "angular momentum");
  named([&](Bodies& b) { b.orientation[1].w = nan; }, "orientation");
}

TEST(Bodies, DampingTakesWhatItSays) {
  Bodies bodies;
  addBody(bodies, asymmetric, {}, {0.3, -0.4, 0.5, 0.7}, {1, 2, 3}, {0.1, 1.0, -0.05});
  EXPECT_NEAR(applyViscousDamping(bodies, 0.7), 2.0 * 0.7 * kineticEnergy(bodies), 1e-13);
  EXPECT_LE(norm(bodies.f[0] + 0.7 * 2.0 * Vec3{1, 2, 3}), 1e-14);
  EXPECT_LE(norm(bodies.torque[0] + 0.7 * bodies.angularMomentum[0]), 1e-14);
  bodies.f[0] = {1, -2, 0};
  bodies.torque[0] = {};
  EXPECT_NEAR(applyLocalDamping(bodies, 0.5), 0.5 + 2.0, 1e-14);
  EXPECT_EQ(bodies.f[0], (Vec3{0.5, -3, 0}));
  for (const double bad : {-1.0, std::nan("")}) {
    EXPECT_THROW(applyViscousDamping(bodies, bad), InputError);
    EXPECT_THROW(applyLocalDamping(bodies, bad), InputError);
  }
}

}  // namespace
}  // namespace dovetail::dem
