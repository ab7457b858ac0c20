#include "dovetail/fem/motion/stable_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "../elements/brick.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/motion/largest_eigenvalue.hpp"
#include "dovetail/fem/solve/block_matrix.hpp"

namespace dovetail::fem {

namespace {

/// Largest eigenvalue of M⁻¹K of one element with its lumped mass, 1/s².
double largestEigenvalue(const ElementBlock& block, const Nodes& rest, std::size_t element) {
  const std::array<double, 576> raw = elementTangent(block, rest, element);
  Eigen::Matrix<double, 24, 24> K = Eigen::Map<const Eigen::Matrix<double, 24, 24>>(raw.data());
  const std::array<double, 8> volume = nodalVolumes(cornersOf(block.elements()[element], block.X()),
                                                    cornerValues(block.elements()[element], block.nodalWeight()));
  Eigen::Matrix<double, 24, 1> scale;
  for (int i = 0; i < 24; ++i)
    scale[i] = 1.0 / std::sqrt(density(block.material()) * volume[static_cast<std::size_t>(i / 3)]);
  K = scale.asDiagonal() * K * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 24, 24>> solver(K, Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[23];
}

using Shape = std::array<long long, 29>;

/// Edges from the first corner in units of `quantum`, and the weights: equal for elements that are copies of each
/// other.
Shape shapeOf(const BrickCorners& corners, const CornerValues& share, double quantum) {
  Shape shape{};
  for (std::size_t a = 1; a < 8; ++a)
    for (int c = 0; c < 3; ++c)
      shape[3 * (a - 1) + static_cast<std::size_t>(c)] = std::llround((corners[a][c] - corners[0][c]) / quantum);
  for (std::size_t a = 0; a < 8; ++a) shape[21 + a] = std::llround(1e12 * share[a]);
  return shape;
}

}  // namespace

StableStep stableStep(const ElementBlock& block) {
  Nodes rest;
  rest.u.resize(block.nodeCount());
  const double quantum = 1e-9 * norm(block.X()[static_cast<std::size_t>(block.elements()[0][6])] -
                                     block.X()[static_cast<std::size_t>(block.elements()[0][0])]);
  std::map<Shape, double> known;
  StableStep limit{0.0, -1};
  double largest = 0.0;
  for (std::size_t e = 0; e < block.size(); ++e) {
    const auto [entry, isNew] =
        known.try_emplace(shapeOf(cornersOf(block.elements()[e], block.X()),
                                  cornerValues(block.elements()[e], block.nodalWeight()), quantum),
                          0.0);
    if (!isNew) continue;
    entry->second = largestEigenvalue(block, rest, e);
    if (entry->second > largest) {
      largest = entry->second;
      limit = {2.0 / std::sqrt(largest), static_cast<int>(e)};
    }
  }
  return limit;
}

double assembledStableStep(const ElementBlock& block, const Nodes& nodes, double accuracy) {
  requireMass(nodes);
  const SparseMatrix K = tangent(block, nodes);
  std::vector<int> free;
  for (int dof = 0; dof < K.size; ++dof)
    if (!(nodes.fixed[static_cast<std::size_t>(dof / 3)] >> dof % 3 & 1)) free.push_back(dof);
  const auto mass = [&](std::size_t i) { return nodes.mass[static_cast<std::size_t>(free[i] / 3)]; };
  std::vector<double> full(static_cast<std::size_t>(K.size), 0.0);
  const auto stiffness = [&](std::span<const double> x, std::span<double> y) {
    for (std::size_t i = 0; i < free.size(); ++i) full[static_cast<std::size_t>(free[i])] = x[i];
    const std::vector<double> pushed = multiply(K, full);
    for (std::size_t i = 0; i < free.size(); ++i) y[i] = pushed[static_cast<std::size_t>(free[i])];
  };
  return 2.0 / std::sqrt(largestEigenvalue({free.size(), stiffness,
                                            [&](std::span<const double> x, std::span<double> y) {
                                              for (std::size_t i = 0; i < y.size(); ++i) y[i] = mass(i) * x[i];
                                            },
                                            [&](std::span<const double> x, std::span<double> y) {
                                              for (std::size_t i = 0; i < y.size(); ++i) y[i] = x[i] / mass(i);
                                            }},
                                           accuracy));
}

double assembledStableStep(Model& model, double accuracy) {
  requireMass(model.nodes);
  const DofMap dofs(model.constraints, model.nodes);
  ModelMass mass(model, dofs, 0.0);
  BlockMatrix K = couplingPattern(model);
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
