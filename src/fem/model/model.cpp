#include "dovetail/fem/model/model.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/linalg/block_matrix.hpp"

namespace dovetail::fem {

linalg::MatrixPattern patternOf(const Model& model) {
  linalg::MatrixPattern pattern(model.nodes.X.size());
  for (const auto& term : model.terms) term->addPattern(pattern);
  return pattern;
}

linalg::BlockMatrix zeroTangent(const Model& model) { return linalg::BlockMatrix(patternOf(model)); }

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
