// The ledger of a model in motion.
#pragma once

#include <map>
#include <string>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/ledger.hpp"
#include "dovetail/fem/model/model.hpp"

namespace dovetail::fem {

/// A stored channel for kinetic energy and for each term with energy, and for what elements with hourglass stiffness
/// store in that, which is not in theirs; booked channels appear with their first joule.
class EnergyBook {
public:
  explicit EnergyBook(const Model& model);
  /// Sets the stored channels, J. @param energies  per term
  void sample(const Model& model, std::span<const double> energies, double kinetic);
  /// The present state is the baseline.
  void open() { ledger_.open(); }
  void close() { ledger_.close(); }
  void spend(const std::string& channel, double joules);
  /// The terms adopt their history; books, if wanted, what they dissipated and what their own motion did.
  void accept(Model& model, const Instant& now, bool wanted);
  const EnergyLedger& ledger() const { return ledger_; }

  void save(ByteWriter& archive) const;
  /// What save() wrote, for the same terms. @throws InputError if they are others, or if the ledger are damaged
  EnergyBook read(ByteReader& archive) const;

private:
  EnergyLedger ledger_;
  EnergyLedger::Id kinetic_;
  struct Stored {
    std::size_t term;
    EnergyLedger::Id channel, hourglass;  // one and the same without hourglass stiffness
  };
  std::vector<Stored> stored_;  // of terms with energy
  std::map<std::string, EnergyLedger::Id> booked_;
};

}  // namespace dovetail::fem
