// Set-up of the batches, and the parallel assembly of their matrices.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "small_tensors.hpp"
#include "solid_base.hpp"

namespace dovetail::fem::detail {

std::vector<PointGeometry> geometryAt(const SolidCells& cells, const CellRule& rule) {
  const std::size_t n = cells.nodes, q = rule.point.size();
  std::vector<PointGeometry> geometry(cells.batches() * q);
  for (std::size_t b = 0; b < cells.batches(); ++b)
    for (std::size_t p = 0; p < q; ++p) {
      std::array<Lane, 9> J{};
      for (std::size_t a = 0; a < n; ++a) {
        const auto& node = cells.batchNode[n * b + a];
        for (std::size_t i = 0; i < 3; ++i) {
          Lane x;
          for (std::size_t lane = 0; lane < laneCount; ++lane)
            x[lane] = cells.X[static_cast<std::size_t>(node[lane])][static_cast<int>(i)];
          for (std::size_t j = 0; j < 3; ++j) J[3 * i + j] += x * rule.gradient[n * p + a][static_cast<int>(j)];
        }
      }
      PointGeometry& point = geometry[b * q + p];
      point.weight = rule.weight[p] * inverseOf(J.data(), point.map.data());
      for (std::size_t lane = cells.inUse(b); lane < laneCount; ++lane) point.weight[lane] = 0.0;
    }
  return geometry;
}

/// For every node its entries in the batches' results, by ascending element.
void SolidBase::listEntries() {
  const std::size_t n = cells_.nodes;
  nodeOffsets_.assign(cells_.X.size() + 1, 0);
  for (const int node : cells_.node) ++nodeOffsets_[static_cast<std::size_t>(node) + 1];
  for (std::size_t i = 0; i < cells_.X.size(); ++i) nodeOffsets_[i + 1] += nodeOffsets_[i];
  std::vector<std::uint32_t> next(nodeOffsets_.begin(), nodeOffsets_.end() - 1);
  nodeEntries_.resize(cells_.node.size());
  for (std::size_t e = 0; e < cells_.size(); ++e)
    for (std::size_t a = 0; a < n; ++a)
      nodeEntries_[next[static_cast<std::size_t>(cells_.node[n * e + a])]++] =
          3 * ((e / laneCount) * n + a) * laneCount + e % laneCount;
}

/// Greedy: the first colour that none of the batch's nodes has.
void SolidBase::colourBatches() {
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

void SolidBase::addCouplings(Couplings& couplings) const {
  for (std::size_t e = 0; e < cells_.size(); ++e)
    couplings.add(std::span(cells_.node).subspan(cells_.nodes * e, cells_.nodes));
}

void SolidBase::findPlaces(const BlockMatrix& K) {
  if (placesOf_ == K.patternId()) return;
  const std::size_t n = cells_.nodes;
  places_.resize(cells_.size() * n * n);
  parallelFor(cells_.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e)
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
          places_[(e * n + a) * n + b] =
              static_cast<std::uint32_t>(K.place(cells_.node[n * e + a], cells_.node[n * e + b]));
  });
  placesOf_ = K.patternId();
}

void SolidBase::scatter(std::size_t batch, const Lane* matrix, double share, BlockMatrix& K) const {
  const std::size_t n = cells_.nodes;
  const std::span<double> values = K.values();
  for (std::size_t lane = 0; lane < cells_.inUse(batch); ++lane) {
    const std::uint32_t* const place = &places_[(laneCount * batch + lane) * n * n];
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b) {
        double* const block = &values[9 * static_cast<std::size_t>(place[a * n + b])];
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t k = 0; k < 3; ++k)
            block[3 * i + k] += share * matrix[3 * n * (3 * a + i) + 3 * b + k][static_cast<int>(lane)];
      }
  }
}

void SolidBase::assemble(const Nodes& nodes, const Instant& now, const Vec3* start, double share, BlockMatrix& K) {
  requireSameNodes(nodes);
  startHistory();
  findPlaces(K);
  const std::size_t size = 9 * cells_.nodes * cells_.nodes;
  for (const std::vector<std::uint32_t>& colour : colours_)
    parallelFor(colour.size(), cells_.nodes > 10 ? 2 : 8, [&](std::size_t begin, std::size_t end) {
      LaneVector matrix(size);
      for (std::size_t k = begin; k < end; ++k) {
        tangent(taskOf(colour[k], nodes, now, start), matrix.data());
        scatter(colour[k], matrix.data(), share, K);
      }
    });
}

void SolidBase::addTangent(const Nodes& nodes, const Instant& now, BlockMatrix& K) {
  assemble(nodes, now, nullptr, 1.0, K);
}

