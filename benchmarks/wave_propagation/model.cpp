#include "model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"

namespace dovetail::wave {

double barLength(const Settings& s) { return s.demLength - s.overlap + solidElements(s) * Case{}.elementSize; }

int particlesPerLayer(const Settings& s) {
  const int across = static_cast<int>(std::lround(Case{}.side / particleDiameter(s)));
  return across * across;
}

int layers(const Settings& s, double length) { return static_cast<int>(std::lround(length / particleDiameter(s))); }

namespace {

dem::Particles makeLattice(const Settings& s, double length) {
  const double d = particleDiameter(s), first = 0.5 * (d - Case{}.side);
  const int across = static_cast<int>(std::lround(Case{}.side / d));
  dem::Particles particles;
  for (int layer = 0; layer < layers(s, length); ++layer)
    for (int k = 0; k < across; ++k)
      for (int i = 0; i < across; ++i)
        dem::addParticle(particles, {first + i * d, (layer + 0.5) * d, first + k * d}, {}, 0.5 * d,
                         dem::Mass{particleMass(s)});
  return particles;
}

/// Ids of the particles, which are their numbers: nothing is sorted.
std::vector<std::int64_t> layerOf(const Settings& s, int layer) {
  std::vector<std::int64_t> numbers;
  for (int i = 0; i < particlesPerLayer(s); ++i) numbers.push_back(layer * particlesPerLayer(s) + i);
  return numbers;
}

/// The raised cosine v = v0 (1 − cos ωt) for its time, then held.
dem::DriveTerm raisedCosine(const Settings& s) {
  const double omega = angularFrequency(s), end = driveTime(s), v0 = s.amplitude * Case{}.cosineVelocity;
  const auto displacement = [=](double t) {
    const double within = std::min(t, end);
    return Vec3{0.0, v0 * (within - std::sin(omega * within) / omega), 0.0};
  };
  const auto velocity = [=](double t) { return Vec3{0.0, t < end ? v0 * (1.0 - std::cos(omega * t)) : 0.0, 0.0}; };
  return {layerOf(s, 0), displacement, velocity};
}

void excite(const Settings& s, dem::Model& grains) {
  if (s.signal == Signal::cosine) {
    grains.terms.add(raisedCosine(s));
    return;
  }
  for (const std::int64_t i : layerOf(s, 0))
    grains.particles.v[static_cast<std::size_t>(i)].y = s.amplitude * Case{}.velocity * s.particlesPerEdge;
}

Bar makeParticles(const Settings& s, double length) {
  Bar bar;
  bar.run = std::make_unique<coupling::CoupledRun>();
  dem::Model& grains = bar.run->grains;
  grains.particles = makeLattice(s, length);
  grains.pairs.setSkin(0.1 * particleDiameter(s));
  dem::findPairs(grains.particles, grains.pairs);
  dem::ElasticLaw law;
  law.normal.stiffness = Case{}.youngsModulus * particleDiameter(s);
  law.normal.bonded = s.tension;
  grains.laws = dem::makeContactLaws(law);
  grains.sortEvery = 0;                 // layers are told by number
  grains.refusesUnstableSteps = false;  // planSteps knows the exact limit
  excite(s, grains);
  return bar;
}

fem::SolidMesh makeMesh(const Settings& s) {
  const double half = 0.5 * Case{}.side, start = s.demLength - s.overlap;
  const int across = static_cast<int>(std::lround(Case{}.side / Case{}.elementSize)), along = solidElements(s);
  return fem::boxOf(fem::CellShape::hex8, {across, along, across}, {-half, start, -half},
                    {half, start + along * Case{}.elementSize, half});
}

/// w per node from the distances to the mesh's end within the particles and to the particles' end within the mesh.
std::vector<double> makeWeights(const Settings& s, const fem::SolidMesh& mesh) {
  const double half = 0.5 * Case{}.side, end = s.demLength;
  const std::array<Vec3, 4> corner = {
      Vec3{-half, end, -half}, {half, end, -half}, {half, end, half}, {-half, end, half}};
  const std::vector<arlequin::Triangle> particleBorder = {{corner[0], corner[1], corner[2]},
                                                          {corner[0], corner[2], corner[3]}};
  std::vector<double> place =
      arlequin::distanceCoordinate(mesh.X, arlequin::triangles(mesh.X, fem::faceSet(mesh, "y-")), particleBorder);
  for (std::size_t n = 0; n < place.size(); ++n)
    if (mesh.X[n].y > end + 1e-9) place[n] = arlequin::beyondOverlap;
  return arlequin::nodalWeights(place, {s.weightProfile, s.weightFloor});
}

double massShare(const Settings& s) {
  if (s.mass == Mass::matched) return fem::matchedShare(particleDiameter(s), Case{}.elementSize);
  return s.mass == Mass::consistent ? 1.0 : 0.0;
}

fem::Material makeMaterial(const Settings& s) {
  const double young = Case{}.youngsModulus * s.stiffnessRatio, density = bulkDensity() * s.densityRatio;
  if (s.material == Material::springs) return fem::AxialSprings{young, density};
  return fem::StVenantKirchhoff{young, Case{}.poissonRatio, density};
}

std::unique_ptr<fem::Model> makeSolid(const Settings& s, const fem::SolidMesh& mesh,
                                      const std::vector<double>& weight) {
  auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
  fem::fix(model->nodes, fem::nodeSet(mesh, "y+"));
  model->add(fem::makeSolid(mesh, fem::pointMaterial(makeMaterial(s)),
                            {.name = "elastic", .share = arlequin::solidWeights(weight)}));
  return model;
}

arlequin::CouplingOptions couplingOptions(const Settings& s) {
  arlequin::CouplingOptions o;
  o.form = s.gap;
  o.projection = {s.cgWidth * Case{}.elementSize,
                  s.kernel,
                  s.normaliseKernels,
                  s.rows == Rows::perElement,
                  s.kernelReach == KernelReach::outside,
                  s.rows == Rows::perElement ? 1 : 0};
  o.constraint = s.constraint;
  o.penalty = s.penalty;
  o.consistentDashpot = s.dashpotMatrix == DashpotMatrix::consistent;
  o.dashpotLags = s.staggered;
  o.leastShare = std::clamp(s.weightFloor, 1e-12, o.leastShare);
  o.absorberRate = s.absorber * waveSpeed() / Case{}.elementSize;
  return o;
}

}  // namespace

Bar makeCoupledBar(const Settings& s) {
  Bar bar = makeParticles(s, s.demLength);
  bar.mesh = makeMesh(s);
  const std::vector<double> weight = makeWeights(s, bar.mesh);
  const bool implicit = s.fem == FemStepper::newmark;
  bar.solid =
      &bar.run->addSolid(makeSolid(s, bar.mesh, weight),
                         {.name = "solid",
                          .stepping = implicit ? coupling::Stepping::implicitSteps : coupling::Stepping::explicitSteps,
                          .massShare = massShare(s)});
  bar.tie = &bar.run->grains.terms.add(
      arlequin::makeOverlapTie(bar.run->grains, bar.mesh, weight, *bar.solid, couplingOptions(s)));
  return bar;
}

Bar makeParticleBar(const Settings& s) {
  const int count = layers(s, barLength(s));
  // The last layer is the wall: held, and tied by bonds of twice the stiffness, it fixes the point midway.
  Bar bar = makeParticles(s, barLength(s) + particleDiameter(s));
  const std::vector<std::int64_t> held = layerOf(s, count);
  const auto nothing = [](double) { return Vec3{}; };
  dem::PairList& pairs = bar.run->grains.pairs;
  const std::span<double> factors = pairs.writeFactors();
  for (std::size_t p = 0; p < pairs.size(); ++p)
    factors[p] = pairs.pairs()[p][1] >= held.front() && pairs.pairs()[p][0] < held.front() ? 2.0 : 1.0;
  bar.run->grains.terms.add(dem::DriveTerm(held, nothing, nothing));
  return bar;
}

arlequin::CriticalStep criticalStep(const Settings& s, const Bar& bar) {
  return arlequin::criticalStep(bar.run->grains, bar.solid, massShare(s), bar.tie);
}

double penaltyOf(const Settings& s) {
  if (s.penalty > 0.0) return s.penalty;
  if (s.constraint == Constraint::dashpot) return publishedPenalty(s.particlesPerEdge);
  return arlequin::automaticPenalty(Case{}.youngsModulus * s.stiffnessRatio, Case{}.elementSize);
}

Bar makeBar(const Settings& s, double& penalty) {
  if (s.fullDem) return makeParticleBar(s);
  Settings used = s;
  used.penalty = penalty;
  Bar bar = makeCoupledBar(used);
  const bool stores = s.constraint == Constraint::penalty;
  if (s.femEvery == 1 || s.penalty > 0.0 || !stores) return bar;
  const double critical = criticalStep(s, bar).together;
  const double dt = requestedStep(s, critical);
  const double most = (s.fem == FemStepper::newmark ? 0.9 : 0.45 * std::numbers::pi) * critical;
  if (s.femEvery * dt <= most) return bar;
  used.penalty = penalty *= std::pow(most / (s.femEvery * dt), 2);
  return makeCoupledBar(used);
}

namespace {

void refuseExplicit(const Settings& s, double dt, const arlequin::CriticalStep& critical) {
  if (dt <= critical.together) return;
  throw InputError(
      "a step of " + formatNumber(dt) + " s is above the critical one, " + formatNumber(critical.together) +
          " s (particles " + formatNumber(critical.particles) + ", solid " + formatNumber(critical.solid) + ")",
      "--dt-factor", "give at most " + formatNumber(0.9 * critical.together / contactTime(s)) + ", or --dt auto");
}

/// With an implicit solid, contacts limit the particles' step. Nodes that move every K dt only would overshoot what a
/// stiff coupling wants.
void refuseImplicit(const Settings& s, double dt, const arlequin::CriticalStep& critical) {
  if (dt > critical.particles)
    throw InputError("a step of " + formatNumber(dt) + " s is above that of the contacts, " +
                         formatNumber(critical.particles) + " s",
                     "--dt-factor", "give at most " + formatNumber(0.9 * critical.particles / contactTime(s)));
  const bool stores = s.constraint == Constraint::penalty;
  if (stores && s.femEvery * dt > critical.together)
    throw InputError("the solid moves every " + formatNumber(s.femEvery * dt) +
                         " s, more than the critical step of the coupling, " + formatNumber(critical.together) + " s",
                     "--penalty", "give a softer one, a smaller --dt-factor or --fem-every, or leave it out");
}

}  // namespace

double requestedStep(const Settings& s, double critical) {
  if (s.dtAuto) return 0.5 * critical;
  return s.shareOfCritical ? *s.shareOfCritical * critical : s.dtFactor * contactTime(s);
}

StepPlan planSteps(const Settings& s, const arlequin::CriticalStep& critical) {
  const double dt = requestedStep(s, critical.together), end = endTime(s);
  const bool implicit = s.fem == FemStepper::newmark && !s.fullDem;
  if (!s.beyondCritical) implicit ? refuseImplicit(s, dt, critical) : refuseExplicit(s, dt, critical);
  if (end / dt > 1e10)
    throw InputError("the run would take " + formatNumber(end / dt) + " steps", "--until and --dt-factor",
                     "give a shorter time or a longer step");
  StepPlan plan;
  plan.stepsPerWindow = s.fullDem ? 1 : s.femEvery;
  plan.windows =
      std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(end / (plan.stepsPerWindow * dt) - 1e-9)));
  plan.dt = end / static_cast<double>(plan.windows * plan.stepsPerWindow);
  return plan;
}

}  // namespace dovetail::wave
