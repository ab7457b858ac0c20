#include "solid_stepper.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/motion/support_kick.hpp"

namespace dovetail::coupling {

std::unique_ptr<SolidStepper> makeExplicitStepper(std::unique_ptr<fem::Model>, const SolidOptions&);
std::unique_ptr<SolidStepper> makeImplicitStepper(std::unique_ptr<fem::Model>, const SolidOptions&);

namespace {

bool hasMass(const fem::Nodes& nodes) {
  return std::ranges::any_of(nodes.mass, [](double mass) { return mass > 0.0; });
}

}  // namespace

SolidStepper::SolidStepper(std::unique_ptr<fem::Model> model, const SolidOptions& options)
    : model_(std::move(model)), options_(options) {
  if (!hasMass(model_->nodes)) fem::addMass(*model_);
  side.name = options.name;
  side.model = model_.get();
  side.stepping = options.stepping;
  side.load = NodalLoad(model_->nodes.X.size());
}

bool SolidStepper::renewNodes() {
  if (!renewOwnNodes()) return false;
  side.load = NodalLoad(model_->nodes.X.size());
  macroLoad = side.load;
  return true;
}

void SolidStepper::kickTouched(const NodalLoad& load, double dt) {
  fem::Nodes& nodes = model_->nodes;
  const std::span<const int> row = side.mass->dofs().freeRow();
  loads.give(dt * totalOf(load, nodes));
  Momenta supports;
  for (const int node : load.touched) {
    const auto n = static_cast<std::size_t>(node);
    const double scale = dt / nodes.mass[n];
    Vec3 toSupports;
    for (int c = 0; c < 3; ++c)
      if (row[3 * n + static_cast<std::size_t>(c)] >= 0)
        nodes.v[n][c] += scale * load.force[n][c];
      else
        toSupports[c] = -dt * load.force[n][c];
    if (toSupports == Vec3{}) continue;
    supports.add(nodes.X[n] + nodes.u[n], toSupports);
    side.supportWork += dot(toSupports, nodes.v[n]);
  }
  side.outside.give("supports", supports);
}

ImpulseLedger SolidStepper::given() const {
  ImpulseLedger sum = side.outside;
  sum.add("", ownImpulses());
  return sum;
}

std::vector<Vec3> SolidSide::kick(std::span<const Vec3> impulse) {
  const std::vector<Vec3> before = nodes().v;
  std::vector<Vec3> change(impulse.begin(), impulse.end());
  mass->solve(change);
  for (std::size_t n = 0; n < change.size(); ++n) nodes().v[n] += change[n];
  const fem::SupportKick supports = fem::supportKick(nodes(), *mass, before, impulse, 1.0);
  outside.give("supports", supports.impulse);
  supportWork += supports.work;
  return change;
}

Momenta totalOf(const NodalLoad& load, const fem::Nodes& nodes) {
  Momenta sum;
  for (const int node : load.touched) {
    const auto n = static_cast<std::size_t>(node);
    sum.add(nodes.X[n] + nodes.u[n], load.force[n]);
  }
  return sum;
}

void SolidStepper::copyChannels(const EnergyLedger& own, double kinetic, EnergyLedger& ledger) const {
  using enum EnergyLedger::Kind;
  double supports = -side.supportWork - statics.supports;
  for (const std::string& name : carriedOver_)
    if (!own.find(name, booked)) ledger.set(side.name + ": " + name, booked, 0.0);
  for (const EnergyLedger::Channel& channel : own.channels()) {
    if (channel.name == "supports") supports += channel.joules;
    ledger.set(side.name + ": " + channel.name, channel.kind, channel.name == "kinetic" ? kinetic : channel.joules);
  }
  ledger.set(side.name + ": supports", booked, supports);
  ledger.set(side.name + ": booked with earlier steps", booked, bookedBefore);
  const bool none = statics.held == 0.0 && statics.loads == 0.0 && statics.dissipated == 0.0;
  if (none && !ledger.find(side.name + ": load steps", booked)) return;
  // What has been held back is no kinetic energy to be damped, though it comes to the same.
  ledger.set(side.name + ": load steps", booked, -statics.held);
  ledger.set(side.name + ": work of loads in load steps", booked, -statics.loads);
  ledger.set(side.name + ": dissipated in load steps", booked, statics.dissipated);
}

std::unique_ptr<SolidStepper> makeStepper(std::unique_ptr<fem::Model> model, const SolidOptions& options) {
  if (!model)
    throw InputError("there is no model", "solid \"" + options.name + "\"", "give a fem::Model with its terms");
  return options.stepping == Stepping::explicitSteps ? makeExplicitStepper(std::move(model), options)
                                                     : makeImplicitStepper(std::move(model), options);
}

}  // namespace dovetail::coupling
