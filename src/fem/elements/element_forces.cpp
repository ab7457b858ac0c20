#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/elements/elements.hpp"
#include "kernels.hpp"

namespace dovetail::fem {

namespace {

using detail::Batch;
using detail::BatchForces;
using detail::ElementCache;
using detail::Lane;

constexpr std::size_t batchGrain = 128;
constexpr std::size_t nodeGrain = 1024;
constexpr std::size_t parallelBatches = 512;  // below about 2000 elements threads cost more than they bring

void requireSameNodes(const ElementBlock& block, const Nodes& nodes) {
  if (nodes.u.size() != block.nodeCount() || nodes.f.size() != block.nodeCount())
    throw InputError("there are " + std::to_string(nodes.u.size()) + " nodes for elements of a mesh with " +
                         std::to_string(block.nodeCount()),
                     "elements", "use the nodes of the same mesh");
}

/// The kernels are not inlined and write to memory, so that no compiler fuses a product of theirs with the
/// sum over elements: one thread and many then add the very same numbers.
void evaluate(const ElementCache& cache, const Batch& batch, const Nodes& nodes, bool withEnergy, BatchForces& forces) {
  detail::batchForces(cache, batch, nodes.u.data(), withEnergy, forces);
}

double sumOfLanes(const Lane& lane) { return (lane[0] + lane[1]) + (lane[2] + lane[3]); }

void scatter(const Batch& batch, const BatchForces& forces, std::vector<Vec3>& f) {
  for (std::size_t lane = 0; lane < static_cast<std::size_t>(batch.count); ++lane)
    for (std::size_t a = 0; a < 8; ++a) {
      Vec3& node = f[static_cast<std::size_t>(batch.node[a][lane])];
      node.x -= forces.f[0][a][lane];
      node.y -= forces.f[1][a][lane];
      node.z -= forces.f[2][a][lane];
    }
}

void gather(const ElementCache& cache, std::size_t begin, std::size_t end, std::vector<Vec3>& f) {
  for (std::size_t n = begin; n < end; ++n)
    for (std::uint32_t entry = cache.nodeOffsets[n]; entry < cache.nodeOffsets[n + 1]; ++entry) {
      const std::uint32_t place = cache.nodeEntries[entry];
      const BatchForces& forces = cache.forces[place / 32];
      const std::uint32_t a = place % 32 / detail::laneCount, lane = place % detail::laneCount;
      f[n].x -= forces.f[0][a][lane];
      f[n].y -= forces.f[1][a][lane];
      f[n].z -= forces.f[2][a][lane];
    }
}

}  // namespace

double addInternalForces(const ElementBlock& block, Nodes& nodes, bool withEnergy) {
  requireSameNodes(block, nodes);
  ElementCache& cache = block.cache();
  const std::size_t count = cache.batches.size();
  const bool manyThreads = threads() > 1 && count > parallelBatches;
  if (manyThreads) cache.forces.resize(count);
  const auto body = [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    BatchForces local;
    for (std::size_t b = begin; b < end; ++b) {
      BatchForces& forces = manyThreads ? cache.forces[b] : local;
      evaluate(cache, cache.batches[b], nodes, withEnergy, forces);
      if (!manyThreads) scatter(cache.batches[b], forces, nodes.f);
      if (withEnergy) sum += sumOfLanes(forces.energy);
    }
    return sum;
  };
  if (manyThreads) {
    const double energy = parallelSum(count, batchGrain, body);
    parallelFor(nodes.f.size(), nodeGrain,
                [&](std::size_t begin, std::size_t end) { gather(cache, begin, end, nodes.f); });
    return energy;
  }
  double energy = 0.0;
  for (std::size_t begin = 0; begin < count; begin += batchGrain)
    energy += body(begin, std::min(count, begin + batchGrain));
  return energy;
}

double strainEnergy(const ElementBlock& block, const Nodes& nodes) {
  requireSameNodes(block, nodes);
  const ElementCache& cache = block.cache();
  return parallelSum(cache.batches.size(), batchGrain, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    BatchForces forces;
    for (std::size_t b = begin; b < end; ++b) {
      evaluate(cache, cache.batches[b], nodes, true, forces);
      sum += sumOfLanes(forces.energy);
    }
    return sum;
  });
}

std::vector<double> elementEnergies(const ElementBlock& block, const Nodes& nodes) {
  requireSameNodes(block, nodes);
  const ElementCache& cache = block.cache();
  std::vector<double> energies(cache.elements.size());
  parallelFor(cache.batches.size(), batchGrain, [&](std::size_t begin, std::size_t end) {
    BatchForces forces;
    for (std::size_t b = begin; b < end; ++b) {
      evaluate(cache, cache.batches[b], nodes, true, forces);
      for (int lane = 0; lane < cache.batches[b].count; ++lane)
        energies[detail::laneCount * b + static_cast<std::size_t>(lane)] = forces.energy[lane];
    }
  });
  return energies;
}

void requireValid(const ElementBlock& block, const Nodes& nodes, const std::string& when) {
  requireSameNodes(block, nodes);
  const ElementCache& cache = block.cache();
  detail::BatchDeterminants determinants;
  for (std::size_t b = 0; b < cache.batches.size(); ++b) {
    detail::batchDeterminants(cache, cache.batches[b], nodes.u.data(), determinants);
    for (int lane = 0; lane < cache.batches[b].count; ++lane)
      for (const Lane& value : determinants.value)
        if (!(value[lane] > 0.0))
          throw NumericalError("element " + std::to_string(detail::laneCount * b + static_cast<std::size_t>(lane)) +
                                   " is inverted (det F = " + formatNumber(value[lane]) + ")",
                               when, "take a smaller step, a finer mesh or a smaller load");
  }
}

}  // namespace dovetail::fem
