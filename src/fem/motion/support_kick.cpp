#include "dovetail/fem/motion/support_kick.hpp"

#include "dovetail/core/parallel.hpp"

namespace dovetail::fem {

namespace {

constexpr std::size_t nodeChunk = 4096;

void add(const Nodes& nodes, std::size_t n, const Vec3& impulse, const Vec3& change, SupportKick& sum) {
  sum.impulse.add(nodes.X[n] + nodes.u[n], impulse);
  sum.work += dot(impulse, nodes.v[n] - 0.5 * change);
}

/// Masses are lumped.
SupportKick ofBoundNodes(const Nodes& nodes, const ModelMass& mass, std::span<const Vec3> before,
                         std::span<const Vec3> f, double dt) {
  const std::span<const int> row = mass.dofs().freeRow(), bound = mass.dofs().boundNodes();
  return parallelSum(bound.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    SupportKick sum;
    for (std::size_t k = begin; k < end; ++k) {
      const auto n = static_cast<std::size_t>(bound[k]);
      Vec3 impulse;
      const Vec3 change = before.empty() ? Vec3{} : nodes.v[n] - before[n];
      for (int c = 0; c < 3; ++c)
        if (row[3 * n + static_cast<std::size_t>(c)] < 0) impulse[c] = nodes.mass[n] * change[c] - dt * f[n][c];
      add(nodes, n, impulse, change, sum);
    }
    return sum;
  });
}

}  // namespace

SupportKick supportKick(const Nodes& nodes, const ModelMass& mass, std::span<const Vec3> before,
                        std::span<const Vec3> f, double dt) {
  if (mass.isDiagonal()) return ofBoundNodes(nodes, mass, before, f, dt);
  std::vector<Vec3> impulse(nodes.v.size()), change(nodes.v.size());
  for (std::size_t n = 0; n < change.size(); ++n) change[n] = nodes.v[n] - before[n];
  mass.multiply(change, impulse);
  SupportKick sum;
  for (std::size_t n = 0; n < impulse.size(); ++n) add(nodes, n, impulse[n] - dt * f[n], change[n], sum);
  return sum;
}

Momenta momentaOf(const Nodes& nodes, const ModelMass& mass) {
  std::vector<Vec3> momentum(nodes.v.size());
  mass.multiply(nodes.v, momentum);
  return momentaOf(nodes, momentum);
}

Momenta momentaOf(const Nodes& nodes, std::span<const Vec3> force) {
  Momenta sum;
  for (std::size_t n = 0; n < force.size(); ++n) sum.add(nodes.X[n] + nodes.u[n], force[n]);
  return sum;
}

}  // namespace dovetail::fem
