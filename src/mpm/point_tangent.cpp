#include <algorithm>
#include <cmath>

#include "dovetail/linalg/block_matrix.hpp"
#include "points.hpp"

namespace dovetail::mpm::detail {

using fem::Instant;
using fem::Nodes;

/// V₀ ∂(P F₀ᵀ)_ij/∂(∇u)_kl, [9 (3 i + j) + 3 k + l].
std::array<double, 81> Points::moduli(std::size_t p) const {
  std::array<double, 81> A{};
  const double *const T = &answers_.tangent()[81 * p], *const F0 = &F0_[9 * p];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t l = 0; l < 3; ++l) {
          double sum = 0.0;
          for (std::size_t J = 0; J < 3; ++J)
            for (std::size_t L = 0; L < 3; ++L) sum += T[9 * (3 * i + J) + 3 * k + L] * F0[3 * j + J] * F0[3 * l + L];
          A[9 * (3 * i + j) + 3 * k + l] = volume_[p] * sum;
        }
  return A;
}

void Points::addPattern(linalg::MatrixPattern& pattern) const {
  for (std::size_t c = 0; c < rows_.cells(); ++c) {
    const auto own = std::span(rows_.node).subspan(rows_.perPoint * c, rows_.perPoint);
    std::vector<int> nodes(own.begin(), own.end());
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    pattern.add(nodes);
  }
}

/// Of the points of each cell together, which share their nodes.
void Points::addTangent(const Nodes& nodes, const Instant& now, linalg::BlockMatrix& K) {
  ask(nodes, now, {.tangent = true});
  const std::size_t n = rows_.perPoint, size = 3 * n;
  std::vector<double> own(size * size);
  const auto sign = [&](std::size_t entry, std::size_t c) { return rows_.flip[entry] >> c & 1 ? -1.0 : 1.0; };
  for (std::size_t c = 0; c < rows_.cells(); ++c) {
    std::ranges::fill(own, 0.0);
    for (int q = rows_.firstOfCell[c]; q < rows_.firstOfCell[c + 1]; ++q) {
      const auto p = static_cast<std::size_t>(rows_.pointOfCell[static_cast<std::size_t>(q)]);
      const std::array<double, 81> A = moduli(p);
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b) {
          const Vec3 &sa = rows_.slope[n * p + a], &sb = rows_.slope[n * p + b];
          for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
              double sum = 0.0;
              for (int j = 0; j < 3; ++j)
                for (int l = 0; l < 3; ++l)
                  sum += A[9 * (3 * i + static_cast<std::size_t>(j)) + 3 * k + static_cast<std::size_t>(l)] * sa[j] *
                         sb[l];
              own[size * (3 * a + i) + 3 * b + k] += sign(n * c + a, i) * sign(n * c + b, k) * sum;
            }
        }
    }
    K.add(std::span(rows_.node).subspan(n * c, n), own);
  }
}

/// Each point with its share m w of the masses of nodes is an element: ω² ≤ λ(A)/m Σ (∂w/∂x)²/w, the latter along the
/// axis where it is largest, λ(A) the largest sum of a row of the moduli.
std::optional<fem::StableStep> Points::stableStep(const Nodes& nodes) {
  ask(nodes, {}, {.tangent = true});
  double largest = 0.0;
  std::size_t worst = 0;
  for (std::size_t p = 0; p < rows_.points(); ++p) {
    const std::array<double, 81> A = moduli(p);
    double rowSum = 0.0;
    for (std::size_t r = 0; r < 9; ++r) {
      double sum = 0.0;
      for (std::size_t s = 0; s < 9; ++s) sum += std::abs(0.5 * (A[9 * r + s] + A[9 * s + r]));
      rowSum = std::max(rowSum, sum);
    }
    Vec3 reach;
    for (std::size_t a = 0; a < rows_.perPoint; ++a) {
      const double weight = rows_.weight[rows_.perPoint * p + a];
      const Vec3& slope = rows_.slope[rows_.perPoint * p + a];
      for (int i = 0; i < 3; ++i)
        if (slope[i] != 0.0) reach[i] += slope[i] * slope[i] / weight;
    }
    const double own = rowSum * std::max({reach.x, reach.y, reach.z}) / carried_.mass[p];
    if (!(own <= largest)) largest = own, worst = p;
    if (std::isnan(own)) break;
  }
  return fem::StableStep{{2.0 / std::sqrt(largest), {}}, static_cast<int>(worst), name(), -1, "point"};
}

}  // namespace dovetail::mpm::detail