void SolidBase::addConservingTangent(const Nodes& nodes, std::span<const Vec3> u0, const Instant& now, BlockMatrix& K) {
  if (conserves()) return assemble(nodes, now, u0.data(), 1.0, K);
  // What the forces between pairs of nodes change by is left out: a share |Δu/∂X| of this.
  Nodes mean = nodes;
  for (std::size_t n = 0; n < u0.size(); ++n) mean.u[n] = 0.5 * (u0[n] + nodes.u[n]);
  assemble(mean, now, nullptr, 0.5, K);
}

void SolidBase::addConsistentMass(BlockMatrix& M) const {
  const std::size_t n = cells_.nodes;
  const CellRule& rule = massRule(cells_.shape);
  const std::vector<PointGeometry> geometry = geometryAt(cells_, rule);
  std::vector<double> matrix(9 * n * n);
  for (std::size_t e = 0; e < cells_.size(); ++e) {
    std::fill(matrix.begin(), matrix.end(), 0.0);
    for (std::size_t q = 0; q < rule.point.size(); ++q) {
      const double weight = geometry[e / laneCount * rule.point.size() + q].weight[e % laneCount];
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
          for (std::size_t c = 0; c < 3; ++c)
            matrix[3 * n * (3 * a + c) + 3 * b + c] +=
                material_->density() * weight * rule.value[n * q + a] * rule.value[n * q + b];
    }
    M.add(std::span(cells_.node).subspan(n * e, n), matrix);
  }
}

/// Row sums, or the diagonal scaled to the element's mass (Hinton, Rock & Zienkiewicz 1976); kg per node of an element.
std::vector<double> SolidBase::elementMasses(std::size_t element, const CellRule& rule,
                                             std::span<const PointGeometry> geometry, bool scaled) const {
  const std::size_t n = cells_.nodes;
  std::vector<double> share(n, 0.0);
  double volume = 0.0, sum = 0.0;
  for (std::size_t q = 0; q < rule.point.size(); ++q) {
    const double weight = geometry[element / laneCount * rule.point.size() + q].weight[element % laneCount];
    volume += weight;
    for (std::size_t a = 0; a < n; ++a) {
      const double value = rule.value[n * q + a];
      share[a] += weight * (scaled ? value * value : value);
    }
  }
  for (const double value : share) sum += value;
  for (double& value : share) value *= material_->density() * (volume / sum);
  return share;
}

void SolidBase::addMass(std::span<double> mass) const { addMasses(mass, scalesDiagonal()); }

void SolidBase::addBodyMass(std::span<double> mass) const { addMasses(mass, false); }

void SolidBase::addMasses(std::span<double> mass, bool scaled) const {
  const std::size_t n = cells_.nodes;
  const CellRule& rule = massRule(cells_.shape);
  const std::vector<PointGeometry> geometry = geometryAt(cells_, rule);
  for (std::size_t e = 0; e < cells_.size(); ++e) {
    const std::vector<double> own = elementMasses(e, rule, geometry, scaled);
    for (std::size_t a = 0; a < n; ++a) mass[static_cast<std::size_t>(cells_.node[n * e + a])] += own[a];
  }
}

StableStep SolidBase::stableStep(const Nodes& nodes) {
  requireSameNodes(nodes);
  startHistory();
  const std::size_t n = cells_.nodes, size = 3 * n;
  const CellRule& rule = massRule(cells_.shape);
  const std::vector<PointGeometry> geometry = geometryAt(cells_, rule);
  std::vector<double> largest(cells_.size());
  parallelFor(cells_.batches(), 16, [&](std::size_t begin, std::size_t end) {
    LaneVector matrix(size * size);
    Eigen::MatrixXd K(static_cast<Eigen::Index>(size), static_cast<Eigen::Index>(size));
    for (std::size_t b = begin; b < end; ++b) {
      tangent(taskOf(b, nodes, {}), matrix.data());
      for (std::size_t lane = 0; lane < cells_.inUse(b); ++lane) {
        const std::size_t e = laneCount * b + lane;
        const std::vector<double> mass = elementMasses(e, rule, geometry, scalesDiagonal());
        for (std::size_t r = 0; r < size; ++r)
          for (std::size_t c = 0; c < size; ++c)
            K(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
                0.5 * (matrix[size * r + c][static_cast<int>(lane)] + matrix[size * c + r][static_cast<int>(lane)]) /
                std::sqrt(mass[r / 3] * mass[c / 3]);
        largest[e] = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K, Eigen::EigenvaluesOnly).eigenvalues().tail(1)[0];
      }
    }
  });
  const auto worst = std::max_element(largest.begin(), largest.end());
  return {2.0 / std::sqrt(*worst), cells_.number[static_cast<std::size_t>(worst - largest.begin())]};
}

}  // namespace dovetail::fem::detail
