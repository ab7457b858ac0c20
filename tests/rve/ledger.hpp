// That nothing vanishes on a path.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "cells.hpp"

namespace dovetail::rve {

/// What no channel of the book has of the work, over the work; `stored` was the energy in the springs when the book
/// began.
inline double ledgerResidual(const Rve& cell, double stored) {
  const RveLedger& ledger = cell.state.ledger;
  return (ledger.work - (storedEnergy(cell) - stored) - kineticEnergy(cell) - ledger.friction - ledger.damping -
          ledger.bonds) /
         ledger.work;
}

/// Follows F(1), F(2) … F(parts) from a state whose book is empty, without rest, with long and with short steps.
template <class Deformation>
void expectLedgerClosesAsStepsShrink(const Rve& start, int parts, const Deformation& F) {
  const double stored = storedEnergy(start);
  const auto residualOf = [&](double stepFraction) {
    Rve cell = start;
    for (int k = 1; k <= parts; ++k) followPath(cell, F(k), {.stepFraction = stepFraction, .rest = {.steps = 0}});
    const RveLedger& ledger = cell.state.ledger;
    EXPECT_GT(ledger.friction, 0.05 * ledger.work);
    EXPECT_GT(ledger.damping, 1e-5 * ledger.work);
    return std::abs(ledgerResidual(cell, stored));
  };
  const double coarse = residualOf(0.8), fine = residualOf(0.1);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(fine, 0.5 * coarse);
}

}  // namespace dovetail::rve
