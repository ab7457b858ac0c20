// What is not finite is named by what it is, with the particle, before it spreads.
#include <gtest/gtest.h>

#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

/// A row of spheres that touch, on a floor; ids run against numbers.
Model row() {
  Model model;
  model.laws = makeContactLaws(FrictionalLaw{{1e4, 0.5}, {3e3, 0.4}});
  model.gravity = {0, 0, -9.81};
  model.pairs.setSkin(0.02);
  model.sortEvery = 0;
  for (int i = 0; i < 20; ++i) addParticle(model.particles, {0.0999 * i, 0, 0.0499}, {0.1, 0, 0}, 0.05, Mass{1.0});
  std::reverse(model.particles.id.begin(), model.particles.id.end());
  addWall(model, makePlane({}, {0, 0, 1}));
  run(model, 1e-4, 3);
  return model;
}

/// What a run says that somebody has spoilt, within two steps.
template <class Spoil>
std::string said(Spoil&& spoil, bool driven = false) {
  Model model = row();
  if (driven)
    model.terms.add(DriveTerm(
        {2}, [](double) { return Vec3{}; }, [](double) { return Vec3{}; }));
  advance(model, 1e-4);
  spoil(model);
  try {
    for (int s = 0; s < 2; ++s) advance(model, 1e-4);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

void expectNamed(const std::string& text, const std::string& what, const std::string& whose) {
  EXPECT_NE(text.find(what + " is not finite"), std::string::npos) << what << ": " << text;
  EXPECT_NE(text.find("particle " + whose + "]"), std::string::npos) << what << ": " << text;
}

TEST(NotFinite, EachFieldIsNamedWithItsParticle) {
  constexpr std::size_t i = 12;  // id 7
  for (const bool driven : {false, true})
    for (const double bad : {nan, inf}) {
      expectNamed(said([&](Model& m) { m.particles.mass[i] = nan; }, driven), "mass", "7");
      expectNamed(said([&](Model& m) { m.particles.radius[i] = nan; }, driven), "radius", "7");
      expectNamed(said([&](Model& m) { m.particles.x[i].y = bad; }, driven), "position", "7");
      expectNamed(said([&](Model& m) { m.particles.v[i].y = bad; }, driven), "velocity", "7");
      expectNamed(said([&](Model& m) { m.particles.f[i].z = bad; }, driven), "force", "7");
      if (driven) continue;
      expectNamed(said([&](Model& m) { m.particles.omega[i].x = bad; }), "angular velocity", "7");
      expectNamed(said([&](Model& m) { m.particles.torque[i].x = bad; }), "torque", "7");
    }
}

TEST(NotFinite, GravityAndForcesOfTheCallersAreNamed) {
  EXPECT_NE(said([](Model& m) { m.gravity.x = nan; }).find("gravity"), std::string::npos);
  const std::string text = said([](Model& m) {
    m.terms.add(ExternalForceTerm("wind", [](const Particles&, double, std::span<Vec3> f) { f[3].x = nan; }));
  });
  EXPECT_NE(text.find("'wind'"), std::string::npos) << text;
  EXPECT_NE(text.find("particle 16"), std::string::npos) << text;
}

TEST(NotFinite, BodiesAreNamed) {
  const std::string text = said([](Model& m) {
    const ClumpShape ball = makeClumpShape(std::vector<Vec3>{{0, 0, 0}}, std::vector<double>{0.05}, Density{1000.0});
    addClump(m, ball, {0, 3, 1});
    advance(m, 1e-4);
    bodies(m).bodies.angularMomentum[0].x = nan;
  });
  EXPECT_NE(text.find("angular momentum of body 0"), std::string::npos) << text;
}

TEST(NotFinite, NothingHasMovedByThen) {
  Model model = row();
  advance(model, 1e-4);
  const std::vector<Vec3> before = model.particles.x;
  model.particles.omega[5].y = nan;
  EXPECT_THROW(advance(model, 1e-4), NumericalError);
  EXPECT_EQ(model.particles.x[5], before[5]);
}

}  // namespace
}  // namespace dovetail::dem
