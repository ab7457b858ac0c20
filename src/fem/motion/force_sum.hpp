// Forces and energies of a model, term by term where a ledger needs it.
#pragma once

#include <vector>

#include "dovetail/fem/model/model.hpp"
#include "solve/newton_tools.hpp"

namespace dovetail::fem::detail {

/// Whether its force is kept apart: its work, or its impulse, is booked as it is done.
inline bool isKeptApart(const Term& term) { return !term.hasEnergy() || !term.actsWithin(); }

struct ForceSum {
  std::vector<std::vector<Vec3>> loads;  ///< per term, of those that are kept apart; else empty
  std::vector<double> energies;          ///< per term, J, of the last evaluation with energy

  explicit ForceSum(const Model& model) : loads(model.terms.size()), energies(model.terms.size(), 0.0) {
    for (std::size_t k = 0; k < loads.size(); ++k)
      if (isKeptApart(*model.terms[k])) loads[k].resize(model.nodes.u.size());
  }
  /// @return Σ energies if asked for, else 0
  double evaluate(Model& model, const Nodes& nodes, const Instant& now, std::span<Vec3> total, bool withEnergy) {
    std::fill(total.begin(), total.end(), Vec3{});
    double sum = 0.0;
    for (std::size_t k = 0; k < model.terms.size(); ++k) {
      Term& term = *model.terms[k];
      std::vector<Vec3>& load = loads[k];
      std::fill(load.begin(), load.end(), Vec3{});
      const std::span<Vec3> to = load.empty() ? total : std::span<Vec3>(load);
      if (withEnergy && term.hasEnergy())
        sum += energies[k] = term.addForcesAndEnergy(nodes, now, to);
      else
        term.addForces(nodes, now, to);
      for (std::size_t n = 0; n < load.size(); ++n) total[n] += load[n];
    }
    return sum;
  }
};

}  // namespace dovetail::fem::detail
