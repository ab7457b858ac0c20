#include "column.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/arlequin/initial_equilibrium.hpp"
#include "dovetail/cg/averages.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "dovetail/dem/setup/relax.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/model/ties.hpp"
#include "dovetail/fem/terms/loads.hpp"

namespace dovetail::disordered_overlap {

namespace {

constexpr double looseFraction = 0.58;   // grains hardly touch
constexpr double denseFraction = 0.645;  // a little more than grains at the pressure fill: to rest is quick there
constexpr double softOverlap = 0.05;     // over the radius, largest, before the pressure is set
constexpr double restitution = 0.5;      // while they come to rest
constexpr double sheared = 2e-4;         // strain by which the lid presses with friction
constexpr double shaken = 5e-5;          // strain to each side while the lid shakes a column down
constexpr int shakes = 8;                // afterwards a shake changes the pressure by 1e-4

std::shared_ptr<const dem::ContactLaws> laws(double e) {
  dem::FrictionalLaw law;
  law.normal = {.stiffness = grain::stiffness, .restitution = e};
  law.tangential = {.stiffness = grain::tangential, .friction = grain::friction};
  return dem::makeContactLaws(law);
}

/// Grains of the packing that have no force on each other but what they get from now on.
dem::Model columnOf(const dem::Packing& packing) {
  dem::Model m;
  dem::addPacking(m.particles, packing, {grain::density});
  m.pairs.setPeriodicity(packing.space);
  m.pairs.setSkin(0.1 * grain::diameter);
  m.laws = laws(restitution);
  m.sortEvery = 0;
  return m;
}

dem::Packing grown(const ColumnSize& size, double solidFraction, double overlap) {
  const geometry::Periodicity space{{{0, 0, 0}, {size.width, size.width, size.height}}, {true, true, false}};
  dem::PackingReport report;
  return dem::growPacking(dem::UniformSizes{0.4 * grain::diameter, 0.6 * grain::diameter}, space,
                          {.solidFraction = solidFraction, .overlap = overlap, .seed = size.seed}, report);
}

void bringToRest(dem::Model& m) {
  const dem::RelaxationReport report = dem::relax(m, {.tolerance = 1e-6, .steps = 100000});
  if (!report.atRest)
    throw NumericalError("the packing does not come to rest: its unbalanced force is " +
                             std::to_string(report.residual) + " of the mean contact force",
                         "column of grains", "take another seed");
}

void addLidAndFloor(dem::Model& m) {
  const auto& box = m.pairs.periodicity().box;
  dem::addWall(m, dem::makePlane(box.upper, {0, 0, -1}));
  dem::addWall(m, dem::makePlane(box.lower, {0, 0, 1}));
}

/// Brings lid and grains closer to the floor in proportion, so that no part is compacted before others.
void shorten(dem::Model& m, double strain) {
  const double floor = dem::primitiveWall(m, floorOfPressed).point.z;
  double& lid = dem::primitiveWall(m, lidOfPressed).point.z;
  lid = floor + (1.0 - strain) * (lid - floor);
  for (Vec3& x : m.particles.x) x.z = floor + (1.0 - strain) * (x.z - floor);
  dem::relax(m, {.tolerance = 1e-3, .steps = 5000});
}

/// Held at its bottom, the same on opposite sides.
std::unique_ptr<fem::Model> heldColumn(const fem::SolidMesh& mesh, const Elastic& e, std::vector<double> weight,
                                       const Vec3& gravity) {
  auto solid = std::make_unique<fem::Model>(fem::makeModel(mesh));
  fem::fix(solid->nodes, fem::nodeSet(mesh, "z-"));
  const auto still = [](double) { return std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}; };
  for (fem::Tie& tie : fem::periodicTies(mesh, still, {true, true, false}).ties)
    if (solid->nodes.fixed[static_cast<std::size_t>(tie.node)] == 0) solid->constraints.ties.push_back(std::move(tie));
  const fem::Material law = fem::StVenantKirchhoff{e.young, e.poisson, e.density};
  solid->add(fem::makeSolid(mesh, fem::pointMaterial(law), {.fraction = std::move(weight)}));
  if (norm(gravity) > 0.0) solid->add(fem::gravity(gravity));
  fem::addMass(*solid);
  return solid;
}

}  // namespace

dem::Model fallenColumn(const ColumnSize& size) {
  dem::Model m = columnOf(grown(size, looseFraction, 1e-3));
  m.gravity = {0, 0, -standardGravity};
  dem::addWall(m, dem::makePlane({0, 0, 0}, {0, 0, 1}));
  bringToRest(m);
  return m;
}

