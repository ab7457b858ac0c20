#include "dovetail/fem/model/nodes.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::fem {

namespace {
constexpr std::size_t nodeChunk = 4096;
}

void fix(Nodes& nodes, std::span<const int> set, unsigned components) {
  if (set.empty()) throw InputError("the node set is empty", "fix", "give at least one node");
  if (components < 1 || components > allComponents)
    throw InputError("there are no components " + std::to_string(components), "fix", "give bits 1 (x), 2 (y), 4 (z)");
  for (const int node : set)
    if (node < 0 || static_cast<std::size_t>(node) >= nodes.X.size())
      throw InputError("node " + std::to_string(node) + " does not exist", "fix",
                       "use 0 to " + std::to_string(nodes.X.size() - 1));
  for (const int node : set) {
    const auto n = static_cast<std::size_t>(node);
    nodes.fixed[n] = static_cast<std::uint8_t>(nodes.fixed[n] | components);
    for (int c = 0; c < 3; ++c)
      if (components >> c & 1u) nodes.v[n][c] = 0.0;
  }
}

void clearForces(Nodes& nodes) { std::fill(nodes.f.begin(), nodes.f.end(), Vec3{}); }

void kick(Nodes& nodes, double dt) {
  parallelFor(nodes.v.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::uint8_t held = nodes.fixed[n];
      if (held == allComponents) continue;
      const double factor = dt / nodes.mass[n];
      if (!(held & componentX)) nodes.v[n].x += factor * nodes.f[n].x;
      if (!(held & componentY)) nodes.v[n].y += factor * nodes.f[n].y;
      if (!(held & componentZ)) nodes.v[n].z += factor * nodes.f[n].z;
    }
  });
}

void drift(Nodes& nodes, double dt) {
  parallelFor(nodes.u.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) nodes.u[n] += dt * nodes.v[n];
  });
}

double kineticEnergy(const Nodes& nodes) {
  return parallelSum(nodes.v.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t n = begin; n < end; ++n) sum += 0.5 * nodes.mass[n] * squaredNorm(nodes.v[n]);
    return sum;
  });
}

Vec3 momentum(const Nodes& nodes) {
  return parallelSum(nodes.v.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    Vec3 sum;
    for (std::size_t n = begin; n < end; ++n) sum += nodes.mass[n] * nodes.v[n];
    return sum;
  });
}

Vec3 angularMomentum(const Nodes& nodes) {
  return parallelSum(nodes.v.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    Vec3 sum;
    for (std::size_t n = begin; n < end; ++n) sum += nodes.mass[n] * cross(nodes.X[n] + nodes.u[n], nodes.v[n]);
    return sum;
  });
}

void requireMass(const Nodes& nodes) {
  for (std::size_t n = 0; n < nodes.mass.size(); ++n)
    if (nodes.fixed[n] != allComponents && !(nodes.mass[n] > 0.0))
      throw InputError("it has no mass", "node " + std::to_string(n),
                       "call addMass(model), or hold all its components");
}

}  // namespace dovetail::fem
