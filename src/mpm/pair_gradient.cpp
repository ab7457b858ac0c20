#include "dovetail/mpm/pair_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "cubes.hpp"
#include "deformation.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/linalg/block_matrix.hpp"

namespace dovetail::mpm {

namespace {

using fem::Instant;
using fem::Nodes;

constexpr std::size_t pointChunk = 256;

/// Pairs of points by the first of both, each pair twice; stiffness in J.
struct Pairs {
  std::vector<std::size_t> first{0}, other;
  std::vector<double> stiffness, sum;  // of a pair, of all pairs of a point

  template <class Visit>
  void each(std::size_t p, Visit&& visit) const {
    for (std::size_t k = first[p]; k < first[p + 1]; ++k) visit(other[k], stiffness[k]);
  }
};

/// Mean distance of points, m.
double distanceOf(const PointSolid& points, std::span<const Vec3> x) {
  const double perCell = pointsPerCell(points.grid(), x);
  return points.grid().spacing * std::pow(perCell, points.grid().plane ? -1.0 / 2.0 : -1.0 / 3.0);
}

/// Σ over the lattice of (1 − ξ²/4d²)² ξ_x²/d²: 2 · 9/16 + 4 · 1/4 in the plane, 2 · 9/16 + 8 · 1/4 + 8 · 1/16 in
/// space.
double latticeSum(bool plane) { return plane ? 2.125 : 3.625; }

Pairs pairsOf(const PointSolid& points, const MaterialPoints& start, double modulus) {
  const double d = distanceOf(points, start.x), reach = 2.0 * d;
  const double unit = 2.0 * modulus / (latticeSum(points.grid().plane) * d * d);
  const detail::Cubes cubes(reach, start.x);
  Pairs pairs;
  for (std::size_t p = 0; p < start.x.size(); ++p) {
    double sum = 0.0;
    cubes.near(start.x[p], [&](std::size_t q, double far) {
      if (q == p || !(far < reach)) return;
      const double fade = 1.0 - far * far / (reach * reach);
      pairs.other.push_back(q);
      pairs.stiffness.push_back(unit * std::sqrt(start.volume[p] * start.volume[q]) * fade * fade);
      sum += pairs.stiffness.back();
    });
    pairs.first.push_back(pairs.other.size());
    pairs.sum.push_back(sum);
  }
  return pairs;
}

class PairGradient final : public fem::Term {
public:
  PairGradient(std::shared_ptr<const PointSolid> points, const MaterialPoints& start,
               const PairGradientOptions& options)
      : points_(std::move(points)),
        name_(options.name),
        pairs_(pairsOf(*points_, start, options.modulus)),
        volume_(start.volume) {}

  std::string name() const override { return name_; }
  bool usesVelocity() const override { return false; }
  /// Borders push.
  bool actsWithin() const override { return points_->grid().borders.empty(); }
  bool hasEnergy() const override { return true; }

  void addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) override {
    addForcesAndEnergy(nodes, now, f);
  }
  double addForcesAndEnergy(const Nodes& nodes, const Instant&, std::span<Vec3> f) override {
    const std::vector<double> F = deformation(nodes);
    std::vector<double> P(F.size(), 0.0);
    const double energy = parallelSum(volume_.size(), pointChunk, [&](std::size_t begin, std::size_t end) {
      double sum = 0.0;
      for (std::size_t p = begin; p < end; ++p) sum += pull(p, F, &P[9 * p]);
      return sum;
    });
    detail::addStresses(points_->rows(), points_->grid().plane, points_->laidDeformation(), P, volume_, f);
    return energy;
  }
  double energy(const Nodes& nodes, const Instant&) override {
    const std::vector<double> F = deformation(nodes);
    return parallelSum(volume_.size(), pointChunk, [&](std::size_t begin, std::size_t end) {
      double sum = 0.0;
      std::array<double, 9> unused;
      for (std::size_t p = begin; p < end; ++p) sum += pull(p, F, unused.data());
      return sum;
    });
  }

  void addPattern(linalg::MatrixPattern& pattern) const override {
    const GridRows& rows = points_->rows();
    std::set<std::pair<int, int>> cells;
    for (std::size_t p = 0; p < volume_.size(); ++p)
      pairs_.each(p, [&](std::size_t q, double) { cells.insert(std::minmax(rows.cell[p], rows.cell[q])); });
    for (const auto& [one, other] : cells) {
      std::set<int> group;
      for (const int cell : {one, other}) {
        const auto own = nodesOf(rows, cell);
        group.insert(own.begin(), own.end());
      }
      pattern.add(std::vector<int>(group.begin(), group.end()));
    }
  }

  /// Σ_p B_pᵀ (k_p B_p − Σ_q k_pq B_q), with F_p = B_p u + F₀.
  void addTangent(const Nodes&, const Instant&, linalg::BlockMatrix& K) override {
    for (std::size_t p = 0; p < volume_.size(); ++p) {
      addProduct(p, p, pairs_.sum[p], K);
      pairs_.each(p, [&](std::size_t q, double stiffness) { addProduct(p, q, -stiffness, K); });
    }
  }

