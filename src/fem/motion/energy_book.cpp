#include "dovetail/fem/motion/energy_book.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "run_state.hpp"

namespace dovetail::fem {

namespace {

Solid* withHourglass(Term& term) {
  auto* const elements = dynamic_cast<Solid*>(&term);
  const bool has =
      elements && elements->formulation() == Formulation::reduced && elements->shape() == ElementShape::hex8;
  return has ? elements : nullptr;
}

}  // namespace

EnergyBook::EnergyBook(const Model& model) : kinetic_(ledger_.addStored("kinetic")) {
  for (std::size_t k = 0; k < model.terms.size(); ++k) {
    Term& term = *model.terms[k];
    if (!term.hasEnergy()) continue;
    const EnergyLedger::Id own = ledger_.addStored(term.name());
    stored_.push_back({k, own, withHourglass(term) ? ledger_.addStored("hourglass of " + term.name()) : own});
  }
}

void EnergyBook::sample(const Model& model, std::span<const double> energies, double kinetic) {
  ledger_.set(kinetic_, kinetic);
  for (const Stored& one : stored_) {
    double own = energies[one.term];
    if (one.hourglass != one.channel) {
      const double hourglass = withHourglass(*model.terms[one.term])->hourglassEnergy(model.nodes);
      ledger_.set(one.hourglass, hourglass);
      own -= hourglass;
    }
    ledger_.set(one.channel, own);
  }
}

void EnergyBook::spend(const std::string& channel, double joules) {
  if (joules == 0.0) return;
  const auto found = booked_.find(channel);
  const EnergyLedger::Id id = found != booked_.end() ? found->second : booked_[channel] = ledger_.addBooked(channel);
  ledger_.add(id, joules);
}

void EnergyBook::accept(Model& model, const Instant& now, bool wanted) {
  for (const auto& term : model.terms) {
    const double dissipated = term->commit(model.nodes, now);
    if (!wanted) continue;
    if (dissipated != 0.0) spend("dissipated by " + term->name(), dissipated);
    if (const double work = term->workOfMotion(); work != 0.0) spend("motion of " + term->name(), -work);
  }
}

void EnergyBook::save(ByteWriter& archive) const {
  archive(static_cast<std::int64_t>(ledger_.channels().size()));
  for (const EnergyLedger::Channel& channel : ledger_.channels()) {
    detail::writeText(archive, channel.name);
    archive(static_cast<std::int64_t>(channel.kind), channel.joules, channel.joulesAtOpening);
  }
}

namespace {

EnergyLedger::Kind readKind(ByteReader& archive) {
  const std::int64_t kind = detail::readCount(archive, "kind of a channel");
  if (kind > static_cast<std::int64_t>(EnergyLedger::Kind::booked))
    throw InputError("the kind of a channel has the number " + std::to_string(kind) + ", which is unknown", "ledger",
                     "take an older checkpoint");
  return static_cast<EnergyLedger::Kind>(kind);
}

}  // namespace

/// Builds the ledger anew: first with the values at the opening, then with the present ones.
EnergyBook EnergyBook::read(ByteReader& archive) const {
  const std::int64_t count = detail::readCount(archive, "number of channels");
  const auto storedChannels = static_cast<std::int64_t>(std::ranges::count_if(
      ledger_.channels(), [](const auto& one) { return one.kind == EnergyLedger::Kind::stored; }));
  EnergyBook book = *this;
  book.ledger_ = {};
  book.booked_.clear();
  std::vector<double> present;
  for (std::int64_t k = 0; k < count; ++k) {
    const std::string name = detail::readText(archive);
    const bool stored = readKind(archive) == EnergyLedger::Kind::stored;
    const bool known = stored ? k < storedChannels && name == ledger_.channels()[static_cast<std::size_t>(k)].name
                              : k >= storedChannels && !book.booked_.contains(name);
    if (!known)
      throw InputError("the state has other terms", "channel \"" + name + "\"", "load it into the run that saved it");
    present.push_back(detail::readNumber(archive, "energy of a channel"));
    const double opening = detail::readNumber(archive, "energy of a channel");
    const EnergyLedger::Id id = stored ? book.ledger_.addStored(name) : book.ledger_.addBooked(name);
    if (!stored) book.booked_[name] = id;
    book.ledger_.set(id, opening);
  }
  if (count < storedChannels)
    throw InputError("the state has other terms", "ledger", "load it into the run that saved it");
  book.ledger_.open();
  for (EnergyLedger::Id id = 0; id < present.size(); ++id) book.ledger_.set(id, present[id]);
  return book;
}

}  // namespace dovetail::fem
