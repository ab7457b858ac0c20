// Who adds where: owners of nodes and colours of the batches, and the parallel assembly of their matrices.
#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "solid_base.hpp"

namespace dovetail::fem::detail {

std::size_t SharedNodes::memory() const {
  return sizeof(std::int32_t) * owner.capacity() + sizeof(Vec3) * late.capacity() + sizeof(int) * node.capacity() +
         sizeof(std::uint32_t) * (first.capacity() + offsets.capacity() + place.capacity());
}

/// Once.
void SolidBase::shareNodes() {
  if (!shared_.owner.empty()) return;
  shared_.owner.assign(cells_.X.size(), -1);
  std::vector<std::vector<std::uint32_t>> late(cells_.X.size());
  std::uint32_t count = 0;
  for (std::size_t e = 0; e < cells_.size(); ++e) {
    const auto chunk = static_cast<std::int32_t>(e / laneCount / chunkSize());
    if (shared_.first.size() == static_cast<std::size_t>(chunk)) shared_.first.push_back(count);
    for (std::size_t a = 0; a < cells_.nodes; ++a) {
      const auto n = static_cast<std::size_t>(cells_.nodeOf(e, a));
      if (shared_.owner[n] < 0) shared_.owner[n] = chunk;
      if (shared_.owner[n] != chunk) late[n].push_back(count++);
    }
  }
  shared_.late.resize(count);
  shared_.offsets.push_back(0);
  for (std::size_t n = 0; n < late.size(); ++n) {
    if (late[n].empty()) continue;
    shared_.node.push_back(static_cast<int>(n));
    shared_.place.insert(shared_.place.end(), late[n].begin(), late[n].end());
    shared_.offsets.push_back(static_cast<std::uint32_t>(shared_.place.size()));
  }
}

/// Greedy: the first colour that none of the batch's nodes has; once.
void SolidBase::colourBatches() {
  if (!colours_.empty()) return;
  const std::size_t n = cells_.nodes;
  std::vector<std::uint64_t> taken(cells_.X.size(), 0);
  for (std::size_t b = 0; b < cells_.batches(); ++b) {
    std::uint64_t used = 0;
    for (std::size_t a = 0; a < n; ++a)
      for (const std::int32_t node : cells_.batchNode[n * b + a]) used |= taken[static_cast<std::size_t>(node)];
    std::size_t colour = 0;
    while (colour < 63 && used >> colour & 1) ++colour;
    if (used >> colour & 1) {  // more than 64 batches meet at a node: each of the rest goes alone
      colours_.resize(std::max<std::size_t>(colours_.size(), 64));
      colours_.push_back({static_cast<std::uint32_t>(b)});
      continue;
    }
    if (colours_.size() <= colour) colours_.resize(colour + 1);
    colours_[colour].push_back(static_cast<std::uint32_t>(b));
    for (std::size_t a = 0; a < n; ++a)
      for (const std::int32_t node : cells_.batchNode[n * b + a])
        taken[static_cast<std::size_t>(node)] |= std::uint64_t{1} << colour;
  }
}

void SolidBase::addPattern(linalg::MatrixPattern& pattern) const {
  std::vector<int> nodes(cells_.nodes);
  for (std::size_t e = 0; e < cells_.size(); ++e) {
    for (std::size_t a = 0; a < nodes.size(); ++a) nodes[a] = cells_.nodeOf(e, a);
    pattern.add(nodes);
  }
}

void SolidBase::findPlaces(const linalg::BlockMatrix& K) {
  if (placesOf_ == K.patternId()) return;
  const std::size_t n = cells_.nodes;
  places_.resize(cells_.size() * n * n);
  parallelFor(cells_.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e)
      for (std::size_t a = 0; a < n; ++a) {
        const int row = cells_.nodeOf(e, a);
        if (!K.takes(row)) continue;
        for (std::size_t b = 0; b < n; ++b)
          places_[(e * n + a) * n + b] = static_cast<std::uint32_t>(K.place(row, cells_.nodeOf(e, b)));
      }
  });
  placesOf_ = K.patternId();
}

