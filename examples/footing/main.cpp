// A plate is pushed into a bed of grains whose lower part hands over to a continuum: contacts on a surface and an
// overlap in one run. The run is stopped half-way and goes on from its state in another run, with the same digits.
#include <cmath>
#include <iostream>

#include "common/options.hpp"
#include "common/report.hpp"
#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/laws/rolling.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "dovetail/dem/setup/streams.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/surface/surface_contact.hpp"

using namespace dovetail;

constexpr double width = 0.24, top = 0.14, overlap = 0.06, depth = 0.18;  // m; grains begin at z = 0
constexpr double radius = 0.01, density = 2500.0, solidFraction = 0.56;   // m, kg/m³
constexpr double gap = 0.01, speed = 0.15;                                // of the plate above the grains, m; m/s

void addGrains(dem::Model& grains) {
  dem::ContactLaw<dem::LinearSpringDashpot, dem::TangentialSpring, dem::RollingAndTwisting> contact;
  contact.normal = {.stiffness = 5e4, .restitution = 0.4};
  contact.tangential = {.stiffness = 4e4, .friction = 0.5};
  contact.rolling = {{.friction = 0.1, .stiffnessRatio = 0.2}, {.friction = 0.1, .stiffnessRatio = 0.1}};
  grains.laws = dem::makeContactLaws(contact);
  grains.gravity = {0.0, 0.0, -9.81};
  const dem::UniformSizes sizes{0.8 * radius, 1.2 * radius};
  dem::PackingReport report;
  dem::addPacking(grains.particles,
                  dem::growPacking(sizes, {{{0, 0, 0}, {width, width, top}}, {}},
                                   {.solidFraction = solidFraction, .overlap = 1e-4}, report),
                  {density});
  for (const auto& [point, inwards] : {std::pair{Vec3{}, Vec3{1, 0, 0}},
                                       {Vec3{}, Vec3{0, 1, 0}},
                                       {Vec3{width, width, 0}, Vec3{-1, 0, 0}},
                                       {Vec3{width, width, 0}, Vec3{0, -1, 0}}})
    dem::addWall(grains, dem::makePlane(point, inwards));
  const std::vector<Vec3> ends{{-radius, 0, 0}, {radius, 0, 0}};
  const std::vector<double> radii{1.2 * radius, 1.2 * radius};
  dem::addClump(grains, dem::makeClumpShape(ends, radii, {density}), {0.03, 0.5 * width, top + 2.0 * radius});
  dem::addInsertion(grains, {.region = {{0.2, 0.02, 0.2}, {0.235, 0.22, 0.25}},
                             .sizes = sizes,
                             .density = {density},
                             .numberPerSecond = 200.0});
}

/// Soil below the grains, w = 1 at its upper border and 0 at the lower border of the grains.
void addSoil(coupling::CoupledRun& run) {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {6, 6, 8}, {0, 0, -depth}, {width, width, overlap});
  std::vector<double> place;
  for (const Vec3& X : mesh.X)
    place.push_back(X.z < -1e-9 ? arlequin::beyondOverlap : std::clamp(1.0 - X.z / overlap, 0.0, 1.0));
  const std::vector<double> weight = arlequin::nodalWeights(place, {});
  auto soil = std::make_unique<fem::Model>(fem::makeModel(mesh));
  soil->add(fem::makeSolid(mesh, pointMaterial(fem::DruckerPrager{2e6, 0.25, solidFraction * density, 500.0, 0.5, 0.1}),
                           {.name = "bricks", .fraction = arlequin::solidWeights(weight)}));
  soil->add(fem::gravity(run.grains.gravity));
  for (const auto& [side, components] : {std::pair{"x-", fem::componentX},
                                         {"x+", fem::componentX},
                                         {"y-", fem::componentY},
                                         {"y+", fem::componentY},
                                         {"z-", fem::allComponents}})
    fem::fix(soil->nodes, mesh.nodeSets.at(side), components);
  coupling::SolidSide& side = run.addSolid(std::move(soil), {.name = "soil"});
  run.grains.terms.add(arlequin::makeArlequinCoupling(run.grains, mesh, weight, side, {}));
}

void addPlate(coupling::CoupledRun& run) {
  const fem::SolidMesh mesh =
      fem::boxOf(fem::ElementShape::tet10, {4, 4, 1}, {0.06, 0.06, top + gap}, {0.18, 0.18, top + gap + 0.02});
  auto plate = std::make_unique<fem::Model>(fem::makeModel(mesh));
  plate->add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(1e7, 0.3, 1200.0)), {.name = "tetrahedra"}));
  fem::fix(plate->nodes, mesh.nodeSets.at("z+"));
  for (Vec3& v : plate->nodes.v) v = {0.0, 0.0, -speed};
  coupling::SolidSide& side = run.addSolid(std::move(plate), {.name = "plate"});
  run.grains.terms.add(
      surface::SurfaceContact(side, surface::SurfaceCoupler(surface::makeSkin(mesh.X, mesh.faceSets.at("skin"))),
                              run.grains.laws, "grains on the plate"));
}

std::unique_ptr<coupling::CoupledRun> makeScene() {
  auto run = std::make_unique<coupling::CoupledRun>();
  addGrains(run->grains);
  addSoil(*run);
  addPlate(*run);
  return run;
}

/// N, upwards on the plate.
double loadOnPlate(const coupling::CoupledRun& run) {
  double force = 0.0;
  for (const auto* contacts : run.grains.terms.all<surface::SurfaceContact>())
    for (const int node : contacts->coupling().load().touched)
      force += contacts->coupling().load().force[static_cast<std::size_t>(node)].z;
  return force;
}

void write(const std::filesystem::path& folder, const coupling::CoupledRun& run, const io::TimeSeries& series) {
  example::writeParticles(folder, "footing_grains", run.time(), run.grains.particles, io::provenance({}));
  for (std::size_t s = 0; s < run.solids(); ++s) {
    const fem::Nodes& nodes = run.solid(s).nodes();
    example::writeNodes(folder, "footing_" + run.solid(s).name, nodes.X, nodes.u, io::provenance({}));
  }
  io::writeCsv(folder / "footing.csv", series, io::provenance({}));
}

bool run(const example::Options& options) {
  const auto first = makeScene(), second = makeScene();
  const int half = options.quick ? 10 : 200, macroSteps = 40;
  const auto goOn = [&](coupling::CoupledRun& run, io::TimeSeries& series) {
    for (int k = 0; k < half; ++k) {
      run.advance(macroSteps);
      series.append({run.time(), speed * run.time() - gap, loadOnPlate(run)});
    }
  };
  for (auto* scene : {first.get(), second.get()}) scene->start(1.25e-5);
  io::TimeSeries series({"time_s", "depth_m", "load_N"});
  goOn(*first, series);
  second->load(first->save());
  io::TimeSeries again = series;
  goOn(*first, series);
  goOn(*second, again);
  const bool same = first->save() == second->save();
  coupling::report(*second, std::cout);
  std::cout << "load on the plate " << loadOnPlate(*second) << " N\n";
  std::cout << "restarted: " << (same ? "the same digits\n" : "OTHER digits\n");
  const EnergyLedger& ledger = second->ledger();
  if (!options.out.empty()) write(options.out, *second, series);
  const double handedOver =
      std::abs(ledger.joules("plate: supports")) + std::abs(ledger.joules("particles: entered (minus)"));
  return same && std::abs(ledger.residual()) < 1e-3 * handedOver;
}

int main(int argc, char** argv) {
  return example::runExample(argc, argv, "footing", "A plate is pushed into grains whose lower part is a continuum.",
                             run);
}
