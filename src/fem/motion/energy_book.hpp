// The ledger of a model in motion.
#pragma once

#include <map>
#include <string>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/ledger.hpp"
#include "dovetail/fem/model/model.hpp"

namespace dovetail::fem::detail {

/// A stored channel for kinetic energy and for each term with energy; booked channels appear with their first joule.
class EnergyBook {
public:
  explicit EnergyBook(const Model& model);
  /// Sets the stored channels, J. @param energies  per term
  void sample(const Model& model, std::span<const double> energies, double kinetic);
  /// The present state is the baseline.
  void open() { ledger_.open(); }
  void close() { ledger_.close(); }
  void spend(const std::string& channel, double joules);
  const EnergyLedger& ledger() const { return ledger_; }

  void save(ByteWriter& archive) const;
  void load(ByteReader& archive);

private:
  EnergyLedger ledger_;
  EnergyLedger::Id kinetic_;
  std::vector<EnergyLedger::Id> stored_;  // per term with energy
  std::map<std::string, EnergyLedger::Id> booked_;
};

/// Displacements, velocities and what the terms remember.
void saveState(ByteWriter& archive, const Model& model);
void loadState(ByteReader& archive, Model& model);

}  // namespace dovetail::fem::detail
