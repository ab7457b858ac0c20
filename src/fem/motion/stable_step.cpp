#include "dovetail/fem/motion/stable_step.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/motion/largest_eigenvalue.hpp"
#include "dovetail/fem/solve/block_matrix.hpp"

namespace dovetail::fem {

double assembledStableStep(Model& model, double accuracy) {
  requireMass(model.nodes);
  const DofMap dofs(model.constraints, model.nodes);
  ModelMass mass(model, dofs, 0.0);
  BlockMatrix K = zeroTangent(model);
  for (const auto& term : model.terms) term->addTangent(model.nodes, {model.t, 0.0}, K);
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
  return 2.0 / std::sqrt(largestEigenvalue({dofs.size(), reduced([&] { K.multiply(in, out); }),
                                            reduced([&] { mass.multiply(in, out); }), inverseMass},
                                           accuracy));
}

ModelStableStep stableStep(Model& model) {
  ModelStableStep limit{0.0, -1, {}};
  for (const auto& term : model.terms)
    if (auto* const solid = dynamic_cast<Solid*>(term.get())) {
      const StableStep own = solid->stableStep(model.nodes);
      if (limit.element < 0 || own.dt < limit.dt) limit = {own.dt, own.element, solid->name()};
    }
  if (limit.element < 0)
    throw InputError("the model has no solid", "stableStep", "add one with makeSolid, or ask assembledStableStep");
  return limit;
}

}  // namespace dovetail::fem
