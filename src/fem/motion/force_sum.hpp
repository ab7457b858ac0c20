// Forces of a model, those without energy kept apart.
#pragma once

#include <vector>

#include "../solve/newton_tools.hpp"
#include "dovetail/fem/model/model.hpp"

namespace dovetail::fem::detail {

/// Σ forces of the terms, and the share of each term without energy, whose work is booked as it is done.
struct ForceSum {
  std::vector<Vec3> total;
  std::vector<std::vector<Vec3>> loads;  ///< per term without energy

  explicit ForceSum(const Model& model) : total(model.nodes.u.size()) {
    for (const auto& term : model.terms)
      if (!term->hasEnergy()) loads.emplace_back(total.size());
  }
  void evaluate(Model& model, const Nodes& nodes, const Instant& now) {
    std::fill(total.begin(), total.end(), Vec3{});
    std::size_t next = 0;
    for (const auto& term : model.terms) {
      if (term->hasEnergy()) {
        term->addForces(nodes, now, total);
        continue;
      }
      std::vector<Vec3>& load = loads[next++];
      std::fill(load.begin(), load.end(), Vec3{});
      term->addForces(nodes, now, load);
      for (std::size_t n = 0; n < load.size(); ++n) total[n] += load[n];
    }
  }
};

}  // namespace dovetail::fem::detail
