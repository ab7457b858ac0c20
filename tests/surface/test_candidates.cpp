// Reused candidate lists never change a contact.
#include <gtest/gtest.h>

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "scenes.hpp"

namespace dovetail::surface {
namespace {

constexpr double radius = 0.3;
constexpr int steps = 1500;

fem::SolidMesh strip() { return fem::boxOf(fem::ElementShape::hex8, {40, 2, 1}, {0, 0, -1}, {40, 2, 0}); }

double height(double X, double t) { return 0.3 * std::sin(1.2 * X + 12.0 * t); }

/// A wave runs along the strip, against the particles.
std::vector<Vec3> wave(const fem::SolidMesh& mesh, double t) {
  std::vector<Vec3> u;
  for (const Vec3& X : mesh.X)
    u.push_back({0.05 * std::sin(0.9 * X.x - 20.0 * t), 0.02 * std::cos(X.x + 7.0 * t), height(X.x, t)});
  return u;
}

/// They ride on it, now and then off it.
dem::Particles travellers(double t) {
  dem::Particles particles;
  for (int i = 0; i < 6; ++i) {
    const double x = 2.0 + 5.0 * i + 6.0 * t;
    dem::addParticle(particles, {x, 0.4 + 0.25 * i, height(x, t) + 0.25 + 0.1 * std::sin(30.0 * t + i)}, {}, radius,
                     dem::Mass{1.0});
  }
  return particles;
}

struct Trace {
  std::vector<Vec3> force, load;
  std::vector<int> contacts;
  int shared = 0;  // states in which a particle has several contacts
  std::int64_t builds = 0;
  friend bool operator==(const Trace& a, const Trace& b) {
    return a.force == b.force && a.load == b.load && a.contacts == b.contacts;
  }
};

void record(SurfaceCoupler& seam, double t, const fem::SolidMesh& mesh, Trace& trace) {
  dem::Particles particles = travellers(t);
  const auto u = wave(mesh, t);
  seam.exchange(particles, u, std::vector<Vec3>(u.size()), *elasticLaws(1e4), 1e-3);
  trace.force.insert(trace.force.end(), particles.f.begin(), particles.f.end());
  trace.contacts.push_back(static_cast<int>(seam.contacts().size()));
  const auto& who = seam.contacts().particle;
  trace.shared += std::adjacent_find(who.begin(), who.end()) != who.end();
  for (int node : seam.load().touched) trace.load.push_back(seam.load().force[node]);
}

Trace run(const Variant& variant, double margin) {
  const fem::SolidMesh mesh = strip();
  SurfaceCoupler seam(carriedSkin(mesh, variant), {dem::EdgeRule::projected, margin});
  Trace trace;
  for (int step = 0; step < steps; ++step) record(seam, 1e-3 * step, mesh, trace);
  trace.builds = seam.candidateBuilds();
  return trace;
}

TEST(Candidates, ContactsAreThoseOfListsMadeEveryStep) {
  for (const Variant& variant :
       {Variant{"local"}, Variant{"linear", 3.0, cg::KernelShape::lucy, cg::KernelCorrection::linear}}) {
    const Trace fresh = run(variant, 1e-9), kept = run(variant, 0.0), wide = run(variant, 1.0);
    EXPECT_EQ(fresh.builds, steps);
    EXPECT_LT(kept.builds, steps / 2);
    EXPECT_LT(wide.builds, kept.builds);
    EXPECT_GT(*std::max_element(fresh.contacts.begin(), fresh.contacts.end()), 3);
    EXPECT_GT(fresh.shared, variant.width > 0.0 ? 1 : 20);
    EXPECT_TRUE(kept == fresh) << variant.name;
    EXPECT_TRUE(wide == fresh) << variant.name;
  }
}

TEST(Candidates, OnTheSmoothSurfaceUpToItsTolerance) {
  const fem::SolidMesh mesh = strip();
  Trace traces[2];
  for (int k = 0; k < 2; ++k) {
    SurfaceCoupler seam(makeSmoothSurface(makeSkin(mesh.X, mesh.faceSets.at("skin"))), {.margin = k == 0 ? 1e-9 : 0.0});
    for (int step = 0; step < steps; ++step) record(seam, 1e-3 * step, mesh, traces[k]);
  }
  EXPECT_EQ(traces[0].contacts, traces[1].contacts);
  double largest = 0.0;
  for (const Vec3& f : traces[0].force) largest = std::max(largest, norm(f));
  for (std::size_t i = 0; i < traces[0].force.size(); ++i)
    EXPECT_LE(norm(traces[0].force[i] - traces[1].force[i]), 1e-11 * largest);
}

TEST(Candidates, AreMadeAnewForMoreParticles) {
  const fem::SolidMesh mesh = strip();
  SurfaceCoupler seam(carriedSkin(mesh, {"local"}));
  const std::vector<Vec3> rest(mesh.X.size());
  dem::Particles particles;
  seam.exchange(particles, rest, rest, *elasticLaws(1e4), 1e-3);
  EXPECT_FALSE(seam.inContact());
  dem::addParticle(particles, {1, 1, 0.29}, {}, radius, dem::Mass{1.0});
  seam.exchange(particles, rest, rest, *elasticLaws(1e4), 1e-3);
  EXPECT_TRUE(seam.inContact());
}

std::string failure(SurfaceCoupler seam, const dem::Particles& good, const dem::Particles& bad, std::span<const Vec3> u,
                    std::span<const Vec3> badU) {
  dem::Particles particles = good;
  seam.exchange(particles, u, u, *elasticLaws(1e4), 1e-3);
  particles = bad;
  try {
    seam.exchange(particles, badU, badU, *elasticLaws(1e4), 1e-3);
  } catch (const NumericalError& error) {
    return error.what();
  }
  return "not noticed";
}

TEST(Candidates, ANaNIsCaughtAtOnceWithItsNumber) {
  const fem::SolidMesh mesh = strip();
  const std::vector<Vec3> u(mesh.X.size());
  const dem::Particles good = travellers(0.0);
  dem::Particles bad = good;
  bad.x[3].y = std::nan("");
  std::vector<Vec3> badU = u;
  const int node = mesh.faceSets.at("z+")[7].node[2];
  badU[node].z = std::nan("");
  const Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  const std::string nodeName = "node " + std::to_string(node);
  EXPECT_NE(failure(SurfaceCoupler(skin), good, bad, u, u).find("particle 3"), std::string::npos);
  EXPECT_NE(failure(SurfaceCoupler(skin), good, good, u, badU).find(nodeName), std::string::npos);
  const SmoothSurface smooth = makeSmoothSurface(skin);
  EXPECT_NE(failure(SurfaceCoupler(smooth), good, bad, u, u).find("particle 3"), std::string::npos);
  EXPECT_NE(failure(SurfaceCoupler(smooth), good, good, u, badU).find(nodeName), std::string::npos);
}

TEST(Candidates, RefuseABadMargin) {
  const fem::SolidMesh mesh = strip();
  const Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  EXPECT_THROW(SurfaceCoupler(skin, {dem::EdgeRule::projected, -1.0}), InputError);
  EXPECT_THROW(SurfaceCoupler(skin, {dem::EdgeRule::projected, std::nan("")}), InputError);
  EXPECT_THROW(SurfaceCoupler(makeSmoothSurface(skin), {.margin = -1.0}), InputError);
}

}  // namespace
}  // namespace dovetail::surface
