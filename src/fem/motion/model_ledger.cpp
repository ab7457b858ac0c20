#include "dovetail/fem/motion/model_ledger.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/solid.hpp"

namespace dovetail::fem {

namespace {

Solid* withHourglass(Term& term) {
  auto* const elements = dynamic_cast<Solid*>(&term);
  const bool has =
      elements && elements->formulation() == Formulation::reduced && elements->shape() == ElementShape::hex8;
  return has ? elements : nullptr;
}

}  // namespace

ModelLedger::ModelLedger(const Model& model) : kinetic_(addStored("kinetic")) {
  for (std::size_t k = 0; k < model.terms.size(); ++k) {
    Term& term = *model.terms[k];
    if (!term.hasEnergy()) continue;
    const Id own = addStored(term.name());
    stored_.push_back({k, own, withHourglass(term) ? addStored("hourglass of " + term.name()) : own});
  }
}

void ModelLedger::sample(const Model& model, std::span<const double> energies, double kinetic) {
  set(kinetic_, kinetic);
  for (const Stored& one : stored_) {
    double own = energies[one.term];
    if (one.hourglass != one.channel) {
      const double hourglass = withHourglass(*model.terms[one.term])->hourglassEnergy(model.nodes);
      set(one.hourglass, hourglass);
      own -= hourglass;
    }
    set(one.channel, own);
  }
}

void ModelLedger::accept(Model& model, const Instant& now, bool wanted) {
  for (const auto& term : model.terms) {
    const double dissipated = term->commit(model.nodes, now);
    if (!wanted) continue;
    if (dissipated != 0.0) add("dissipated by " + term->name(), dissipated);
    if (const double work = term->workOfMotion(); work != 0.0) add("motion of " + term->name(), -work);
  }
}

ModelLedger ModelLedger::read(ByteReader& archive) const {
  ModelLedger read = *this;
  read.load(archive);
  const auto storedIn = [](const EnergyLedger& ledger) {
    std::vector<std::string> names;
    for (const Channel& channel : ledger.channels())
      if (channel.kind == Kind::stored) names.push_back(channel.name);
    return names;
  };
  const std::vector<std::string> own = storedIn(*this);
  if (storedIn(read) != own ||
      !std::ranges::equal(own, std::span(read.channels()).first(own.size()), {}, {}, &Channel::name))
    throw InputError("the state has other terms", "ledger", "load it into the run that saved it");
  return read;
}

}  // namespace dovetail::fem