void SolidBase::scatter(std::size_t batch, const Lane* matrix, double fraction, linalg::BlockMatrix& K) const {
  const std::size_t n = cells_.nodes;
  const std::span<double> values = K.values();
  for (std::size_t lane = 0; lane < cells_.inUse(batch); ++lane) {
    const std::uint32_t* const place = &places_[(laneCount * batch + lane) * n * n];
    for (std::size_t a = 0; a < n; ++a) {
      if (!K.takes(cells_.nodeOf(laneCount * batch + lane, a))) continue;
      for (std::size_t b = 0; b < n; ++b) {
        double* const block = &values[9 * static_cast<std::size_t>(place[a * n + b])];
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t k = 0; k < 3; ++k)
            block[3 * i + k] += fraction * matrix[3 * n * (3 * a + i) + 3 * b + k][static_cast<int>(lane)];
      }
    }
  }
}

void SolidBase::assemble(const Nodes& nodes, const Instant& now, const Vec3* start, double fraction,
                         linalg::BlockMatrix& K) {
  requireSameNodes(nodes);
  needGeometry();
  start == nullptr ? ask(nodes, now, {.tangent = true}) : openPoints();
  colourBatches();
  findPlaces(K);
  // Histories of laws are now those of the last batch evaluated with a tangent.
  if (points_->law()) evaluation_.known = false;
  const std::size_t size = 9 * cells_.nodes * cells_.nodes;
  for (const std::vector<std::uint32_t>& colour : colours_)
    parallelFor(colour.size(), cells_.nodes > 10 ? 2 : 8, [&](std::size_t begin, std::size_t end) {
      LaneVector matrix(size);
      for (std::size_t k = begin; k < end; ++k) {
        tangent(taskOf(colour[k], nodes, now, start), matrix.data());
        scatter(colour[k], matrix.data(), fraction, K);
      }
    });
}

void SolidBase::addTangent(const Nodes& nodes, const Instant& now, linalg::BlockMatrix& K) {
  assemble(nodes, now, nullptr, 1.0, K);
}

void SolidBase::addConservingTangent(const Nodes& nodes, std::span<const Vec3> u0, const Instant& now,
                                     linalg::BlockMatrix& K) {
  if (conserves()) return assemble(nodes, now, u0.data(), 1.0, K);
  // What the forces between pairs of nodes change by is left out: a fraction |Δu/∂X| of this.
  Nodes mean = nodes;
  for (std::size_t n = 0; n < u0.size(); ++n) mean.u[n] = 0.5 * (u0[n] + nodes.u[n]);
  assemble(mean, now, nullptr, 0.5, K);
}

void SolidBase::addConsistentMass(linalg::NodeMatrix& M) const {
  std::vector<int> nodes(cells_.nodes);
  for (std::size_t e = 0; e < cells_.size(); ++e) {
    for (std::size_t a = 0; a < nodes.size(); ++a) nodes[a] = cells_.nodeOf(e, a);
    M.add(nodes, consistentMass(cells_, e, density()));
  }
}

void SolidBase::addMass(std::span<double> mass) const {
  for (std::size_t e = 0; e < cells_.size(); ++e) {
    const std::vector<double> own = lumpedMass(cells_, e, density());
    for (std::size_t a = 0; a < cells_.nodes; ++a) mass[static_cast<std::size_t>(cells_.nodeOf(e, a))] += own[a];
  }
}

void SolidBase::addBodyMass(std::span<double> mass) const {
  for (std::size_t e = 0; e < cells_.size(); ++e) {
    const std::vector<double> own = rowSumsOfMass(cells_, e, density());
    for (std::size_t a = 0; a < cells_.nodes; ++a) mass[static_cast<std::size_t>(cells_.nodeOf(e, a))] += own[a];
  }
}

}  // namespace dovetail::fem::detail
