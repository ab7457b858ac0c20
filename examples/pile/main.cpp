// Grains are poured into a box whose floor is clay: it yields under them. The run is stopped half-way and goes on from
// its state in another run, with the same digits.
#include <iostream>

#include "common/options.hpp"
#include "common/report.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/laws/rolling.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/streams.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/surface/surface_contact.hpp"

using namespace dovetail;

constexpr double width = 0.4, depth = 0.1, radius = 0.02, density = 2500.0;  // m, m, m, kg/m³

std::unique_ptr<coupling::CoupledRun> makeScene() {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {10, 10, 2}, {0, 0, -depth}, {width, width, 0});
  auto clay = std::make_unique<fem::Model>(fem::makeModel(mesh));
  const fem::J2Plasticity law{2e6, 0.4, 1800.0, fem::linearYield(4e3, 2e4)};
  // Plastic flow keeps the volume: plain bricks would lock.
  clay->add(
      fem::makeSolid(mesh, pointMaterial(law), {.formulation = fem::Formulation::meanDilatation, .name = "bricks"}));
  for (const char* side : {"x-", "x+", "y-", "y+", "z-"}) fem::fix(clay->nodes, mesh.nodeSets.at(side));

  dem::ContactLaw<dem::LinearSpringDashpot, dem::TangentialSpring, dem::RollingAndTwisting> contact;
  contact.normal = {.stiffness = 3e4, .restitution = 0.5};
  contact.tangential = {.stiffness = 2e4, .friction = 0.5};
  contact.rolling = {{.friction = 0.1, .stiffnessRatio = 0.2}, {.friction = 0.1, .stiffnessRatio = 0.1}};
  auto run = std::make_unique<coupling::CoupledRun>();
  dem::Model& grains = run->grains;
  grains.laws = dem::makeContactLaws(contact);
  grains.gravity = {0.0, 0.0, -9.81};
  for (const auto& [point, inwards] : {std::pair{Vec3{}, Vec3{1, 0, 0}},
                                       {Vec3{}, Vec3{0, 1, 0}},
                                       {Vec3{width, width, 0}, Vec3{-1, 0, 0}},
                                       {Vec3{width, width, 0}, Vec3{0, -1, 0}}})
    dem::addWall(grains, dem::makePlane(point, inwards));
  dem::addInsertion(grains, {.region = {{0.1, 0.1, 0.3}, {0.3, 0.3, 0.5}},
                             .sizes = dem::UniformSizes{0.8 * radius, 1.2 * radius},
                             .density = {density},
                             .velocity = {0.0, 0.0, -1.0},
                             .numberPerSecond = 150.0});
  const std::vector<Vec3> ends{{-0.02, 0, 0}, {0.02, 0, 0}};
  const std::vector<double> radii{0.03, 0.03};
  dem::addClump(grains, dem::makeClumpShape(ends, radii, {density}), {0.5 * width, 0.5 * width, 0.1});

  coupling::SolidSide& floor = run->addSolid(std::move(clay), {.name = "clay"});
  grains.terms.add(surface::SurfaceContact(floor,
                                           surface::SurfaceCoupler(surface::makeSkin(mesh.X, mesh.faceSets.at("z+"))),
                                           grains.laws, "grains on the clay"));
  return run;
}

bool run(const example::Options& options) {
  const auto first = makeScene(), second = makeScene();
  const std::int64_t half = options.quick ? 1000 : 4000;
  for (auto* scene : {first.get(), second.get()}) scene->start(1e-4, {.stepsPerMacroStep = 2});
  first->advance(half);
  second->load(first->save());
  for (auto* scene : {first.get(), second.get()}) scene->advance(half);
  const bool same = first->save() == second->save();
  coupling::report(*second, std::cout);
  std::cout << "restarted: " << (same ? "the same digits\n" : "OTHER digits\n");
  const EnergyLedger& ledger = second->ledger();
  if (!options.out.empty())
    example::writeParticles(options.out, "pile", second->time(), second->grains.particles, io::provenance({}));
  return same && std::abs(ledger.residual()) < -1e-3 * ledger.joules("particles: entered (minus)");
}

int main(int argc, char** argv) {
  return example::runExample(argc, argv, "pile", "Grains are poured onto clay, which yields under them.", run);
}
