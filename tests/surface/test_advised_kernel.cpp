// Impacts on slender bodies with Hertz's law: meshes agree with the advised kernel, and drift without one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "dovetail/dem/laws/materials.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/surface/surface_contact.hpp"

namespace dovetail::surface {
namespace {

constexpr double modulus = 70e9, poisson = 0.3, density = 2700.0;  // Pa, kg/m³
constexpr double height = 0.01, length = 0.1, radius = 0.01;       // m

fem::SolidMesh barMesh(int overHeight) {
  return fem::boxOf(fem::ElementShape::hex8, {10 * overHeight / 2, overHeight, overHeight},
                    {-0.5 * length, -0.5 * height, -height}, {0.5 * length, 0.5 * height, 0});
}

/// The largest force, N, of a ball that hits the middle of a square bar held at both ends.
double peakForce(int overHeight, bool withKernel) {
  const fem::SolidMesh mesh = barMesh(overHeight);
  auto bar = std::make_unique<fem::Model>(fem::makeModel(mesh));
  bar->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(fem::StVenantKirchhoff{modulus, poisson, density})),
                          {.formulation = fem::Formulation::enhanced}));
  for (const char* side : {"x-", "x+"}) fem::fix(bar->nodes, mesh.nodeSets.at(side));
  fem::addMass(*bar);
  Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  if (withKernel) coarseGrain(skin, advisedKernel(mesh));

  coupling::CoupledRun run;
  dem::ContactLaw<dem::HertzDashpot> law;
  law.normal.effectiveModulus = dem::effectiveModulus({modulus, poisson}, {modulus, poisson});
  run.grains.laws = dem::makeContactLaws(law);
  dem::addParticle(run.grains.particles, {0, 0, radius}, {0, 0, -0.5}, radius, dem::Density{7800.0});
  const double dt = 0.8 * fem::stableStep(*bar).dt;
  coupling::SolidSide& side = run.addSolid(std::move(bar), {.name = "bar"});
  run.grains.terms.add(SurfaceContact(side, SurfaceCoupler(skin), run.grains.laws, "impact"));
  run.grains.refusesUnstableSteps = false;  // the contact adds little to the elements
  run.start(dt);
  double largest = 0.0;
  double force = 0.0;
  while (run.time() < 1e-4 && force >= 0.9 * largest) {  // up to a little after the peak
    run.advance(1, false);
    force = run.grains.particles.f[0].z;
    largest = std::max(largest, force);
  }
  return largest;
}

TEST(AdvisedKernel, IsAsWideAsTheBodyIsThick) {
  const auto widthOf = [](Vec3 size) {
    return advisedKernel(fem::boxOf(fem::ElementShape::hex8, {3, 2, 2}, {5, 5, 5}, Vec3{5, 5, 5} + size)).kernel.width;
  };
  EXPECT_NEAR(widthOf({1, 1, 1}), 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(widthOf({1000, 1, 1}), 0.5, 1e-3);
  EXPECT_NEAR(widthOf({1000, 1000, 1}), 1.0, 1e-2);
}

TEST(AdvisedKernel, ImpactsDoNotDependOnTheMesh) {
  std::vector<double> with, without;
  for (const int n : {4, 6, 8}) {
    with.push_back(peakForce(n, true));
    without.push_back(peakForce(n, false));
  }
  EXPECT_LT(std::abs(with[2] / with[0] - 1.0), 0.01);
  EXPECT_LT(std::abs(with[2] - with[1]), 0.5 * std::abs(with[1] - with[0])) << "meshes converge";
  EXPECT_LT(without[2] / without[0], 0.96) << "single nodes give way once more";
  EXPECT_GT(std::abs(without[2] - without[1]), 0.75 * std::abs(without[1] - without[0])) << "and do not converge";
}

}  // namespace
}  // namespace dovetail::surface
