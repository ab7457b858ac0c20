// The ledger of a model in motion.
#pragma once

#include <span>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/ledger.hpp"
#include "dovetail/fem/model/model.hpp"

namespace dovetail::fem {

/// A stored channel for kinetic energy and for each term with energy, and for what elements with hourglass stiffness
/// store in that, which is not in theirs; booked channels appear with their first joule.
class ModelLedger : public EnergyLedger {
public:
  explicit ModelLedger(const Model& model);
  /// Sets the stored channels, J. @param energies  per term
  void sample(const Model& model, std::span<const double> energies, double kinetic);
  /// The terms adopt their history; books, if wanted, what they dissipated and what their own motion did.
  void accept(Model& model, const Instant& now, bool wanted);
  /// What save() wrote, for the same terms. @throws InputError if they are others, or if it is damaged
  ModelLedger read(ByteReader& archive) const;

private:
  Id kinetic_;
  struct Stored {
    std::size_t term;
    Id channel, hourglass;  // one and the same without hourglass stiffness
  };
  std::vector<Stored> stored_;  // of terms with energy
};

}  // namespace dovetail::fem
