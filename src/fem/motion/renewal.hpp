// Grids that are laid out anew between steps.
#pragma once

#include "dovetail/core/impulses.hpp"
#include "dovetail/fem/motion/model_ledger.hpp"

namespace dovetail::fem::detail {

/// Terms that want other nodes get them; what this takes of the kinetic energy, and gives of momenta, is booked.
/// @return whether any did: whatever belongs to the nodes is out of date then
/// @throws InputError if the model has constraints, which name nodes
bool renewNodes(Model& model, ModelLedger& ledger, ImpulseLedger& impulses);

}  // namespace dovetail::fem::detail
