// Forces and energies of a model, term by term where a ledger needs it.
#pragma once

#include <vector>

#include "../solve/newton_tools.hpp"
#include "dovetail/fem/model/model.hpp"

namespace dovetail::fem::detail {

/// What the terms without energy exert is kept, because their work is booked as it is done.
struct ForceSum {
  std::vector<std::vector<Vec3>> loads;  ///< per term without energy
  std::vector<double> energies;          ///< per term, J, of the last evaluation with energy

  explicit ForceSum(const Model& model) : energies(model.terms.size(), 0.0) {
    for (const auto& term : model.terms)
      if (!term->hasEnergy()) loads.emplace_back(model.nodes.u.size());
  }
  /// @return Σ energies if asked for, else 0
  double evaluate(Model& model, const Nodes& nodes, const Instant& now, std::span<Vec3> total, bool withEnergy) {
    std::fill(total.begin(), total.end(), Vec3{});
    std::size_t next = 0;
    double sum = 0.0;
    for (std::size_t k = 0; k < model.terms.size(); ++k) {
      Term& term = *model.terms[k];
      if (!term.hasEnergy()) {
        std::vector<Vec3>& load = loads[next++];
        std::fill(load.begin(), load.end(), Vec3{});
        term.addForces(nodes, now, load);
        for (std::size_t n = 0; n < load.size(); ++n) total[n] += load[n];
      } else if (withEnergy) {
        sum += energies[k] = term.addForcesAndEnergy(nodes, now, total);
      } else {
        term.addForces(nodes, now, total);
      }
    }
    return sum;
  }
};

}  // namespace dovetail::fem::detail
