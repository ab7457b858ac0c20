#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "reference/error_norms.hpp"

namespace dovetail::cantilever {
namespace {

ModalOptions withModes(int modes) {
  ModalOptions settings;
  settings.modes = modes;
  return settings;
}

ModalOptions bernoulliModes() {
  ModalOptions settings = withModes(24);
  settings.theory.shear = settings.theory.rotaryInertia = settings.surfaceOffset = settings.largeRotations = false;
  return settings;
}

TEST(MovingMass, StartsWithTheEnergyOfThePublishedCase) {
  const DynamicReference reference = simulateMovingMassBeam(BeamCase{}, withModes(8));
  EXPECT_NEAR(reference.startEnergy, 0.8716, 1e-4);
  EXPECT_DOUBLE_EQ(reference.z.front(), 0.5 - 83.7758040957278 * 9.81 / 2e7);
  EXPECT_EQ(reference.separatedFraction, 0.0);
}

TEST(MovingMass, EnergyDriftIsSmallAndOfSecondOrder) {
  ModalOptions settings = withModes(16);
  double drift[3];
  for (int i = 0; i < 3; ++i) {
    settings.dt = 4e-4 / std::pow(2.0, i);
    drift[i] = simulateMovingMassBeam(BeamCase{}, settings).energyDriftRelative;
  }
  EXPECT_LT(drift[2], 2e-6);
  EXPECT_NEAR(std::log2(drift[0] / drift[1]), 2.0, 0.1);
  EXPECT_NEAR(std::log2(drift[1] / drift[2]), 2.0, 0.1);
}

TEST(MovingMass, ConvergesWithTheNumberOfModes) {
  const BeamCase beam;
  const DynamicReference r8 = simulateMovingMassBeam(beam, withModes(8)),
                         r12 = simulateMovingMassBeam(beam, withModes(12)),
                         r16 = simulateMovingMassBeam(beam, withModes(16));
  const auto p8 = pairSamples(beam, r8), p12 = pairSamples(beam, r12);
  const double path8 = errorFromDynamicAtY(p8, beam, r12).mean, path12 = errorFromDynamicAtY(p12, beam, r16).mean;
  EXPECT_LT(path8, 0.02e-3);
  EXPECT_LT(path12, 0.5 * path8);
  // At the same time a change of the arrival counts as well, and the sag grows fast in the last second.
  const double late8 = errorFromDynamicAtTime(p8, beam, r12).mean, late12 = errorFromDynamicAtTime(p12, beam, r16).mean;
  EXPECT_LT(late8, 0.7e-3);
  EXPECT_LT(late12, 0.25 * late8);
  EXPECT_LT(std::abs(r16.leaveTime - r12.leaveTime), 0.3 * std::abs(r12.leaveTime - r8.leaveTime));
}

TEST(MovingMass, TheDefaultModesAreWithinFifteenMillisecondsOfTheLimit) {
  const BeamCase beam;
  ModalOptions many = withModes(80);
  many.theory.basis = 100;
  const DynamicReference limit = simulateMovingMassBeam(beam, many), usual = simulateMovingMassBeam(beam, {});
  EXPECT_NEAR(usual.leaveTime, limit.leaveTime, 0.015);
  EXPECT_LT(errorFromDynamicAtY(pairSamples(beam, usual), beam, limit).mean, 0.01e-3);
  EXPECT_LT(errorFromDynamicAtTime(pairSamples(beam, usual), beam, limit).mean, 0.2e-3);
}

TEST(MovingMass, BernoulliBeamLeavesWhenAnIndependentModelDoes) {
  const DynamicReference soft = simulateMovingMassBeam(BeamCase{}, bernoulliModes());
  EXPECT_NEAR(soft.leaveTime, 35.49, 0.015);
  EXPECT_NEAR(simulateMovingMassBeam({.bendingFactor = 1.125}, bernoulliModes()).leaveTime, 36.67, 0.015);
  EXPECT_NEAR(errorFromStatic(pairSamples(BeamCase{}, soft), BeamCase{}).mean, 0.48e-3, 0.02e-3);
}

TEST(MovingMass, EveryEffectHasItsSign) {
  const BeamCase beam;
  ModalOptions settings = bernoulliModes();
  settings.modes = 12;
  const double plain = simulateMovingMassBeam(beam, settings).leaveTime;
  settings.theory.shear = settings.theory.rotaryInertia = true;
  const double shear = simulateMovingMassBeam(beam, settings).leaveTime;
  EXPECT_LT(shear, plain - 0.3);  // a softer beam is steeper under the load
  settings.surfaceOffset = true;
  const double offset = simulateMovingMassBeam(beam, settings).leaveTime;
  EXPECT_GT(offset, shear);  // the top surface moves towards the tip, so the load's arm is shorter
  settings.largeRotations = true;
  EXPECT_LT(simulateMovingMassBeam(beam, settings).leaveTime, offset);  // the axis moves towards the clamp
}

TEST(MovingMass, ARigidBeamIsCrossedAtConstantSpeed) {
  BeamCase beam;
  beam.youngsModulus = 1e15;
  beam.startVelocity = 3.0;
  ModalOptions settings = withModes(1);
  settings.dt = 2e-5;
  settings.theory.rotaryInertia = settings.theory.shear = false;
  const DynamicReference reference = simulateMovingMassBeam(beam, settings);
  EXPECT_NEAR(reference.leaveTime, 11.8 / 3.0, 1e-6);
  EXPECT_NEAR(reference.at(2.0).z, startHeight(beam), 1e-7);
}

TEST(MovingMass, TheSampleIntervalDoesNotChangeTheInterpolatedPath) {
  ModalOptions settings = withModes(12);
  settings.sampleInterval = 1e-4;
  const DynamicReference dense = simulateMovingMassBeam(BeamCase{}, settings);
  settings.sampleInterval = 2e-3;
  const DynamicReference sparse = simulateMovingMassBeam(BeamCase{}, settings);
  double largest = 0.0;
  for (std::size_t i = 0; i < dense.time.size(); ++i)
    if (dense.time[i] <= sparse.time.back())
      largest = std::max(largest, std::abs(sparse.at(dense.time[i]).z - dense.z[i]));
  EXPECT_LT(largest, 1e-7);
  EXPECT_NEAR(sparse.leaveTime, dense.leaveTime, 1e-8);
}

TEST(MovingMass, ImpossibleSettingsAreRefused) {
  ModalOptions settings;
  settings.dt = 0.01;  // unstable for the highest mode
  EXPECT_THROW(simulateMovingMassBeam(BeamCase{}, settings), InputError);
  settings = {};
  settings.theory.supports = Supports::simplySupported;
  EXPECT_THROW(simulateMovingMassBeam(BeamCase{}, settings), InputError);
  settings = {};
  settings.maxTime = 1.0;
  EXPECT_THROW(simulateMovingMassBeam(BeamCase{}, settings), NumericalError);
  EXPECT_THROW(simulateMovingMassBeam({.startY = 12.5}, {}), InputError);
}

}  // namespace
}  // namespace dovetail::cantilever
