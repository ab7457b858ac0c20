// The limit of the step: what all connectors, contacts and solids of a run ask together.
#include <algorithm>
#include <cmath>

#include "dovetail/dem/model/impact.hpp"
#include "run_impl.hpp"

namespace dovetail::coupling {

namespace {

/// The largest vᵀ M_lumped v / vᵀ M v: how much lighter nodes are than their lumped masses. By the power method, which
/// tends to it from below; a tenth is added.
double lightness(const SolidSide& side) {
  if (!side.mass || side.mass->isDiagonal()) return 1.0;
  const std::vector<double>& lumped = side.nodes().mass;
  std::vector<Vec3> x(lumped.size());
  double angle = 0.0;
  for (Vec3& entry : x) entry = {std::cos(angle += 2.4), std::cos(1.3 * angle), std::cos(1.7 * angle)};
  double ratio = 1.0;
  for (int iteration = 0; iteration < 40; ++iteration) {
    double size = 0.0, grown = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) size += lumped[i] * squaredNorm(x[i]);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] *= lumped[i] / std::sqrt(size);
    side.mass->solve(x);
    for (std::size_t i = 0; i < x.size(); ++i) grown += lumped[i] * squaredNorm(x[i]);
    ratio = std::sqrt(grown);
  }
  return 1.1 * std::max(ratio, 1.0);
}

/// The same for a force on the lightest node alone.
double lightnessAlone(const SolidSide& side) {
  if (!side.mass || side.mass->isDiagonal()) return 1.0;
  const fem::Nodes& nodes = side.nodes();
  std::size_t lightest = nodes.mass.size();
  for (std::size_t i = 0; i < nodes.mass.size(); ++i)
    if (nodes.fixed[i] == 0 && (lightest == nodes.mass.size() || nodes.mass[i] < nodes.mass[lightest])) lightest = i;
  if (lightest == nodes.mass.size()) return lightness(side);
  std::vector<Vec3> x(nodes.mass.size());
  x[lightest] = {nodes.mass[lightest], nodes.mass[lightest], nodes.mass[lightest]};
  side.mass->solve(x);
  return std::max({1.0, x[lightest].x, x[lightest].y, x[lightest].z});
}

bool hasElements(const fem::Model& model) {
  return std::ranges::any_of(model.terms, [](const auto& term) { return term->isBody(); });
}

}  // namespace

std::vector<double> SolidSide::inverseMasses(Forces forces) const {
  const double factor = forces == Forces::any ? lightness(*this) : lightnessAlone(*this);
  std::vector<double> inverse(nodes().mass.size(), 0.0);
  for (std::size_t i = 0; i < inverse.size(); ++i)
    if (nodes().fixed[i] != fem::allComponents) inverse[i] = factor / nodes().mass[i];
  return inverse;
}

int SolidSide::addTo(dem::ContactDemand& demand) const {
  const auto known = std::ranges::find(demand.sides, static_cast<const void*>(model), &dem::ContactDemand::Side::of);
  if (known != demand.sides.end()) return static_cast<int>(known - demand.sides.begin());
  const int side = demand.sideOf(model, inverseMasses());
  demand.sides[static_cast<std::size_t>(side)].inMacroSteps = stepping == Stepping::implicitSteps;
  return side;
}

StepLimit CoupledRun::criticalStep() {
  impl_->requireStarted("criticalStep");
  return impl_->criticalStep();
}

linalg::LinearForecast CoupledRun::forecast(std::size_t k) {
  impl_->requireStarted("forecast");
  return impl_->solids.at(k)->forecast();
}

/// Nodes share their mass among all that pulls at them: contacts of every connector, and the solid's own forces.
StepLimit CoupledRun::Impl::limitNow(dem::ContactDemand& demand, bool looksAtElements) {
  StepLimit limit;
  demand.macroStep = K();
  elements.resize(solids.size());
  for (std::size_t s = 0; s < solids.size(); ++s) {
    const SolidSide& side = solids[s]->side;
    if (side.stepping == Stepping::implicitSteps) addOwnForces(side, 0.0, demand);
    if (side.stepping == Stepping::implicitSteps || !hasElements(*side.model)) continue;
    if (looksAtElements || std::isinf(elements[s].dt)) {
      elements[s] = fem::stableStep(*side.model, side.name);
      elements[s].dt /= std::sqrt(lightness(side));
    }
    limit.lower({elements[s].dt / K(), elements[s].owner});
    for (dem::ContactDemand::Side& asked : demand.sides)
      if (asked.of == side.model) asked.ownRate = rateOf(asked.of);
    addOwnForces(side, rateOf(side.model), demand);
  }
  const dem::ContactStep contacts = dem::criticalStep(demand, grains.particles);
  if (contacts.dt < limit.dt) {
    limit.dt = contacts.dt;
    if (!contacts.byOwnForces) limit.owner = contacts.owner;
  }
  return limit;
}

void CoupledRun::Impl::addOwnForces(const SolidSide& side, double rate, dem::ContactDemand& demand) const {
  for (const auto* connector : grains.terms.all<Connector>())
    if (&connector->side() == &side) connector->addOwnForces(demand, rate);
}

/// ω² of a solid's own forces, 1/s²; 0 if it is stepped implicitly.
double CoupledRun::Impl::rateOf(const void* model) const {
  for (std::size_t s = 0; s < solids.size() && s < elements.size(); ++s)
    if (solids[s]->side.model == model) return 4.0 / (elements[s].dt * elements[s].dt);
  return 0.0;
}

/// One per particle; empty if none is part of a solid.
std::vector<dem::SolidPart> CoupledRun::Impl::solidParts() const {
  std::vector<dem::SolidPart> parts;
  int solid = -1;
  for (const auto* connector : grains.terms.all<Connector>()) {
    ++solid;
    if (!connector->placed().empty()) parts.resize(grains.particles.size());
    for (const std::int64_t id : connector->placed())
      if (const int i = dem::find(grains.particles, id); i >= 0)
        parts[static_cast<std::size_t>(i)] = {solid, rateOf(connector->side().model)};
  }
  return parts;
}

StepLimit CoupledRun::Impl::criticalStep() {
  dem::ContactDemand demand = dem::demandOf(grains);
  StepLimit limit = limitNow(demand, true);
  limit.lower(dem::impactLimit(
      grains, demand,
      {.macroStep = K(), .ownRate = [this](const void* model) { return rateOf(model); }, .parts = solidParts()}));
  return limit;
}

void CoupledRun::Impl::lookAtLimit(bool failed) {
  const std::int64_t number = grains.steps / K();
  if (!grains.refusesUnstableSteps || grains.passed) return;
  dem::ContactDemand demand = dem::demandOf(grains);
  const StepLimit limit = limitNow(demand, !failed && number % (16 * 2048) == 0);
  if (dt > limit.dt) grains.passed = {dt, limit, grains.time};
}

}  // namespace dovetail::coupling
