#include "rungs.hpp"

#include <algorithm>

#include "dem/scenes.hpp"
#include "dovetail/arlequin/overlap_tie.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/surface/surface_contact.hpp"

namespace dovetail::atlas {

namespace {

enum RungNumber : std::size_t { bare, booked, frictional, rolling, walled, onPlate, inOverlap };

constexpr double squeezed = 1.005;  // diameter over spacing: all neighbours touch

std::shared_ptr<const dem::ContactLaws> lawsOf(std::size_t rung) {
  const dem::LinearSpringDashpot normal{dem_benchmark::stiffness, rung >= frictional ? 0.5 : 1.0};
  const dem::TangentialSpring tangential{2.0 / 7.0 * dem_benchmark::stiffness, 0.5};
  if (rung < frictional) return dem::makeContactLaws(dem::ElasticLaw{normal});
  if (rung < rolling) return dem::makeContactLaws(dem::FrictionalLaw{normal, tangential});
  dem::ContactLaw<dem::LinearSpringDashpot, dem::TangentialSpring, dem::RollingAndTwisting> law;
  law.normal = normal;
  law.tangential = tangential;
  law.rolling = {{.friction = 0.1, .stiffnessRatio = 0.2}, {.friction = 0.1, .stiffnessRatio = 0.1}};
  return dem::makeContactLaws(law);
}

/// Elastic, as stiff as the lattice, held where `held` says.
std::unique_ptr<fem::Model> solidOf(const fem::SolidMesh& mesh, const char* held, std::vector<double> share) {
  auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
  const auto law = fem::Material(fem::StVenantKirchhoff{dem_benchmark::stiffness, 0.0, 1.0});
  model->add(fem::makeSolid(mesh, fem::pointMaterial(law), {.name = "elements", .share = std::move(share)}));
  fem::fix(model->nodes, mesh.nodeSets.at(held));
  return model;
}

/// A plate of two layers of bricks, two spheres wide each, below the spheres.
void addPlate(coupling::CoupledRun& run, int edge) {
  const double width = edge;
  const fem::SolidMesh mesh = fem::boxOf(fem::CellShape::hex8, {edge / 2, edge / 2, 2}, {0, 0, -4}, {width, width, 0});
  coupling::SolidSide& side = run.addSolid(solidOf(mesh, "z-", {}), {.name = "plate"});
  run.grains.terms.add(surface::SurfaceContact(
      side, surface::Coupling(surface::makeSkin(mesh.X, mesh.faceSets.at("z+"))), run.grains.laws, "on the plate"));
}

/// Bricks, two spheres wide, that share the upper third of the spheres and go on above them.
void addOverlap(coupling::CoupledRun& run, int edge) {
  const double width = edge, top = edge, shared = 2.0 * (edge / 6);
  const int layers = 2 * (edge / 6);
  const fem::SolidMesh mesh = fem::boxOf(fem::CellShape::hex8, {edge / 2, edge / 2, layers}, {0, 0, top - shared},
                                         {width, width, top + 2.0 * layers - shared});
  std::vector<double> place;  // 0 where the mesh ends, 1 where the spheres end
  for (const Vec3& X : mesh.X)
    place.push_back(X.z > top + 1e-9 ? arlequin::beyondOverlap : std::clamp((X.z - top + shared) / shared, 0.0, 1.0));
  const std::vector<double> weight = arlequin::nodalWeights(place, {});
  coupling::SolidSide& side = run.addSolid(solidOf(mesh, "z+", arlequin::solidWeights(weight)), {.name = "far field"});
  run.grains.terms.add(arlequin::makeOverlapTie(run.grains, mesh, weight, side, {}));
}

}  // namespace

const std::vector<Rung>& ladder() {
  static const std::vector<Rung> rungs{{"grains: elastic contacts", "core, geometry, dem, coupling"},
                                       {"+ energies booked", ""},
                                       {"+ friction, spin, dashpots", ""},
                                       {"+ rolling and twisting", ""},
                                       {"+ gravity and two walls", ""},
                                       {"+ a deformable plate (surface coupling)", "fem, cg, surface"},
                                       {"+ a far field of elements (overlap)", "arlequin"}};
  return rungs;
}

std::unique_ptr<coupling::CoupledRun> makeRung(std::size_t rung, int edge) {
  const double size = edge;
  auto run = std::make_unique<coupling::CoupledRun>(
      dem_benchmark::makeModel(dem_benchmark::lattice(edge, edge, edge, squeezed), lawsOf(rung),
                               {{{0, 0, 0}, {size, size, size}}, {true, true, false}}, {}));
  if (rung >= booked) run->grains.booking = dem::Booking::on;
  if (rung >= walled) {
    run->grains.gravity = {0, 0, -1e-3};
    if (rung < onPlate) dem::addWall(run->grains, dem::makePlane({0, 0, 0}, {0, 0, 1}));
    if (rung < inOverlap) dem::addWall(run->grains, dem::makePlane({0, 0, size}, {0, 0, -1}));
  }
  if (rung >= onPlate) addPlate(*run, edge);
  if (rung >= inOverlap) addOverlap(*run, edge);
  return run;
}

}  // namespace dovetail::atlas
