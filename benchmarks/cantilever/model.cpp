#include "model.hpp"

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/motion/stable_step.hpp"

namespace dovetail::cantilever {

namespace {

constexpr Vec3 lowerCorner{-0.4, 0.0, -0.4}, upperCorner{0.4, 12.0, 0.4};

double contactStiffness(const Settings& settings) {
  const Case beam;
  return settings.stiffnessRatio * beam.youngsModulus * beam.particleDiameter;
}

dem::Particles makeParticles(const Settings& settings) {
  const Case beam;
  const double radius = 0.5 * beam.particleDiameter;
  const double overlap = particleMass(beam) * beam.gravity / contactStiffness(settings);
  if (overlap >= radius)
    throw InputError("the particles sink by " + formatNumber(overlap) + " m under their own weight",
                     "--stiffness-ratio",
                     "give at least " + formatNumber(2.0 * overlap / radius * settings.stiffnessRatio));
  dem::Particles particles;
  for (double x : {beam.startX, -beam.startX})
    dem::addParticle(particles, {x, beam.startY, 0.5 * beam.side + radius - overlap}, {0.0, beam.startVelocity, 0.0},
                     radius, dem::Density{beam.particleDensity});
  return particles;
}

fem::Material makeMaterial(const Settings& settings) {
  const Case beam;
  if (settings.metric == Metric::deformed)
    return fem::DeformedMetricHooke{beam.youngsModulus, beam.poissonRatio, beam.density};
  return fem::StVenantKirchhoff{beam.youngsModulus, beam.poissonRatio, beam.density};
}

cg::SurfaceKernel makeKernel(const Settings& settings) {
  return {{settings.kernel, 2, settings.cgWidth * Case{}.particleDiameter}, settings.correction};
}

surface::Skin makeCarryingSkin(const Settings& settings, const fem::SolidMesh& mesh) {
  surface::Skin skin = surface::makeSkin(mesh.X, mesh.faceSets.at("skin"));
  if (settings.transfer == Transfer::adjoint) surface::coarseGrain(skin, makeKernel(settings));
  return skin;
}

surface::Coupling makeSeam(const Settings& settings, const fem::SolidMesh& mesh) {
  surface::Coupling seam(makeCarryingSkin(settings, mesh), {.edges = settings.edges});
  if (settings.transfer == Transfer::spread)
    seam.spreadLoad(surface::SpreadLoad(makeKernel(settings), mesh.X, seam.skin(), mesh.faceSets.at("skin")));
  seam.bookWallWork(couplingIsUnbalanced(settings));
  return seam;
}

surface::Coupling makeSmoothSeam(const Settings& settings, const fem::SolidMesh& mesh) {
  surface::Skin skin = makeCarryingSkin(settings, mesh);
  if (settings.cgWidth == 0.0) surface::splitAtSharpEdges(skin);
  surface::Coupling seam(surface::makeSmoothSurface(skin));
  seam.bookWallWork(couplingIsUnbalanced(settings));
  return seam;
}

std::unique_ptr<fem::Model> makeBeam(const Settings& settings, const fem::SolidMesh& mesh) {
  const bool hybrid = settings.element == "hybrid8";
  auto beam = std::make_unique<fem::Model>(fem::makeModel(mesh));
  beam->add(fem::makeSolid(
      mesh, fem::pointMaterial(makeMaterial(settings)),
      {.formulation = hybrid ? fem::Formulation::assumedStress : fem::Formulation::standard, .name = "beam"}));
  fem::addMass(*beam);
  fem::fix(beam->nodes, mesh.nodeSets.at("y-"));
  return beam;
}

std::vector<double> inverseMasses(const fem::Nodes& nodes) {
  std::vector<double> inverse(nodes.mass.size(), 0.0);
  for (std::size_t i = 0; i < inverse.size(); ++i)
    if (nodes.fixed[i] != fem::allComponents) inverse[i] = 1.0 / nodes.mass[i];
  return inverse;
}

}  // namespace

std::array<int, 3> elementCounts(const Settings& settings) {
  std::array<int, 3> counts = settings.mesh.value_or(Case{}.elements);
  for (int& count : counts) count *= settings.refine;
  return counts;
}

fem::SolidMesh makeMesh(const Settings& settings) {
  return fem::boxOf(fem::CellShape::hex8, elementCounts(settings), lowerCorner, upperCorner);
}

Scene makeScene(const Settings& settings, const fem::SolidMesh& mesh) {
  const auto laws = dem::makeContactLaws(
      dem::ElasticLaw{dem::LinearSpringDashpot{contactStiffness(settings), settings.restitution, true}});
  Scene scene{.run = std::make_unique<coupling::CoupledRun>()};
  dem::Model& grains = scene.run->grains;
  grains.particles = makeParticles(settings);
  grains.laws = laws;
  grains.gravity = {0.0, 0.0, -Case{}.gravity};
  grains.pairs.setSkin(0.5 * Case{}.particleDiameter);
  grains.sortEvery = 0;                 // particle 0 is the one in the tables
  grains.refusesUnstableSteps = false;  // chooseStep refuses them, wherever on the skin the particles will be
  const bool implicit = settings.fem == FemStepper::newmark;
  scene.beam = &scene.run->addSolid(
      makeBeam(settings, mesh),
      {.name = "beam",
       .stepping = implicit ? coupling::Stepping::implicitSteps : coupling::Stepping::explicitSteps,
       .massShare = settings.mass == MassMatrix::consistent ? 1.0 : 0.0});
  const bool smooth = settings.surface == Surface::smooth;
  scene.contact = &scene.run->grains.terms.add(surface::SurfaceContact(
      *scene.beam, smooth ? makeSmoothSeam(settings, mesh) : makeSeam(settings, mesh), laws, "contacts on the beam"));
  return scene;
}

double largestMobility(const Scene& scene) {
  return scene.contact->coupling().largestMobility(inverseMasses(scene.beam->nodes()));
}

StepLimit criticalStep(const Settings& settings, fem::Model& beam, double mobility) {
  const double contact = std::sqrt(contactStiffness(settings) * (1.0 / particleMass(Case{}) + mobility));
  if (settings.fem == FemStepper::newmark) return {2.0 / contact, "contact of a particle with the skin"};
  const fem::ModelStableStep solid = fem::stableStep(beam);
  const double element = 2.0 / solid.dt;
  const std::string name = "element " + std::to_string(solid.element);
  const int K = settings.femEvery;
  if (K == 1) return {2.0 / std::hypot(contact, element), name + " with a contact on it"};
  if (2.0 / contact < solid.dt / K) return {2.0 / contact, "contact of a particle with the skin"};
  return {solid.dt / K, name + " (stepped every " + std::to_string(K) + ")"};
}

double chooseStep(const Settings& settings, const StepLimit& limit) {
  if (settings.dtAuto) return 0.9 * limit.dt;
  if (settings.dtCapped && !settings.shareOfCritical)
    return std::min(settings.dtFactor * contactTime(Case{}), limit.dt / 3.0);
  const double dt =
      settings.shareOfCritical ? *settings.shareOfCritical * limit.dt : settings.dtFactor * contactTime(Case{});
  if (dt > limit.dt && !settings.beyondCritical)
    throw InputError(
        "the time step " + formatNumber(dt) + " s is above the critical step " + formatNumber(limit.dt) +
            " s, set by " + limit.setter,
        "--dt-factor " + formatNumber(dt / contactTime(Case{})),
        "give at most " + formatNumber(std::floor(1e4 * limit.dt / contactTime(Case{})) / 1e4) + ", or --dt auto");
  return dt;
}

void requireFeasible(const Settings& settings, double dt) {
  constexpr double mostSteps = 1e10;
  const double steps = settings.until.value_or(longestRun) / dt;
  if (steps > mostSteps)
    throw InputError("up to " + formatNumber(std::round(steps)) + " steps are too many", "--until and the time step",
                     "give a softer contact (--stiffness-ratio), a larger step (--dt-factor) or an earlier end");
}

BeamCase beamCase(const Settings& settings) {
  BeamCase beam;
  beam.contactStiffness = contactStiffness(settings);
  return beam;
}

double lockingFactor(const Settings& settings) {
  if (settings.element != "hex8") return 1.0;
  const auto counts = elementCounts(settings);
  const double hy = Case{}.length / counts[1], hz = Case{}.side / counts[2];
  return 1.0 + hy * hy / (hz * hz) / (2.0 * counts[2] * counts[2]);
}

}  // namespace dovetail::cantilever
