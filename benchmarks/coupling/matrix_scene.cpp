#include "matrix_scene.hpp"

#include <algorithm>
#include <random>
#include <utility>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "dovetail/dem/laws/rolling.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/surface/surface_contact.hpp"

namespace dovetail::coupling_matrix {

namespace {

constexpr double modulus = 1e6, poisson = 0.3, density = 1000.0;  // Pa, –, kg/m³
constexpr double width = 0.3;                                     // of solid and box, m
constexpr double cell = 0.2, overlapDepth = 0.4;                  // of the column, m
constexpr Vec3 gravity{0.0, 0.0, -9.81};

fem::ElementShape shapeOf(Element element) {
  switch (element) {
    case Element::hex20:
      return fem::ElementShape::hex20;
    case Element::tet4:
      return fem::ElementShape::tet4;
    case Element::tet10:
      return fem::ElementShape::tet10;
    default:
      return fem::ElementShape::hex8;
  }
}

/// Stresses grow with the square of lengths where times and densities stay.
std::shared_ptr<const fem::PointMaterial> materialOf(SolidLaw law, double length) {
  const double stress = length * length;
  switch (law) {
    case SolidLaw::neoHookean:
      return fem::pointMaterial(fem::neoHookean(stress * modulus, poisson, density));
    case SolidLaw::j2:
      return pointMaterial(
          fem::J2Plasticity{stress * modulus, poisson, density, fem::linearYield(stress * 1e3, stress * 5e4)});
    case SolidLaw::druckerPrager:
      return pointMaterial(fem::DruckerPrager{stress * modulus, poisson, density, stress * 500.0, 0.4, 0.1});
    default:
      return fem::pointMaterial(fem::Material(fem::StVenantKirchhoff{stress * modulus, poisson, density}));
  }
}

/// @param stiffness  of the normal spring, N/m
std::shared_ptr<const dem::ContactLaws> lawsOf(ContactKind kind, double stiffness, double length) {
  const dem::TangentialSpring sliding{.stiffness = 0.7 * stiffness, .friction = 0.4};
  if (kind == ContactKind::frictional) {
    dem::ContactLaw<dem::LinearSpringDashpot, dem::TangentialSpring> law;
    law.normal = {.stiffness = stiffness, .restitution = 0.7};
    law.tangential = sliding;
    return dem::makeContactLaws(law);
  }
  if (kind == ContactKind::hertzMindlin) {
    dem::HertzMindlinLaw law;
    law.normal = {.effectiveModulus = 30.0 * stiffness / length, .restitution = 0.7};
    law.tangential = {.stiffnessRatio = 0.8, .friction = 0.4};
    return dem::makeContactLaws(law);
  }
  dem::ContactLaw<dem::LinearSpringDashpot, dem::TangentialSpring, dem::RollingAndTwisting> law;
  law.normal = {.stiffness = stiffness, .restitution = 0.7};
  law.tangential = sliding;
  law.rolling = {{.friction = 0.1, .stiffnessRatio = 0.2}, {.friction = 0.1, .stiffnessRatio = 0.1}};
  return dem::makeContactLaws(law);
}

/// Layers from `bottom` up between walls; radii such that some touch from the start. @param d  spacing, m
void addGrains(dem::Model& grains, std::array<int, 3> count, double d, double bottom, double bulk,
               const Placement& at) {
  std::mt19937 random(7);
  const auto drawn = [&](double size) { return size * (2.0 * (static_cast<double>(random()) / 4294967295.0) - 1.0); };
  const double side = 0.5 * (width - count[0] * d);
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i) {
        const Vec3 jitter{drawn(0.005 * d), drawn(0.005 * d), drawn(0.005 * d)};
        const Vec3 x = Vec3{side + (i + 0.5) * d, side + (j + 0.5) * d, bottom + (k + 0.5) * d} + jitter;
        const Vec3 v{drawn(0.3), drawn(0.3), drawn(0.1) - 0.2};
        const double radius = (0.495 + drawn(0.01)) * d;
        dem::addParticle(grains.particles, at.place(x), at.direction(v), at.length * radius, dem::Density{bulk});
      }
  for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}}) {
    const double offset = normal.x + normal.y > 0.0 ? side : width - side;
    const Vec3 point{offset, offset, 0.0};
    dem::addWall(grains, dem::makePlane(at.place(point), rotate(at.turn, normal)));
  }
  grains.gravity = at.direction(gravity);
  grains.pairs.setSkin(0.1 * d * at.length);
}

