#include <gtest/gtest.h>

#include <cmath>

#include "short_bar.hpp"

namespace dovetail::wave {
namespace {

struct ProfileRun {
  io::TimeSeries table{{"time_s"}};
  RunResult result;
};

ProfileRun runWithProfile(const Settings& settings) {
  ProfileRun profile;
  profile.result = run(settings, [](const Frame&) {});
  compare(profile.result);
  profile.table = *profile.result.velocityProfile;
  return profile;
}

/// Sum over the rows of a model at the last time.
template <class Part>
double sumAtEnd(const io::TimeSeries& table, double model, Part part) {
  const auto t = table.column("time_s"), kind = table.column("model");
  double sum = 0.0;
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (t[row] == t.back() && kind[row] == model) sum += part(row);
  return sum;
}

TEST(VelocityProfile, HasEveryLayerOfEveryModel) {
  const Settings settings = test::shortBar();
  const ProfileRun profile = runWithProfile(settings);
  const auto one = [](std::size_t) { return 1.0; };
  EXPECT_EQ(sumAtEnd(profile.table, 0.0, one), solidElements(settings) + 1);
  EXPECT_EQ(sumAtEnd(profile.table, 1.0, one), 10);  // 4 m of 0.4 m
  EXPECT_EQ(sumAtEnd(profile.table, 2.0, one), layers(settings, barLength(settings)));
}

TEST(VelocityProfile, CarriesTheMomentumOfTheParticles) {
  const Settings settings = test::shortBar();
  const ProfileRun profile = runWithProfile(settings);
  const auto v = profile.table.column("velocity_y_m_per_s"), fraction = profile.table.column("particles_fraction");
  const double layerMass = particlesPerLayer(settings) * particleMass(settings);
  const double sum = sumAtEnd(profile.table, 1.0, [&](std::size_t row) { return layerMass * fraction[row] * v[row]; });
  const double momentum = profile.result.series.column("momentum_particles_y_Ns").back();
  EXPECT_NEAR(sum, momentum, 1e-12 * std::abs(momentum));
}

TEST(VelocityProfile, SharesOfParticlesFallFromOneToZeroAcrossTheOverlap) {
  const Settings settings = test::shortBar();
  const io::TimeSeries table = runWithProfile(settings).table;
  const auto y = table.column("y_m"), fraction = table.column("particles_fraction"), kind = table.column("model");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (kind[row] == 2.0) continue;
    const double least = y[row] < 2.4 - 1e-9 ? 1.0 : 0.0, most = y[row] > 4.0 + 1e-9 ? 0.0 : 1.0;
    EXPECT_GE(fraction[row], least) << y[row];
    EXPECT_LE(fraction[row], most) << y[row];
    const bool middle = std::abs(y[row] - 3.2) < 1e-9;
    EXPECT_NEAR(fraction[row], 0.5, middle ? 1e-12 : 0.5);
  }
}

TEST(VelocityProfile, ParticlesAloneAreWhatTheSolidIsComparedWith) {
  const ProfileRun profile = runWithProfile(test::shortBar());
  const auto v = profile.table.column("velocity_y_m_per_s");
  const auto square = [&](std::size_t row) { return v[row] * v[row]; };
  const double nodes = sumAtEnd(profile.table, 0.0, square), alone = sumAtEnd(profile.table, 2.0, square);
  EXPECT_GT(alone, 1e-3);
  EXPECT_NEAR(nodes / alone, 1.0, 0.05);  // the pulse is in the solid at the end
}

}  // namespace
}  // namespace dovetail::wave
