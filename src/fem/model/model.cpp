#include "dovetail/fem/model/model.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/team.hpp"
#include "dovetail/linalg/block_matrix.hpp"

namespace dovetail::fem {

namespace {

/// A node that the parts of several ranks meet in goes to the one of them with the fewest so far.
std::vector<int> ownersOf(const linalg::MatrixPattern& own) {
  const std::size_t nodes = own.nodes();
  std::vector<char> meets(nodes);
  for (std::size_t n = 0; n < nodes; ++n) meets[n] = own.couples(n) ? 1 : 0;
  const std::vector<std::vector<char>> all = team().gather(std::move(meets));
  std::vector<int> owners(nodes, -1);
  std::vector<std::size_t> count(all.size(), 0);
  const auto give = [&](std::size_t node, std::size_t rank) { owners[node] = static_cast<int>(rank), ++count[rank]; };
  const auto has = [&](std::size_t node) { return [&all, node](std::size_t rank) { return all[rank][node] != 0; }; };
  std::vector<std::size_t> ranks(all.size());
  std::iota(ranks.begin(), ranks.end(), std::size_t{0});
  for (std::size_t n = 0; n < nodes; ++n)
    if (const auto those = std::ranges::count_if(ranks, has(n)); those < 2)
      give(n, those == 0 ? 0 : static_cast<std::size_t>(std::ranges::find_if(ranks, has(n)) - ranks.begin()));
  for (std::size_t n = 0; n < nodes; ++n) {
    if (owners[n] >= 0) continue;
    std::size_t best = all.size();
    for (const std::size_t rank : ranks)
      if (has(n)(rank) && (best == all.size() || count[rank] < count[best])) best = rank;
    give(n, best);
  }
  return owners;
}

}  // namespace

linalg::MatrixPattern patternOf(const Model& model) {
  const auto isShared = [](const auto& term) { return term->isShared(); };
  linalg::MatrixPattern pattern(model.nodes.X.size());
  for (const auto& term : model.terms)
    if (isShared(term)) term->addPattern(pattern);
  if (std::ranges::any_of(model.terms, isShared)) pattern.setOwners(ownersOf(pattern));
  for (const auto& term : model.terms)
    if (!isShared(term)) term->addPattern(pattern);
  return pattern;
}

linalg::BlockMatrix zeroTangent(const Model& model) { return linalg::BlockMatrix(patternOf(model)); }

void addTangents(const Model& model, const Instant& now, linalg::BlockMatrix& K) {
  for (const auto& term : model.terms) term->addTangent(model.nodes, now, rowsFor(*term, K));
}

Model makeModel(const SolidMesh& mesh) {
  const std::size_t n = mesh.X.size();
  Model model;
  model.nodes.X = mesh.X;
  model.nodes.u.resize(n);
  model.nodes.v.resize(n);
  model.nodes.f.resize(n);
  model.nodes.mass.assign(n, 0.0);
  model.nodes.fixed.assign(n, dimensionOf(mesh) == 2 ? componentZ : 0);
  return model;
}

void addMass(Model& model) {
  std::vector<double>& mass = model.nodes.mass;
  std::fill(mass.begin(), mass.end(), 0.0);
  for (const auto& term : model.terms) term->addMass(mass);
  for (std::size_t n = 0; n < mass.size(); ++n)
    if (!(mass[n] > 0.0) && model.nodes.fixed[n] != allComponents)
      throw InputError("no term gives it a mass", "node " + std::to_string(n),
                       "add the elements of all materials, or fix its components");
  std::vector<double> bodyMass(mass.size(), 0.0);
  for (const auto& term : model.terms) term->addBodyMass(bodyMass);
  if (bodyMass == mass) bodyMass = {};
  model.nodes.bodyMass = std::move(bodyMass);
}

bool ownsNodes(const Model& model) {
  return std::ranges::any_of(model.terms, [](const auto& term) { return term->ownsNodes(); });
}

void evaluateForces(Model& model, const Instant& now) {
  std::fill(model.nodes.f.begin(), model.nodes.f.end(), Vec3{});
  for (const auto& term : model.terms) term->addForces(model.nodes, now, model.nodes.f);
}

double storedEnergy(Model& model, const Instant& now) {
  double sum = 0.0;
  for (const auto& term : model.terms)
    if (term->hasEnergy()) sum += term->energy(model.nodes, now);
  return sum;
}

}  // namespace dovetail::fem
