#include "energy_book.hpp"

#include "dovetail/core/error.hpp"

namespace dovetail::fem::detail {

EnergyBook::EnergyBook(const Model& model) : kinetic_(ledger_.addStored("kinetic")) {
  for (const auto& term : model.terms)
    if (term->hasEnergy()) stored_.push_back(ledger_.addStored(term->name()));
}

void EnergyBook::sample(const Model& model, std::span<const double> energies, double kinetic) {
  ledger_.set(kinetic_, kinetic);
  std::size_t next = 0;
  for (std::size_t k = 0; k < model.terms.size(); ++k)
    if (model.terms[k]->hasEnergy()) ledger_.set(stored_[next++], energies[k]);
}

void EnergyBook::spend(const std::string& channel, double joules) {
  if (joules == 0.0) return;
  const auto found = booked_.find(channel);
  const EnergyLedger::Id id = found != booked_.end() ? found->second : booked_[channel] = ledger_.addBooked(channel);
  ledger_.add(id, joules);
}

void EnergyBook::save(ByteWriter& archive) const {
  archive(static_cast<std::uint64_t>(ledger_.channels().size()));
  for (const EnergyLedger::Channel& channel : ledger_.channels())
    archive(std::vector<char>(channel.name.begin(), channel.name.end()), channel.kind, channel.joules,
            channel.joulesAtOpening);
}

/// Builds the ledger anew: first with the values at the opening, then with the present ones.
void EnergyBook::load(ByteReader& archive) {
  std::uint64_t count = 0;
  archive(count);
  const std::size_t fixedChannels = 1 + stored_.size();
  EnergyLedger ledger;
  std::vector<double> present;
  booked_.clear();
  for (std::uint64_t k = 0; k < count; ++k) {
    std::vector<char> name;
    EnergyLedger::Channel channel;
    archive(name, channel.kind, channel.joules, channel.joulesAtOpening);
    channel.name.assign(name.begin(), name.end());
    const bool stored = channel.kind == EnergyLedger::Kind::stored;
    if (stored != (k < fixedChannels) || (stored && channel.name != ledger_.channels()[k].name))
      throw InputError("the checkpoint has other terms", "channel \"" + channel.name + "\"",
                       "load it into the model that wrote it");
    const EnergyLedger::Id id = stored ? ledger.addStored(channel.name) : ledger.addBooked(channel.name);
    if (!stored) booked_[channel.name] = id;
    if (stored)
      ledger.set(id, channel.joulesAtOpening);
    else
      ledger.add(id, channel.joulesAtOpening);
    present.push_back(channel.joules);
  }
  if (count < fixedChannels)
    throw InputError("the checkpoint has other terms", "ledger", "load it into the model that wrote it");
  ledger.open();
  for (EnergyLedger::Id id = 0; id < present.size(); ++id) ledger.set(id, present[id]);
  ledger_ = ledger;
}

void saveState(ByteWriter& archive, const Model& model) {
  archive(model.t, model.nodes.u, model.nodes.v);
  for (const auto& term : model.terms) term->save(archive);
}

void loadState(ByteReader& archive, Model& model) {
  std::vector<Vec3> u, v;
  double t = 0.0;
  archive(t, u, v);
  if (u.size() != model.nodes.u.size() || v.size() != u.size())
    throw InputError(
        "the checkpoint has " + std::to_string(u.size()) + " nodes, the model " + std::to_string(model.nodes.u.size()),
        "load", "load it into the model that wrote it");
  model.t = t;
  model.nodes.u = std::move(u);
  model.nodes.v = std::move(v);
  for (const auto& term : model.terms) term->load(archive);
}

}  // namespace dovetail::fem::detail