dem::Model pressedColumn(const ColumnSize& size, double pressure) {
  dem::Packing packing = grown(size, denseFraction, softOverlap);
  const dem::PackingReport report =
      dem::compressToPressure(packing, {.stiffness = grain::stiffness, .pressure = pressure, .tolerance = 0.03});
  if (!report.reached)
    throw NumericalError("the packing does not reach its pressure", "column of grains", "take another seed");
  dem::Model m = columnOf(packing);
  addLidAndFloor(m);
  bringToRest(m);
  m.laws = laws(1.0);
  moveLid(m, {0, 0, -sheared * packing.space.length(2)});
  return m;
}

dem::Model columnPressedWithFriction(const ColumnSize& size, double pressure) {
  constexpr int presses = 400;  // strains of a tenth and more, far beyond what it takes
  dem::Model m = columnOf(grown(size, looseFraction, 1e-3));
  addLidAndFloor(m);
  const double wanted = pressure * size.width * size.width;  // N
  const dem::PrimitiveWall& lid = dem::primitiveWall(m, lidOfPressed);
  for (int k = 0; k < presses && lid.force.z < 0.5 * wanted; ++k) shorten(m, 1e-3);
  bringToRest(m);
  m.laws = laws(1.0);
  const double strain = sheared * size.height;
  for (int k = 0; k < presses && lid.force.z < 0.97 * wanted; ++k) moveLid(m, {0, 0, -strain});
  if (std::abs(lid.force.z / wanted - 1.0) > 0.1)
    throw NumericalError("the packing is at " + std::to_string(lid.force.z / wanted) + " of its pressure",
                         "column of grains", "take another seed");
  const double way = shaken * size.height;
  for (int k = 0; k < shakes; ++k)
    for (const Vec3& motion :
         {Vec3{0, 0, way}, {0, 0, -2.0 * way}, {0, 0, way}, {way, 0, 0}, {-2.0 * way, 0, 0}, {way, 0, 0}})
      moveLid(m, motion);
  return m;
}

double widthOf(const dem::Model& column) { return column.pairs.periodicity().length(0); }

void moveLid(dem::Model& m, const Vec3& way) {
  constexpr int steps = 2000;  // several transits of a wave
  dem::PrimitiveWall& lid = dem::primitiveWall(m, lidOfPressed);
  const double dt = 0.6 * dem::criticalStep(m).dt;
  dem::DampingTerm& damping = dem::damping(m);
  damping.local = 0.2;
  lid.velocity = (1.0 / (steps * dt)) * way;
  dem::run(m, dt, steps);
  lid.velocity = {};
  m.terms.remove(damping);
  bringToRest(m);
}

double bulkDensity(const dem::Particles& p, double width, double lower, double upper) {
  // Wide enough for what hangs over the sides.
  const cg::AverageBox box{{-width, -width, lower}, {2.0 * width, 2.0 * width, upper}};
  return 9.0 * grain::density * cg::solidFraction(p.x, p.radius, box);
}

std::unique_ptr<JoinedColumn> joinSolid(const dem::Model& packing, std::size_t floor, const SolidPlace& place,
                                        const Elastic& elastic, const JoinOptions& options) {
  auto column = std::make_unique<JoinedColumn>();
  dem::Model& grains = column->run.grains;
  grains = packing;
  dem::removeWall(grains, dem::primitiveWall(grains, floor));
  column->mesh = fem::boxOf(
      fem::ElementShape::hex8,
      {place.across, place.across, static_cast<int>(std::lround((place.top - place.bottom) / place.element))},
      {0, 0, place.bottom}, {place.width, place.width, place.top});
  const fem::SolidMesh& mesh = column->mesh;
  std::vector<double> s;
  for (const Vec3& X : mesh.X)
    s.push_back(X.z < place.border - 0.01 * place.element ? arlequin::beyondOverlap
                                                          : (place.top - X.z) / (place.top - place.border));
  const std::vector<double> weight = arlequin::nodalWeights(s, options.weights);
  std::unique_ptr<fem::Model> solid = heldColumn(mesh, elastic, arlequin::solidWeights(weight), grains.gravity);
  std::vector<int> below;
  for (std::size_t i = 0; i < grains.particles.size(); ++i)
    if (grains.particles.x[i].z < place.border) below.push_back(static_cast<int>(i));
  dem::removeParticles(grains, below);
  if (options.initialEquilibrium) column->rounds = arlequin::initialEquilibrium(grains, mesh, *solid, weight);
  coupling::SolidSide& side = column->run.addSolid(std::move(solid), {.massFraction = options.massFraction});
  auto tie = arlequin::makeArlequinCoupling(grains, mesh, weight, side, options.coupling);
  column->tie = tie.get();
  grains.terms.add(std::unique_ptr<dem::Term>(std::move(tie)));
  return column;
}

void startWith(coupling::CoupledRun& run, double fractionOfCritical) {
  run.start(1e-3 * run.limitAtStart().dt);
  run.start(fractionOfCritical * run.criticalStep().dt);
}

}  // namespace dovetail::disordered_overlap
