// A scene is the program that its author would have written.
#include <gtest/gtest.h>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/scene/build.hpp"
#include "dovetail/scene/read.hpp"
#include "dovetail/surface/surface_contact.hpp"

namespace dovetail::scene {
namespace {

const char* const text = R"({
  "gravity": [0, 0, -9.81],
  "contact": {"law": "linear", "stiffness": 5e4, "tangential_stiffness": 4e4, "restitution": 0.4, "friction": 0.5},
  "particles": [{"from": "packing", "box": [[0, 0, 0], [0.12, 0.12, 0.1]], "radius": {"smallest": 0.008, "largest": 0.012},
                 "solid_fraction": 0.5, "overlap": 1e-4, "density": 2500}],
  "walls": [{"shape": "box", "box": [[0, 0, 0], [0.12, 0.12, 1]], "open": ["z-", "z+"]}],
  "solids": [
    {"name": "soil", "mesh": "box", "cells": [3, 3, 4], "box": [[0, 0, -0.06], [0.12, 0.12, 0.06]],
     "material": {"law": "neo-Hookean", "youngs_modulus": 2e6, "poisson_ratio": 0.25, "density": 1250},
     "supports": [{"on": "z-"}, {"on": "x-", "components": ["x"]}]},
    {"name": "plate", "mesh": "box", "cell": "tet10", "cells": [2, 2, 1], "box": [[0.02, 0.02, 0.101], [0.1, 0.1, 0.12]],
     "material": {"law": "St-Venant-Kirchhoff", "youngs_modulus": 1e7, "poisson_ratio": 0.3, "density": 1200},
     "gravity": false, "velocity": [0, 0, -1], "supports": [{"on": "z+", "velocity": [0, 0, -1]}]}
  ],
  "couplings": [
    {"type": "overlap", "solid": "soil", "solid_border": 0.06, "particle_border": 0},
    {"type": "surface", "solid": "plate", "kernel": 0.02}
  ],
  "steps": {"dt": 1e-5},
  "stages": [{"do": "run", "time": 1e-3}]
})";

void addSoil(coupling::CoupledRun& run) {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {3, 3, 4}, {0, 0, -0.06}, {0.12, 0.12, 0.06});
  std::vector<double> place;
  for (const Vec3& X : mesh.X)
    place.push_back(X.z < -1e-9 ? arlequin::beyondOverlap : std::clamp(1.0 - X.z / 0.06, 0.0, 1.0));
  const std::vector<double> weight = arlequin::nodalWeights(place, {});
  auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
  model->add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(2e6, 0.25, 1250.0)),
                            {.fraction = arlequin::solidWeights(weight)}));
  model->add(fem::gravity({0, 0, -9.81}));
  fem::fix(model->nodes, mesh.nodeSets.at("z-"));
  fem::fix(model->nodes, mesh.nodeSets.at("x-"), fem::componentX);
  coupling::SolidSide& side = run.addSolid(std::move(model), {.name = "soil"});
  run.grains.terms.add(arlequin::makeArlequinCoupling(run.grains, mesh, weight, side, {}));
}

void addPlate(coupling::CoupledRun& run) {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::tet10, {2, 2, 1}, {0.02, 0.02, 0.101}, {0.1, 0.1, 0.12});
  auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
  model->add(fem::makeSolid(mesh, fem::pointMaterial(fem::StVenantKirchhoff{1e7, 0.3, 1200.0})));
  fem::fix(model->nodes, mesh.nodeSets.at("z+"));
  for (Vec3& v : model->nodes.v) v = {0, 0, -1};
  coupling::SolidSide& side = run.addSolid(std::move(model), {.name = "plate"});
  surface::Skin skin = surface::makeSkin(mesh.X, mesh.faceSets.at("skin"));
  surface::coarseGrain(skin, {{.width = 0.02}, cg::KernelCorrection::symmetric});
  run.grains.terms.add(surface::SurfaceContact(side, surface::SurfaceCoupler(std::move(skin)), run.grains.laws));
}

TEST(SceneDigits, ASceneHasThoseOfTheProgram) {
  const Scene scene = sceneFromText(text, "s.json", "/");
  Built built = build(scene);
  start(built, scene);

  coupling::CoupledRun run;
  run.grains.laws = dem::makeContactLaws(
      dem::FrictionalLaw{{.stiffness = 5e4, .restitution = 0.4}, {.stiffness = 4e4, .friction = 0.5}});
  run.grains.gravity = {0, 0, -9.81};
  dem::PackingReport report;
  dem::addPacking(run.grains.particles,
                  dem::growPacking(dem::UniformSizes{0.008, 0.012}, {{{0, 0, 0}, {0.12, 0.12, 0.1}}, {}},
                                   {.solidFraction = 0.5, .overlap = 1e-4}, report),
                  {2500.0});
  for (const auto& [point, inwards] : {std::pair{Vec3{}, Vec3{1, 0, 0}},
                                       {Vec3{}, Vec3{0, 1, 0}},
                                       {Vec3{0.12, 0.12, 0}, Vec3{-1, 0, 0}},
                                       {Vec3{0.12, 0.12, 0}, Vec3{0, -1, 0}}})
    dem::addWall(run.grains, dem::makePlane(point, inwards));
  addSoil(run);
  addPlate(run);
  run.start(1e-5);
  for (coupling::CoupledRun* const one : {built.run.get(), &run}) one->advance(400);

  ASSERT_GT(run.grains.particles.size(), 50U);
  EXPECT_EQ(built.run->grains.particles.x, run.grains.particles.x);
  EXPECT_EQ(built.run->grains.particles.v, run.grains.particles.v);
  for (std::size_t s = 0; s < 2; ++s) EXPECT_EQ(built.run->solid(s).nodes().u, run.solid(s).nodes().u) << s;
  EXPECT_NE(run.ledger().joules("particles: friction"), 0.0);
  EXPECT_GT(run.ledger().joules("plate: elastic"), 0.0);
}

}  // namespace
}  // namespace dovetail::scene
