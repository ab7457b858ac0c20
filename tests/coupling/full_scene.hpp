// Scenes as users make them: grains with friction, walls, clumps and insertion on a deformable block.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <ostream>

#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/laws/rolling.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/setup/streams.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "spring_scene.hpp"

namespace dovetail::coupling {

inline constexpr double dt = 1e-4;

inline std::shared_ptr<const dem::ContactLaws> frictionalLaws() {
  dem::ContactLaw<dem::LinearSpringDashpot, dem::TangentialSpring, dem::RollingAndTwisting> law;
  law.normal = {2e4, 0.7};
  law.tangential = {.stiffness = 1.5e4, .friction = 0.4};
  law.rolling = {{.friction = 0.1, .stiffnessRatio = 0.2}, {.friction = 0.1, .stiffnessRatio = 0.1}};
  return dem::makeContactLaws(law);
}

inline fem::SolidMesh tetBlock() { return fem::boxOf(fem::ElementShape::tet4, {3, 3, 1}, {0, 0, -0.2}, {0.6, 0.6, 0}); }

inline surface::Skin topOf(const fem::SolidMesh& mesh) { return surface::makeSkin(mesh.X, mesh.faceSets.at("skin")); }

inline SolidSide& addBlock(CoupledRun& run, const SolidOptions& options = {.name = "block"}) {
  const fem::SolidMesh mesh = tetBlock();
  SolidSide& side = run.addSolid(block(mesh, true), options);
  run.grains.terms.add(
      surface::SurfaceContact(side, surface::SurfaceCoupler(topOf(mesh)), frictionalLaws(), "contacts"));
  return side;
}

inline void addLayer(CoupledRun& run, int count) {
  dem::Particles& p = run.grains.particles;
  for (int k = 0; k < count; ++k)
    dem::addParticle(p, {0.08 + 0.09 * (k % 6), 0.09 + 0.09 * (k / 6), 0.032 + 0.001 * (k % 3)},
                     {0.2 * std::sin(1.0 * k), 0.2 * std::cos(1.3 * k), -0.3}, 0.03 - 0.001 * (k % 4),
                     dem::Density{2000.0});
}

inline std::unique_ptr<CoupledRun> emptyRun() {
  auto run = std::make_unique<CoupledRun>();
  run->grains.laws = frictionalLaws();
  run->grains.gravity = {0.0, 0.0, -9.81};
  return run;
}

/// Everything at once: a layer, a bonded pair, a clump, a wall, insertion, an outlet for those who press on a corner of
/// the block, which is of tetrahedra.
inline std::unique_ptr<CoupledRun> fullRun(const SolidOptions& options) {
  auto run = emptyRun();
  addBlock(*run, options);
  addLayer(*run, 20);
  dem::Model& grains = run->grains;
  const int first = dem::addParticle(grains.particles, {0.2, 0.25, 0.1}, {}, 0.03, dem::Density{2000.0});
  dem::addParticle(grains.particles, {0.26, 0.25, 0.1}, {}, 0.03, dem::Density{2000.0});
  dem::switchOnRotation(grains.particles);
  dem::addBond(dem::bonds(grains), grains.particles, {}, first, first + 1,
               {.youngsModulus = 1e6, .tensileStrength = 1e9, .shearStrength = 1e9});
  const std::vector<Vec3> ends{{-0.02, 0, 0}, {0.02, 0, 0}};
  const std::vector<double> radii{0.03, 0.03};
  dem::addClump(grains, dem::makeClumpShape(ends, radii, {2000.0}), {0.4, 0.4, 0.12}, {}, {0.1, 0.0, -0.5});
  dem::addWall(grains, dem::makePlane({0.02, 0, 0}, {1, 0, 0}));
  dem::addInsertion(grains, {.region = {{0.1, 0.1, 0.2}, {0.5, 0.5, 0.3}},
                             .sizes = dem::UniformSizes{0.02, 0.03},
                             .density = {2000.0},
                             .velocity = {0.0, 0.0, -1.0},
                             .numberPerSecond = 200.0});
  dem::addOutlet(grains, geometry::Box{{0.0, 0.3, -0.1}, {0.2, 0.6, 0.0295}});
  grains.pairs.setSkin(0.004);
  grains.sortEvery = 1;
  return run;
}

struct Case {
  const char* name;
  Stepping stepping;
  int K;
};
inline void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

inline const auto macroCases =
    testing::Values(Case{"explicit1", Stepping::explicitSteps, 1}, Case{"explicit4", Stepping::explicitSteps, 4},
                    Case{"implicit1", Stepping::implicitSteps, 1}, Case{"implicit4", Stepping::implicitSteps, 4});

}  // namespace dovetail::coupling
