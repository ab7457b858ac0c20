// What a run holds.
#include <algorithm>
#include <map>
#include <ostream>

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
  setChannel(ledger, "particles: gravity work across periods (minus)", booked, -e.lifted);
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

}  // namespace

const EnergyLedger& CoupledRun::ledger() {
  impl_->requireStarted("ledger");
  dem::close(grains);
  EnergyLedger& ledger = impl_->ledger;
  setParticles(grains, ledger);
  for (const auto& solid : impl_->solids) solid->sample(ledger);
  setConnectors(grains, ledger);
  setChannel(ledger, "kinetic damping", booked, impl_->broughtToRest);
  setChannel(ledger, "staggering error (minus what it made)", booked, -impl_->madeByLag);
  ledger.close();
  return ledger;
}

void report(CoupledRun& run, std::ostream& out) {
  out << run.grains.particles.size() << " particles";
  for (std::size_t k = 0; k < run.solids(); ++k)
    out << ", \"" << run.solid(k).name << "\" of " << run.solid(k).nodes().X.size() << " nodes";
  const StepLimit limit = run.criticalStep();
  out << " at " << run.time() << " s\nstep " << run.dt() << " s, " << run.macroStep() << " s of the solids; at most "
      << limit.dt << " s, set by " << limit.owner << '\n'
      << run.ledger() << run.totals() << run.profile;
}

}  // namespace dovetail::coupling
