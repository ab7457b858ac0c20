// What a run holds, what it can bear.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <ostream>

#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "run_impl.hpp"

namespace dovetail::coupling {

namespace {

using enum EnergyLedger::Kind;

void setParticles(const dem::Model& grains, EnergyLedger& ledger) {
  const dem::Energies e = dem::energies(grains);
  setChannel(ledger, "particles: kinetic", stored, e.kinetic);
  setChannel(ledger, "particles: contacts", stored, e.contacts);
  setChannel(ledger, "particles: gravity", stored, e.gravity);
  setChannel(ledger, "particles: dashpots", booked, e.lost.dissipatedPower);
  setChannel(ledger, "particles: friction", booked, e.lost.frictionPower);
  setChannel(ledger, "particles: rolling", booked, e.lost.rollingPower);
  setChannel(ledger, "particles: plastic contacts", booked, e.lost.plasticPower);
  setChannel(ledger, "particles: fracture", booked, e.lost.fracturePower);
  setChannel(ledger, "particles: damping", booked, e.damping);
  setChannel(ledger, "particles: left", booked, e.left);
  setChannel(ledger, "particles: entered (minus)", booked, -e.entered);
  setChannel(ledger, "particles: work of walls and drives (minus)", booked, -e.walls);
  setChannel(ledger, "particles: work of external forces (minus)", booked, -e.external);
  setChannel(ledger, "particles: lifted by periods (minus)", booked, -e.lifted);
}

bool has(const EnergyLedger& ledger, const std::string& name) {
  return std::ranges::any_of(ledger.channels(), [&](const auto& channel) { return channel.name == name; });
}

/// Those of one name together.
void setConnectors(const dem::Model& grains, EnergyLedger& ledger) {
  std::map<std::string, std::pair<double, double>> joules;  // stored, lost
  for (const auto* connector : grains.terms.all<Connector>()) {
    joules[connector->name()].first += connector->stored();
    joules[connector->name()].second += connector->lost();
  }
  for (const auto& [name, sum] : joules) {
    if (sum.first != 0.0 || has(ledger, name + ": stored")) setChannel(ledger, name + ": stored", stored, sum.first);
    setChannel(ledger, name + ": lost", booked, sum.second);
  }
}

bool hasElements(const fem::Model& model) {
  for (const auto& term : model.terms)
    if (dynamic_cast<const fem::Solid*>(term.get())) return true;
  return false;
}

}  // namespace

const EnergyLedger& CoupledRun::ledger() {
  impl_->requireStarted("ledger");
  dem::close(grains);
  EnergyLedger& ledger = impl_->ledger;
  setParticles(grains, ledger);
  for (const auto& solid : impl_->solids) solid->sample(ledger);
  setConnectors(grains, ledger);
  setChannel(ledger, "brought to rest", booked, impl_->broughtToRest);
  setChannel(ledger, "loads one step old (minus what they made)", booked, -impl_->madeByLag);
  ledger.close();
  return ledger;
}

StepLimit CoupledRun::criticalStep() {
  impl_->requireStarted("criticalStep");
  return impl_->criticalStep();
}

StepLimit CoupledRun::Impl::criticalStep() {
  const dem::ContactStep contacts = dem::criticalStep(grains);
  double rate = 0.0;  // ω²/4 of the solids, at the particles' step
  StepLimit limit{contacts.dt, contacts.particle < 0 ? "nobody" : dem::ownerOf(contacts, grains.particles)};
  for (const auto& solid : solids) {
    if (solid->side.stepping == Stepping::implicitSteps || !hasElements(*solid->side.model)) continue;
    const fem::ModelStableStep stable = fem::stableStep(*solid->side.model);
    const double least =
        std::sqrt(1.0 - 26.0 / 27.0 * solid->side.mass->share());  // as little as blended masses can be
    const double most = stable.dt * least / K();
    if (most < limit.dt)
      limit = {most, "element " + std::to_string(stable.element) + " of \"" + solid->side.name + "\""};
    rate = std::max(rate, 1.0 / (most * most));
  }
  bool connected = false;
  for (const auto& term : grains.terms) connected = connected || dynamic_cast<const Connector*>(term.get());
  if (connected && K() == 1 && std::isfinite(contacts.dt) && rate > 0.0) {
    const double together = 1.0 / std::sqrt(1.0 / (contacts.dt * contacts.dt) + rate);
    limit.dt = std::min(limit.dt, together);
  }
  return limit;
}

void report(CoupledRun& run, std::ostream& out) {
  out << run.grains.particles.size() << " particles";
  for (std::size_t k = 0; k < run.solids(); ++k)
    out << ", \"" << run.solid(k).name << "\" of " << run.solid(k).nodes().X.size() << " nodes";
  const StepLimit limit = run.criticalStep();
  out << " at " << run.time() << " s\nstep " << run.dt() << " s, " << run.window() << " s of the solids; at most "
      << limit.dt << " s, set by " << limit.owner << '\n'
      << run.ledger() << run.totals() << run.profile;
}

}  // namespace dovetail::coupling
