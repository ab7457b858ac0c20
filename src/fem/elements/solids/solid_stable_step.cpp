// The stiffest element of a solid.
#include <Eigen/Eigenvalues>
#include <map>
#include <numeric>

#include "dovetail/core/parallel.hpp"
#include "solid_base.hpp"

namespace dovetail::fem::detail {

namespace {

/// M^(−½) K M^(−½) of one lane, symmetrised, of the first components of each node; zero for the others.
Eigen::MatrixXd scaledStiffness(const LaneVector& K, std::span<const double> mass, std::size_t components,
                                std::size_t lane) {
  const std::size_t size = 3 * mass.size();
  Eigen::MatrixXd A(static_cast<Eigen::Index>(size), static_cast<Eigen::Index>(size));
  for (std::size_t r = 0; r < size; ++r)
    for (std::size_t c = 0; c < size; ++c)
      A(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
          r % 3 >= components || c % 3 >= components
              ? 0.0
              : 0.5 * (K[size * r + c][static_cast<int>(lane)] + K[size * c + r][static_cast<int>(lane)]) /
                    std::sqrt(mass[r / 3] * mass[c / 3]);
  return A;
}

/// Elements with the same invariants have the same eigenvalues, up to their eighth digit.
struct Invariants {
  double trace, squares, bound;
  auto key() const {
    const auto rounded = [](double x) { return std::round(x > 0.0 ? 1e9 * std::log(x) : -1e300); };
    return std::array{rounded(trace), rounded(squares), rounded(bound)};
  }
};

}  // namespace

/// Bounds (row sums) of all elements are cheap; eigenvalues are computed from the largest bound down, once per kind of
/// element, until no bound that is left reaches the largest eigenvalue found.
std::optional<StableStep> SolidBase::stableStep(const Nodes& nodes) {
  requireSameNodes(nodes);
  needGeometry();
  ask(nodes, {}, {.tangent = true});
  evaluation_.known = false;
  const std::size_t size = 3 * cells_.nodes;
  const auto matrixOf = [&](std::size_t e, LaneVector& K) {
    return scaledStiffness(K, lumpedMass(cells_, e, density()), static_cast<std::size_t>(dimensionOf(cells_.shape)),
                           e % laneCount);
  };
  std::vector<Invariants> known(cells_.size());
  parallelFor(cells_.batches(), 16, [&](std::size_t begin, std::size_t end) {
    LaneVector K(size * size);
    for (std::size_t b = begin; b < end; ++b) {
      tangent(taskOf(b, nodes, {}), K.data());
      for (std::size_t e = laneCount * b; e < laneCount * b + cells_.inUse(b); ++e) {
        const Eigen::MatrixXd A = matrixOf(e, K);
        known[e] = {A.trace(), A.squaredNorm(), A.cwiseAbs().rowwise().sum().maxCoeff()};
      }
    }
  });
  std::vector<std::size_t> order(cells_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  // A NaN is the first: it must not be passed over.
  const auto rank = [&](std::size_t e) { return std::isnan(known[e].bound) ? HUGE_VAL : known[e].bound; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) > rank(b); });
  std::map<std::array<double, 3>, bool> done;
  double largest = 0.0;
  std::size_t worst = order.front();
  LaneVector K(size * size);
  for (const std::size_t e : order) {
    if (rank(e) < largest) break;
    if (!done.try_emplace(known[e].key(), true).second) continue;
    tangent(taskOf(e / laneCount, nodes, {}), K.data());
    const double own =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrixOf(e, K), Eigen::EigenvaluesOnly).eigenvalues().tail(1)[0];
    if (own > largest || std::isnan(own)) {
      largest = own;
      worst = e;
    }
    if (std::isnan(own)) break;
  }
  const double h = 2.0 / std::sqrt(largest), tau = points_->dampingTime();
  return StableStep{{tau > 0.0 ? h * h / (std::hypot(tau, h) + tau) : h, {}}, cells_.number[worst], name()};
}

}  // namespace dovetail::fem::detail
