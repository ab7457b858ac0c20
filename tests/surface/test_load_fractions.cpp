// Contacts in an overlap with the solid: they act with its fraction, and not on those who are tied to it.
#include <gtest/gtest.h>

#include <cstdint>

#include "scenes.hpp"

namespace dovetail::surface {
namespace {

constexpr double k = 1e4, radius = 0.3;

/// 1 − w along x.
std::vector<double> fractionsOf(const fem::SolidMesh& mesh) {
  std::vector<double> fraction;
  for (const Vec3& X : mesh.X) fraction.push_back(0.1 + 0.2 * X.x);
  return fraction;
}

TEST(Shares, ContactsActWithThatOfTheirPoint) {
  const fem::SolidMesh mesh = unitBlock();
  const std::vector<double> fraction = fractionsOf(mesh);
  const std::vector<Vec3> rest(mesh.X.size());
  for (const Variant& variant : allVariants()) {
    if (variant.smooth && variant.width > 0.0) continue;  // control points have fractions of the kernel's mean
    SurfaceCoupler seam = makeSeam(mesh, variant);
    const std::vector<double> places{1.1, 1.7, 2.4};
    dem::Particles particles;
    for (const double x : places) dem::addParticle(particles, {x, 2.2, radius - 0.01}, {}, radius, dem::Mass{1.0});
    const std::vector<std::uint8_t> tied{0, 0, 1};
    ExchangeOptions options;
    options.fraction = fraction;
    options.tied = tied;
    seam.exchange(particles, rest, rest, *elasticLaws(k), 1e-3, options);
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(particles.f[i].z, k * 0.01 * (0.1 + 0.2 * places[i]), 1e-9) << variant.name;
    EXPECT_EQ(particles.f[2], Vec3{}) << variant.name;
    Vec3 sum;
    for (const Vec3& f : seam.load().force) sum += f;
    EXPECT_NEAR(sum.z, -(particles.f[0].z + particles.f[1].z), 1e-9);
  }
}

/// What a grain has more, or less, after it has bounced along a side whose fraction grows, is what was booked.
double unbooked(double dt, double* made) {
  const fem::SolidMesh mesh = unitBlock();
  const std::vector<double> fraction = fractionsOf(mesh);
  const std::vector<Vec3> rest(mesh.X.size());
  SurfaceCoupler seam = makeSeam(mesh, {"local"});
  dem::Particles p;
  dem::addParticle(p, {0.7, 2.2, radius + 0.01}, {20.0, 1.0, -2.0}, radius, dem::Mass{1.0});
  const auto laws = elasticLaws(k);
  ExchangeOptions options;
  options.fraction = fraction;
  double stored = 0.0;
  const auto evaluate = [&] {
    dem::clearForces(p);
    stored = seam.exchange(p, rest, rest, *laws, dt, options).elasticEnergy;
  };
  evaluate();
  const double start = 0.5 * squaredNorm(p.v[0]);
  for (int step = 0; step < std::lround(0.1 / dt); ++step) {
    p.v[0] += 0.5 * dt * p.f[0];
    p.x[0] += dt * p.v[0];
    evaluate();
    p.v[0] += 0.5 * dt * p.f[0];
  }
  *made = seam.madeByWeights();
  return 0.5 * squaredNorm(p.v[0]) + stored - start - *made;
}

TEST(Shares, WhatTheirChangesMakeIsBooked) {
  double made = 0.0;
  const double left = unbooked(1e-4, &made);
  EXPECT_GT(made, 0.02);
  EXPECT_LT(std::abs(left), 2e-3 * made);
}

}  // namespace
}  // namespace dovetail::surface
