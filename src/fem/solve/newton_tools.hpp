// Norms and tolerances of the solvers of a model.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "dovetail/core/parallel.hpp"
#include "dovetail/core/team.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/linalg/block_matrix.hpp"

namespace dovetail::fem::detail {

/// Σ a · b in a fixed order.
inline double innerProduct(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}
inline double innerProduct(std::span<const Vec3> a, std::span<const Vec3> b) {
  return parallelSum(a.size(), 4096, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t n = begin; n < end; ++n) sum += dot(a[n], b[n]);
    return sum;
  });
}
/// Euclidean norms.
inline double normOf(std::span<const double> x) { return std::sqrt(innerProduct(x, x)); }
inline double normOf(std::span<const Vec3> x) { return std::sqrt(innerProduct(x, x)); }

/// How well forces can be known, from a stiffness.
class ForceResolution {
public:
  /// F = 1 + ∂u/∂X is known to ε, however small ∂u/∂X is: as if every node were off by ε times its distance from the
  /// others.
  void measure(const linalg::BlockMatrix& K, std::span<const Vec3> X) {
    double squares = 0.0, worstSquares = 0.0;
    stiffest_ = 0.0;
    for (std::size_t n = 0; n < K.nodes(); ++n) {
      double sum = 0.0;
      for (int k = K.offsets()[n]; k < K.offsets()[n + 1]; ++k) {
        const double* const block = &K.values()[9 * static_cast<std::size_t>(k)];
        const auto other = static_cast<std::size_t>(K.columns()[static_cast<std::size_t>(k)]);
        const double largest = *std::max_element(block, block + 9), least = *std::min_element(block, block + 9);
        const double force = std::max(largest, -least) * norm(X[n] - X[other]);
        sum += force;
        squares += force * force;
        for (std::size_t c = 0; other == n && c < 3; ++c) stiffest_ = std::max(stiffest_, std::abs(block[4 * c]));
      }
      worstSquares += sum * sum;
    }
    if (K.isPart()) {
      std::array sums{squares, worstSquares};
      team().sum(sums);
      squares = sums[0], worstSquares = sums[1], stiffest_ = team().largest(stiffest_);
    }
    ofStrain_ = std::numeric_limits<double>::epsilon() * std::sqrt(squares);
    worstOfStrain_ = std::numeric_limits<double>::epsilon() * std::sqrt(worstSquares);
  }
  /// N. Displacements are known to a relative ε, hence forces to no better than ε K u; errors of strain at random.
  /// @param displacement  the norm of all, m
  double at(double displacement) const { return std::max(ofDisplacement(displacement), ofStrain_); }
  /// The same with errors that add up, as nearly incompressible solids can make them: where nothing but a step that
  /// fails would come of asking for more.
  double worstAt(double displacement) const { return std::max(ofDisplacement(displacement), worstOfStrain_); }

private:
  double ofDisplacement(double displacement) const {
    return std::numeric_limits<double>::epsilon() * stiffest_ * displacement;
  }
  double stiffest_ = 0.0, ofStrain_ = 0.0, worstOfStrain_ = 0.0;
};

}  // namespace dovetail::fem::detail
