#include "model.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "dovetail/arlequin/critical_step.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "step_plan.hpp"

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

void excite(const Settings& s, arlequin::Model& model) {
  if (s.signal == Signal::cosine) {
    model.discrete.terms.add(raisedCosine(s));
    return;
  }
  for (const std::int64_t i : layerOf(s, 0))
    model.discrete.particles.v[static_cast<std::size_t>(i)].y = s.amplitude * Case{}.velocity * s.particlesPerEdge;
}

arlequin::Model makeParticles(const Settings& s, double length) {
  arlequin::Model model;
  model.discrete.particles = makeLattice(s, length);
  model.discrete.pairs.setSkin(0.1 * particleDiameter(s));
  dem::findPairs(model.discrete.particles, model.discrete.pairs);
  dem::ElasticLaw law;
  law.normal.stiffness = Case{}.youngsModulus * particleDiameter(s);
  law.normal.bonded = s.tension;
  model.discrete.laws = dem::makeContactLaws(law);
  model.discrete.sortEvery = 0;
  model.discrete.refusesUnstableSteps = false;  // arlequin::criticalStep knows the whole
  excite(s, model);
  return model;
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
  const auto profile = s.weightProfile == WeightProfile::linear   ? arlequin::WeightProfile::linear
                       : s.weightProfile == WeightProfile::smooth ? arlequin::WeightProfile::smooth
                                                                  : arlequin::WeightProfile::halfCosine;
  return arlequin::nodalWeights(place, {profile, s.weightFloor});
}

double massShare(const Settings& s) {
  switch (s.mass) {
    case Mass::lumped:
      return 0.0;
    case Mass::consistent:
      return 1.0;
    case Mass::matched:
      return fem::matchedShare(particleDiameter(s), Case{}.elementSize);
  }
  return 0.0;
}

fem::Material makeMaterial(const Settings& s) {
  const double young = Case{}.youngsModulus * s.stiffnessRatio, density = bulkDensity() * s.densityRatio;
  if (s.material == Material::springs) return fem::AxialSprings{young, density};
  return fem::StVenantKirchhoff{young, Case{}.poissonRatio, density};
}

arlequin::Solid makeSolid(const Settings& s, const std::vector<double>& weight) {
  const fem::SolidMesh mesh = makeMesh(s);
  auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
  fem::fix(model->nodes, fem::nodeSet(mesh, "y+"));
  model->add(fem::makeSolid(mesh, fem::pointMaterial(makeMaterial(s)), {.share = arlequin::solidWeights(weight)}));
  return {mesh, std::move(model), massShare(s)};
}

arlequin::CouplingOptions couplingOptions(const Settings& s) {
  arlequin::CouplingOptions o;
  o.form = s.gap == Gap::nodal ? arlequin::GapForm::nodal : arlequin::GapForm::atParticles;
  o.projection = {s.cgWidth * Case{}.elementSize,
                  s.kernel == Kernel::gauss ? cg::KernelShape::gauss : cg::KernelShape::lucy,
                  s.normaliseKernels,
                  s.rows == Rows::perElement,
                  s.kernelReach == KernelReach::outside,
                  s.rows == Rows::perElement ? 1 : 0};
  o.constraint = static_cast<arlequin::ConstraintKind>(s.constraint);
  o.penalty = s.penalty;
  if (s.constraint == Constraint::dashpot && s.penalty == 0.0) o.penalty = publishedPenalty(s.particlesPerEdge);
  o.consistentDashpot = s.dashpotMatrix == DashpotMatrix::consistent;
  o.absorberRate = s.absorber * waveSpeed() / Case{}.elementSize;
  return o;
}

}  // namespace

arlequin::Model makeCoupledBar(const Settings& s) {
  arlequin::Model model = makeParticles(s, s.demLength);
  const std::vector<double> weight = makeWeights(s, makeMesh(s));
  model.solid.emplace(makeSolid(s, weight));
  model.coupling.emplace(
      arlequin::makeCoupling(model.discrete.particles, model.discrete.pairs, *model.solid, weight, couplingOptions(s)));
  return model;
}

arlequin::Model makeParticleBar(const Settings& s) {
  const int count = layers(s, barLength(s));
  // The last layer is the wall: held, and tied by bonds of twice the stiffness, it fixes the point midway.
  arlequin::Model model = makeParticles(s, barLength(s) + particleDiameter(s));
  const std::vector<std::int64_t> held = layerOf(s, count);
  const auto nothing = [](double) { return Vec3{}; };
  dem::PairList& pairs = model.discrete.pairs;
  const std::span<double> factors = pairs.writeFactors();
  for (std::size_t p = 0; p < pairs.size(); ++p)
    factors[p] = pairs.pairs()[p][1] >= held.front() && pairs.pairs()[p][0] < held.front() ? 2.0 : 1.0;
  model.discrete.terms.add(dem::DriveTerm(held, nothing, nothing));
  return model;
}

double penaltyOf(const Settings& s) {
  if (s.penalty > 0.0) return s.penalty;
  if (s.constraint == Constraint::dashpot) return publishedPenalty(s.particlesPerEdge);
  return arlequin::automaticPenalty(Case{}.youngsModulus * s.stiffnessRatio, Case{}.elementSize);
}

arlequin::Model makeBar(const Settings& s, double& penalty) {
  if (s.fullDem) return makeParticleBar(s);
  Settings used = s;
  used.penalty = penalty;
  arlequin::Model model = makeCoupledBar(used);
  const bool stores = s.constraint == Constraint::penalty;
  if (s.femEvery == 1 || s.penalty > 0.0 || !stores) return model;
  const double critical = arlequin::criticalStep(model).together;
  const double dt = requestedStep(s, critical);
  const double most = (s.fem == FemStepper::newmark ? 0.9 : 0.45 * std::numbers::pi) * critical;
  if (s.femEvery * dt <= most) return model;
  used.penalty = penalty *= std::pow(most / (s.femEvery * dt), 2);
  return makeCoupledBar(used);
}

fem::ImplicitMotion makeNewmark(const Settings& s, arlequin::Model& model) {
  return fem::ImplicitMotion(model.solid->model(),
                             {.scheme = fem::newmark(), .massShare = massShare(s), .relativeTolerance = 1e-10});
}

}  // namespace dovetail::wave