  /// ½ k |F_p − F_q|² ≤ k (|F_p|² + |F_q|²), and |Σ u_a ⊗ g_a|² ≤ (Σ |g_a|²/w_a) (Σ w_a |u_a|²): nodes that weigh
  /// little bear little of it.
  void addStiffness(const Nodes&, const Instant&, std::span<double> k) override {
    const GridRows& rows = points_->rows();
    detail::addToNodes<double>(rows, k, [&](std::size_t p, detail::OfReached<double>& sums) {
      double most = 0.0;
      for (std::size_t a = 0; a < rows.perPoint; ++a)
        if (const Vec3 g = slopeAtStart(p, a); squaredNorm(g) > 0.0)
          most += squaredNorm(g) / rows.weight[rows.perPoint * p + a];
      for (std::size_t a = 0; a < rows.perPoint; ++a)
        sums[a] += 2.0 * pairs_.sum[p] * most * rows.weight[rows.perPoint * p + a];
    });
  }

private:
  std::vector<double> deformation(const Nodes& nodes) const {
    std::vector<double> F(9 * volume_.size());
    detail::findDeformation(points_->rows(), points_->grid().plane, points_->laidDeformation(), nodes.u, F);
    return F;
  }

  /// P = Σ k (F_p − F_q)/V_p. @return half of the energy of the pairs of p
  double pull(std::size_t p, const std::vector<double>& F, double* P) const {
    std::array<double, 9> sum{};
    double energy = 0.0;
    pairs_.each(p, [&](std::size_t q, double stiffness) {
      for (std::size_t k = 0; k < 9; ++k) {
        const double apart = F[9 * p + k] - F[9 * q + k];
        sum[k] += stiffness * apart;
        energy += stiffness * apart * apart;
      }
    });
    for (std::size_t k = 0; k < 9; ++k) P[k] = sum[k] / volume_[p];
    return 0.25 * energy;
  }

  static std::span<const int> nodesOf(const GridRows& rows, int cell) {
    return std::span(rows.node).subspan(rows.perPoint * static_cast<std::size_t>(cell), rows.perPoint);
  }

  /// g_a = F₀ᵀ ∂w_a/∂x: F = F₀ + Σ u_a ⊗ g_a.
  Vec3 slopeAtStart(std::size_t p, std::size_t a) const {
    const Vec3& slope = points_->rows().slope[points_->rows().perPoint * p + a];
    const double* const F0 = &points_->laidDeformation()[9 * p];
    return {F0[0] * slope.x + F0[3] * slope.y + F0[6] * slope.z, F0[1] * slope.x + F0[4] * slope.y + F0[7] * slope.z,
            F0[2] * slope.x + F0[5] * slope.y + F0[8] * slope.z};
  }

  /// K += factor B_pᵀ B_q.
  void addProduct(std::size_t p, std::size_t q, double factor, linalg::BlockMatrix& K) const {
    const GridRows& rows = points_->rows();
    const std::size_t n = rows.perPoint, ofP = n * static_cast<std::size_t>(rows.cell[p]),
                      ofQ = n * static_cast<std::size_t>(rows.cell[q]);
    std::vector<Vec3> slopes(n);
    for (std::size_t b = 0; b < n; ++b) slopes[b] = factor * slopeAtStart(q, b);
    for (std::size_t a = 0; a < n; ++a) {
      const Vec3 own = slopeAtStart(p, a);
      for (std::size_t b = 0; b < n; ++b) {
        const double both = dot(own, slopes[b]);
        const auto signs = static_cast<std::uint8_t>(rows.flip[ofP + a] ^ rows.flip[ofQ + b]);
        const Vec3 diagonal = flipped({both, both, both}, signs);
        K.addBlock(rows.node[ofP + a], rows.node[ofQ + b],
                   std::array{diagonal.x, 0.0, 0.0, 0.0, diagonal.y, 0.0, 0.0, 0.0, diagonal.z});
      }
    }
  }

  std::shared_ptr<const PointSolid> points_;
  std::string name_;
  Pairs pairs_;
  std::vector<double> volume_;
};

}  // namespace

std::shared_ptr<fem::Term> pairGradient(std::shared_ptr<const PointSolid> points, const MaterialPoints& start,
                                        const PairGradientOptions& options) {
  const std::string where = "mpm::pairGradient";
  if (points == nullptr) throw InputError("there are no points", where, "give those of makePoints");
  requirePositive(options.modulus, "modulus of the gradient");
  if (start.x.size() != points->masses().size() || start.volume.size() != start.x.size())
    throw InputError("there are " + std::to_string(start.x.size()) + " places and " +
                         std::to_string(start.volume.size()) + " volumes for " +
                         std::to_string(points->masses().size()) + " points",
                     where, "give what makePoints got");
  if (points->renewals() > 0)
    throw InputError("the grid has been renewed", where, "add the gradient before the first step");
  return std::make_shared<PairGradient>(std::move(points), start, options);
}

}  // namespace dovetail::mpm