/// Laid into space; by displacement: in its size only.
fem::SolidMesh meshOf(Element element, std::array<int, 3> cells, Vec3 lower, Vec3 upper, const Placement& at) {
  Placement reference = at;
  if (at.byDisplacement) reference = {.length = at.length};
  fem::SolidMesh mesh = fem::boxOf(shapeOf(element), cells, lower, upper);
  for (Vec3& X : mesh.X) X = reference.place(X);
  return mesh;
}

/// @param fraction  of the solid per node; empty: 1
std::unique_ptr<fem::Model> solidOf(const Case& c, const fem::SolidMesh& mesh, std::vector<double> fraction,
                                    const Placement& at) {
  auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
  const auto formulation = c.element == Element::enhanced ? fem::Formulation::enhanced : fem::Formulation::standard;
  model->add(fem::makeSolid(mesh, materialOf(c.law, at.length),
                            {.formulation = formulation, .name = "elements", .fraction = std::move(fraction)}));
  model->add(fem::gravity(at.direction(gravity)));
  fem::fix(model->nodes, mesh.nodeSets.at("z-"));
  for (std::size_t n = 0; at.byDisplacement && n < mesh.X.size(); ++n)
    model->nodes.u[n] = rotate(at.turn, mesh.X[n]) + at.shift - mesh.X[n];
  return model;
}

coupling::SolidOptions optionsOf(const Case& c) {
  return {.name = "solid",
          .stepping = c.isImplicit() ? coupling::Stepping::implicitSteps : coupling::Stepping::explicitSteps};
}

void makeSurface(coupling::CoupledRun& run, const Case& c, const Placement& at) {
  const double d = 0.07;
  run.grains.laws = lawsOf(c.contact, 2e4 * at.length * at.length * at.length, at.length);
  addGrains(run.grains, {4, 4, 2}, d, -0.002, 2500.0, at);
  const fem::SolidMesh mesh = meshOf(c.element, {2, 2, 1}, {0, 0, -0.15}, {width, width, 0}, at);
  coupling::SolidSide& side = run.addSolid(solidOf(c, mesh, {}, at), optionsOf(c));
  surface::SurfaceCoupler skin(surface::makeSkin(mesh.X, mesh.faceSets.at("z+")));
  run.grains.terms.add(surface::SurfaceContact(side, std::move(skin), run.grains.laws, "surface contacts"));
}

/// Particles' fraction of a node, from the mesh's end within them (z = 0) to their own end.
std::vector<double> weightsOf(const fem::SolidMesh& mesh, const fem::SolidMesh& described) {
  std::vector<double> s;
  for (const Vec3& X : described.X) {
    const double place = -X.z / overlapDepth;
    s.push_back(place > 1.0 + 1e-9 ? arlequin::beyondOverlap : std::clamp(place, 0.0, 1.0));
  }
  std::vector<double> weight = arlequin::nodalWeights(s, {.floor = 0.05});
  arlequin::levelMidNodes(mesh, weight);
  return weight;
}

void makeOverlap(coupling::CoupledRun& run, const Case& c, const Placement& at) {
  const double d = 0.1;
  run.grains.laws = lawsOf(c.contact, 1e5 * at.length * at.length * at.length, at.length);
  addGrains(run.grains, {3, 3, 6}, d, -overlapDepth, density / 0.5, at);
  const Vec3 lower{0, 0, -overlapDepth - cell}, upper{width, width, 0};
  const fem::SolidMesh mesh = meshOf(c.element, {1, 1, 3}, lower, upper, at);
  const std::vector<double> weight = weightsOf(mesh, meshOf(c.element, {1, 1, 3}, lower, upper, {}));
  coupling::SolidSide& side = run.addSolid(solidOf(c, mesh, arlequin::solidWeights(weight), at), optionsOf(c));
  arlequin::CouplingOptions options;
  options.constraint =
      c.joint == Joint::penalty ? arlequin::ConstraintKind::penalty : arlequin::ConstraintKind::multiplier;
  run.grains.terms.add(
      std::unique_ptr<dem::Term>(arlequin::makeArlequinCoupling(run.grains, mesh, weight, side, options)));
}

}  // namespace

std::unique_ptr<coupling::CoupledRun> makeScene(const Case& c, const Placement& placement) {
  auto run = std::make_unique<coupling::CoupledRun>();
  (c.joint == Joint::surface ? makeSurface : makeOverlap)(*run, c, placement);
  return run;
}

void startAt(coupling::CoupledRun& run, const Case& c, double fraction) {
  const coupling::RunOptions options{.stepsPerMacroStep = c.stepsPerMacroStep()};
  const bool refuses = std::exchange(run.grains.refusesUnstableSteps, false);
  run.start(1e-9, options);
  const double limit = run.criticalStep().dt;
  run.grains.refusesUnstableSteps = refuses;
  run.start(fraction * limit, options);
}

}  // namespace dovetail::coupling_matrix
