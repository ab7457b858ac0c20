// What an overlap tie asks of the step.
#include <algorithm>
#include <cmath>

#include "arlequin_coupling_impl.hpp"

namespace dovetail::arlequin {

namespace {

using Demand = dem::ContactDemand;

/// What springs of members ask of each of them, over the masses at both ends, 1/s².
std::vector<double> ratesUnder(const Demand& demand, const std::vector<Demand::Range>& nodesOf,
                               std::span<const double> inverseMass, std::span<const double> springs) {
  const auto weightsOf = [&](std::size_t k) {
    return std::span(demand.fractions).subspan(nodesOf[k].first, nodesOf[k].end - nodesOf[k].first);
  };
  std::vector<double> ofMasses(demand.masses.size(), 0.0), rates(springs.size());
  for (std::size_t k = 0; k < springs.size(); ++k)
    for (const auto& [mass, weight] : weightsOf(k)) ofMasses[static_cast<std::size_t>(mass)] += weight * springs[k];
  for (std::size_t k = 0; k < springs.size(); ++k) {
    rates[k] = springs[k] * inverseMass[k];
    for (const auto& [mass, weight] : weightsOf(k)) {
      const auto n = static_cast<std::size_t>(mass);
      rates[k] += weight * ofMasses[n] * demand.masses[n].inverse;
    }
  }
  return rates;
}

}  // namespace

/// Rows κ_i |Σ_k Π_ik r_k|² are no stiffer than springs Σ_i κ_i Π_ik Y_i/y_k of the members, for any y > 0, with Y = Π
/// y (Cauchy and Schwarz): y = 1 are springs p Ω. Light members get larger y, by turns, as long as the fastest gets
/// slower.
void ArlequinCoupling::Impl::level(const dem::Model& m, const dem::ContactDemand& demand,
                                   const std::vector<dem::ContactDemand::Range>& nodesOf,
                                   std::vector<double>& springs) const {
  constexpr int turns = 12;
  const std::size_t size = springs.size();
  std::vector<double> inverseMass(size), y(size, 1.0), levelled(size), rows(parts.gap.rows());
  for (std::size_t k = 0; k < size; ++k) {
    const auto i = static_cast<std::size_t>(overlap.particle[k]);
    inverseMass[k] = 1.0 / (m.particles.weightOf(i) * m.particles.mass[i]);
  }
  std::vector<Vec3> stiffness(rows.size());
  parts.constraint->applyStiffness(std::vector<Vec3>(rows.size(), Vec3{1.0, 0.0, 0.0}), stiffness);
  std::vector<double> rates = ratesUnder(demand, nodesOf, inverseMass, springs);
  double fastest = rates.empty() ? 0.0 : *std::ranges::max_element(rates);
  if (!(fastest > 0.0)) return;
  for (int turn = 0; turn < turns; ++turn) {
    const double most = *std::ranges::max_element(rates);
    for (std::size_t k = 0; k < size; ++k) y[k] *= std::max(0.1, std::sqrt(rates[k] / most));
    cg::apply(parts.gap.particles, y, rows);
    for (std::size_t r = 0; r < rows.size(); ++r) rows[r] *= stiffness[r].x;
    std::ranges::fill(levelled, 0.0);
    cg::applyTransposed(parts.gap.particles, rows, levelled);
    for (std::size_t k = 0; k < size; ++k) levelled[k] /= y[k];
    rates = ratesUnder(demand, nodesOf, inverseMass, levelled);
    if (const double rate = *std::ranges::max_element(rates); rate < fastest) fastest = rate, springs = levelled;
  }
}

/// Jensen: with weights that sum to one, Σ_i p V_i |g_i|² ≤ Σ_k p Ω_k |x_k − Φ_k u|² (the metric penalty is a
/// projection of the latter), so that every particle is held by a spring p Ω of its own to its place in the solid.
/// Multipliers ask for nothing, but make elements and contacts pull at the same masses.
void ArlequinCoupling::addDemand(const dem::Model& m, dem::ContactDemand& demand) const {
  const Impl& s = *impl_;
  const CouplingOptions& o = s.setting.options;
  for (auto* sums : {&demand.stiffness, &demand.damping, &demand.byTies}) sums->resize(m.particles.size(), 0.0);
  const bool inMacroSteps = s.actsInMacroSteps() && o.constraint == ConstraintKind::dashpot;
  if (inMacroSteps) demand.atMacroSteps.resize(m.particles.size(), 0.0);
  const int side = this->side().addTo(demand);
  const auto firstNode = static_cast<int>(demand.sides[static_cast<std::size_t>(side)].first);
  std::vector<double> springs(s.overlap.size());
  std::vector<Demand::Range> nodesOf(springs.size());
  std::vector<Demand::Fraction> weights;
  for (std::size_t k = 0; k < springs.size(); ++k) {
    springs[k] = s.springOf(m, k);
    weights.clear();
    if (s.overlap.place[k].element >= 0) {
      const Cell cell = cellOf(s.setting.mesh, s.overlap.place[k].element);
      for (std::size_t a = 0; a < cell.node.size(); ++a)
        weights.push_back({firstNode + cell.node[a], std::abs(s.overlap.place[k].shape[a])});
    }
    nodesOf[k] = demand.add(weights);
  }
  const bool explicitly = this->side().stepping == coupling::Stepping::explicitSteps;
  if (explicitly && !s.stale && s.turnsGap() && !s.hasWideRows() && s.isFollowed())
    s.level(m, demand, nodesOf, springs);
  for (std::size_t k = 0; k < springs.size(); ++k) {
    const auto i = static_cast<std::size_t>(s.overlap.particle[k]);
    (inMacroSteps ? demand.atMacroSteps : demand.stiffness)[i] += springs[k];
    if (!inMacroSteps) demand.byTies[i] += springs[k];
    demand.damping[i] += o.absorberRate * (1.0 - s.overlap.weight[k]) * m.particles.weightOf(i) * m.particles.mass[i];
    demand.links.push_back({.particle = s.overlap.particle[k],
                            .partner = -1,
                            .owner = dem::StepOwner::tie,
                            .stiffness = springs[k],
                            .shifting = springs[k],
                            .surface = static_cast<int>(demand.surfaces.size()),
                            .side = side,
                            .shifted = nodesOf[k]});
  }
  demand.surfaces.push_back(name());
}

/// p Ω of a member, N/m; of dashpots what asks for the same step: ε dt² < 2 where a spring has p dt² < 4.
double ArlequinCoupling::Impl::springOf(const dem::Model& m, std::size_t k) const {
  const int element = overlap.place[k].element;
  if (element < 0 || setting.options.constraint == ConstraintKind::multiplier) return 0.0;
  return (setting.options.constraint == ConstraintKind::dashpot ? 2.0 : 1.0) *
         setting.penalty[static_cast<std::size_t>(element)] *
         m.particles.mass[static_cast<std::size_t>(overlap.particle[k])] / setting.bulkDensity;
}

}  // namespace dovetail::arlequin
