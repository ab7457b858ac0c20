#include "dovetail/fem/motion/stable_step.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "dovetail/linalg/largest_eigenvalue.hpp"

namespace dovetail::fem {

double assembledStableStep(Model& model, double accuracy) {
  requireMass(model.nodes);
  const DofMap dofs(model.constraints, model.nodes);
  ModelMass mass(model, dofs, 0.0);
  linalg::BlockMatrix K = zeroTangent(model);
  addTangents(model, {model.t, 0.0}, K);
  std::vector<Vec3> in(model.nodes.X.size()), out(in.size());
  const auto reduced = [&](const auto& product) {
    return [&, product](std::span<const double> x, std::span<double> y) {
      std::fill(in.begin(), in.end(), Vec3{});
      dofs.addIncrement(x, in);
      product();
      dofs.reduce(out, y);
    };
  };
  const auto inverseMass = [&](std::span<const double> x, std::span<double> y) {
    std::fill(in.begin(), in.end(), Vec3{});
    std::fill(out.begin(), out.end(), Vec3{});
    for (std::size_t i = 0; i < x.size(); ++i)
      in[static_cast<std::size_t>(dofs.freeDofs()[i] / 3)][dofs.freeDofs()[i] % 3] = x[i];
    mass.accelerate(in, out);
    for (std::size_t i = 0; i < y.size(); ++i)
      y[i] = out[static_cast<std::size_t>(dofs.freeDofs()[i] / 3)][dofs.freeDofs()[i] % 3];
  };
  return 2.0 / std::sqrt(linalg::largestEigenvalue({dofs.size(), reduced([&] { K.multiply(in, out); }),
                                                    reduced([&] { mass.multiply(in, out); }), inverseMass},
                                                   accuracy));
}

namespace {

/// k/m of a node, 1/s², by what terms do that are no elements.
struct Pull {
  double rate = 0.0;
  int node = -1;
  std::string term;
};

/// The strongest one, with the sum of those of all terms.
Pull strongestPull(const Model& model) {
  Pull most;
  double sum = 0.0;
  for (const auto& term : model.terms) {
    std::vector<double> k(model.nodes.X.size(), 0.0);
    term->addStiffness(model.nodes, {model.t, 0.0}, k);
    Pull own;
    for (std::size_t n = 0; n < k.size(); ++n)
      if (model.nodes.fixed[n] != allComponents && k[n] > own.rate * model.nodes.mass[n])
        own = {k[n] / model.nodes.mass[n], static_cast<int>(n), term->name()};
    sum += own.rate;
    if (own.rate > most.rate) most = own;
  }
  most.rate = sum;
  return most;
}

}  // namespace

StableStep stableStep(Model& model, const std::string& of) {
  StableStep limit;
  for (const auto& term : model.terms)
    if (std::optional<StableStep> own = term->stableStep(model.nodes))
      if (limit.element < 0 || own->dt < limit.dt) limit = *std::move(own);
  if (limit.element < 0)
    throw InputError("the model has no solid", "stableStep", "add one with makeSolid, or ask assembledStableStep");
  std::string name = of.empty() ? limit.solid : of;
  name.insert(0, 1, '"').push_back('"');
  limit.owner = std::string(limit.part) + ' ' + std::to_string(limit.element) + " of " + name;
  const Pull pull = strongestPull(model);
  if (pull.node < 0) return limit;
  const double elements = 4.0 / (limit.dt * limit.dt);
  if (pull.rate > elements) {
    limit.node = pull.node, limit.solid = pull.term;
    limit.owner = "node " + std::to_string(pull.node) + " of " + name + ", at which \"" + pull.term + "\" pulls";
  }
  limit.dt = 2.0 / std::sqrt(elements + pull.rate);
  return limit;
}

}  // namespace dovetail::fem
