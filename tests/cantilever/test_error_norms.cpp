#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "reference/error_norms.hpp"

namespace dovetail::cantilever {
namespace {

// Particles at constant speed on the static curve, moved off it by dx outwards and dz upwards.
std::vector<PairSample> shiftedSamples(const BeamCase& beam, const StaticOptions& settings, double dx, double dz) {
  std::vector<PairSample> samples;
  for (int i = 0; i <= 700; ++i) {
    const double time = 0.05 * i, y = 0.2 + 0.34 * time, z = staticHeight(beam, y, settings) + dz;
    samples.push_back({time, {Vec3{-beam.startX - dx, y, z}, Vec3{beam.startX + dx, y, z}}});
  }
  return samples;
}

// y = 0.2 + 0.4 t, z = 0.5 − 0.001 t²
DynamicReference parabola() {
  DynamicReference reference;
  for (int i = 0; i <= 30; ++i) {
    reference.time.push_back(i);
    reference.y.push_back(0.2 + 0.4 * i);
    reference.z.push_back(0.5 - 0.001 * i * i);
    reference.vy.push_back(0.4);
    reference.vz.push_back(-0.002 * i);
  }
  reference.leaveTime = reference.timeAtY(12.0);
  return reference;
}

TEST(StaticReference, IsTheTextbookDeflection) {
  const BeamCase beam;
  const double bending = 1e8 * std::pow(0.8, 4) / 12.0, force = 2.0 * 9.81 * 2e4 * 4.0 / 3.0 * std::numbers::pi * 1e-3;
  EXPECT_NEAR(force, 1643.7, 0.05);
  const double start = 0.5 - force / 2.0 / 2e7;
  EXPECT_NEAR(start - staticHeight(beam, 7.0), force * 343.0 / (3.0 * bending), 1e-13);
  EXPECT_NEAR(start - staticHeight(beam, 7.2, {.armOrigin = 0.2}), force * 343.0 / (3.0 * bending), 1e-13);
  EXPECT_NEAR(staticHeight(beam, 7.0) - staticHeight(beam, 7.0, {.shear = true}),
              force * 7.0 / (5.0 / 6.0 * 5e7 * 0.64), 1e-13);
  EXPECT_NEAR(start - staticHeight({.bendingFactor = 1.125}, 7.0), force * 343.0 / (3.0 * 1.125 * bending), 1e-13);
  EXPECT_EQ(staticHeight(beam, 0.1, {.armOrigin = 0.2}), startHeight(beam));
}

TEST(ErrorNorms, AConstantShiftIsFoundExactly) {
  const BeamCase beam;
  for (const StaticOptions& settings : {StaticOptions{}, StaticOptions{.armOrigin = 0.2, .shear = true}}) {
    const PairError error = errorFromStatic(shiftedSamples(beam, settings, 3e-3, 4e-3), beam, settings);
    EXPECT_NEAR(error.mean, std::sqrt(2.0) * 5e-3, 1e-14);
    EXPECT_NEAR(error.largest, std::sqrt(2.0) * 5e-3, 1e-14);
    EXPECT_NEAR(error.until, 34.7, 1e-12);  // the last sample before y = 12 m, at 34.706 s
  }
}

TEST(ErrorNorms, TheMeanIsOverTimeNotOverSamples) {
  const BeamCase beam;
  std::vector<PairSample> samples = shiftedSamples(beam, {}, 0.0, 1e-3);
  std::vector<PairSample> uneven;  // one in ten of the first half, all of the second, whose error is made 3e-3
  for (std::size_t i = 0; i < 600; ++i) {
    if (i > 300)
      for (Vec3& x : samples[i].x) x.z += 2e-3;
    if (i >= 300 || i % 10 == 0) uneven.push_back(samples[i]);
  }
  const double expected = (15.0 * 1e-3 + 0.05 * 2e-3 + 14.9 * 3e-3) / 29.95;
  EXPECT_NEAR(errorFromStatic(uneven, beam).mean, std::sqrt(2.0) * expected, 1e-14);
}

TEST(ErrorNorms, SameTimeSeesADelayAndSameYDoesNot) {
  const BeamCase beam;
  const DynamicReference reference = parabola();
  std::vector<PairSample> late;  // one second behind on the same path
  for (int i = 0; i <= 300; ++i) {
    const double time = 1.0 + 0.1 * i;
    const BeamPosition place = reference.at(std::min(time - 1.0, reference.time.back()));
    late.push_back({time, {Vec3{0.2, place.y, place.z}, Vec3{-0.2, place.y, place.z}}});
  }
  EXPECT_NEAR(errorFromDynamicAtY(late, beam, reference).largest, 0.0, 1e-14);
  const PairError delayed = errorFromDynamicAtTime(late, beam, reference);
  // Δz = 0.001 (2t − 1), whose mean over 1 … 29.5 s is 0.0295
  EXPECT_NEAR(delayed.until, 29.5, 1e-12);
  EXPECT_NEAR(delayed.mean, std::sqrt(2.0) * 0.0295, 1e-12);
}

TEST(ErrorNorms, HermiteInterpolationIsExactForCubicsAndInverts) {
  const DynamicReference reference = parabola();
  for (double t : {0.0, 0.3, 17.77, 29.4}) {
    const BeamPosition place = reference.at(t);
    EXPECT_NEAR(place.z, 0.5 - 0.001 * t * t, 1e-15);
    EXPECT_NEAR(place.vz, -0.002 * t, 1e-14);
    EXPECT_NEAR(reference.timeAtY(place.y), t, 1e-13);
  }
  EXPECT_NEAR(reference.leaveTime, 29.5, 1e-13);
  EXPECT_THROW(reference.at(30.1), InputError);
  EXPECT_THROW(reference.atY(0.1), InputError);
  EXPECT_THROW(DynamicReference{}.at(0.0), InputError);
}

TEST(ErrorNorms, TooFewSamplesAreRefused) {
  const std::vector<PairSample> one = {{0.0, {Vec3{0.2, 0.2, 0.5}, Vec3{-0.2, 0.2, 0.5}}}};
  EXPECT_THROW(errorFromStatic(one, BeamCase{}), InputError);
  EXPECT_THROW(errorFromStatic({}, BeamCase{}), InputError);
}

}  // namespace
}  // namespace dovetail::cantilever
