// What a run holds.
#include <map>
#include <ostream>

#include "run_impl.hpp"

namespace dovetail::coupling {

namespace {

using enum EnergyLedger::Kind;

void setParticles(const dem::Model& grains, EnergyLedger& ledger) {
  const dem::Energies e = dem::energies(grains);
  ledger.set("particles: kinetic", stored, e.kinetic);
  ledger.set("particles: contacts", stored, e.contacts);
  ledger.set("particles: gravity", stored, e.gravity);
  ledger.set("particles: dashpots", booked, e.lost.dissipatedPower);
  ledger.set("particles: friction", booked, e.lost.frictionPower);
  ledger.set("particles: rolling", booked, e.lost.rollingPower);
  ledger.set("particles: plastic contacts", booked, e.lost.plasticPower);
  ledger.set("particles: fracture", booked, e.lost.fracturePower);
  ledger.set("particles: damping", booked, e.damping);
  ledger.set("particles: left", booked, e.left);
  ledger.set("particles: entered (minus)", booked, -e.entered);
  ledger.set("particles: work of walls and drives (minus)", booked, -e.walls);
  ledger.set("particles: work of external forces (minus)", booked, -e.external);
  ledger.set("particles: gravity work across periods (minus)", booked, -e.lifted);
}

/// Those of one name together.
void setConnectors(const dem::Model& grains, EnergyLedger& ledger) {
  std::map<std::string, std::pair<double, double>> joules;  // stored, lost
  for (const auto* connector : grains.terms.all<Connector>()) {
    joules[connector->name()].first += connector->stored();
    joules[connector->name()].second += connector->lost();
  }
  for (const auto& [name, sum] : joules) {
    if (sum.first != 0.0 || ledger.find(name + ": stored", stored)) ledger.set(name + ": stored", stored, sum.first);
    ledger.set(name + ": lost", booked, sum.second);
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
  ledger.set("kinetic damping", booked, impl_->broughtToRest);
  ledger.set("changes (minus)", booked, -impl_->changed);
  ledger.set("staggering error (minus what it made)", booked, -impl_->madeByLag);
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
