// The search for the modes of an enhanced brick in which its stress is in equilibrium.
//
// Steps are K⁻¹ r, and their size measures the distance too: a step is taken if the next one, with the same K⁻¹, is
// smaller (the natural monotonicity test of Deuflhard, Newton Methods for Nonlinear Problems, 2004, sec. 3.3). Unlike
// the residual it is blind to how much stiffer the volume is than the shape.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "enhanced_modes.hpp"

namespace dovetail::fem::detail::enhanced {

inline constexpr int maxIterations = 40;
inline constexpr double relativeTolerance = 1e-10;
/// A kept inverse is good enough while each step is at most this fraction of the one before.
inline constexpr double goodContraction = 0.25;
/// Broyden's steps wander before they close in: one start or another does.
inline constexpr int maxLearningSteps = 300;
inline constexpr std::array guards{1.0, 0.1, 10.0};
/// With more steps than this it is worth a new one.
inline constexpr int fewIterations = 5;

/// A matrix to the digits that a guess needs.
using NarrowMatrix = std::array<float, M * M * laneCount>;
inline NarrowMatrix narrowed(const ModeMatrix& A) {
  NarrowMatrix narrow;
  for (std::size_t k = 0; k < M * M; ++k)
    for (std::size_t lane = 0; lane < laneCount; ++lane) {
      const auto entry = static_cast<float>(A[k][static_cast<int>(lane)]);
      narrow[laneCount * k + lane] = std::isfinite(entry) ? entry : 0.0f;
    }
  return narrow;
}
inline ModeMatrix widened(const NarrowMatrix& narrow) {
  ModeMatrix A;
  for (std::size_t k = 0; k < M * M; ++k)
    for (std::size_t lane = 0; lane < laneCount; ++lane) A[k][static_cast<int>(lane)] = narrow[laneCount * k + lane];
  return A;
}

/// Largest magnitude per lane; NaN if one is.
DOVETAIL_INLINE Lane largest(const Modes& x) {
  Lane size = magnitude(x[0]);
  for (std::size_t m = 1; m < M; ++m) {
    const Lane other = magnitude(x[m]);
    size = ((other > size) | (other != other)) ? other : size;
  }
  return size;
}

/// Bits of the lanes whose residual is not yet zero.
inline unsigned openLanes(const Modes& residual, const Modes& tolerance) {
  unsigned open = 0;
  for (std::size_t m = 0; m < M; ++m)
    for (int lane = 0; lane < laneCount; ++lane)
      if (!(std::abs(residual[m][lane]) <= tolerance[m][lane])) open |= 1u << lane;
  return open;
}

/// Bits of the lanes with size < limit.
inline unsigned lanesBelow(const Lane& size, const Lane& limit) {
  unsigned below = 0;
  for (int lane = 0; lane < laneCount; ++lane)
    if (size[lane] < limit[lane]) below |= 1u << lane;
  return below;
}

/// x = from in some lanes.
template <std::size_t size>
void copyLanes(unsigned lanes, const Lanes<size>& from, Lanes<size>& x) {
  for (int lane = 0; lane < laneCount; ++lane)
    if (lanes >> lane & 1)
      for (std::size_t k = 0; k < size; ++k) x[k][lane] = from[k][lane];
}

/// Broyden's good update of K⁻¹ after a step −K⁻¹ r that led from the residual `before` to `after`.
inline void learn(const Modes& before, const Modes& after, const Modes& step, ModeMatrix& inverse) {
  for (int lane = 0; lane < laneCount; ++lane) {
    std::array<double, M> image{}, along{};  // K⁻¹ Δr, and Δαᵀ K⁻¹
    double size = 0.0;
    for (std::size_t m = 0; m < M; ++m)
      for (std::size_t n = 0; n < M; ++n) {
        image[m] += inverse[M * m + n][lane] * (after[n][lane] - before[n][lane]);
        along[n] -= step[m][lane] * inverse[M * m + n][lane];
      }
    for (std::size_t m = 0; m < M; ++m) size -= step[m][lane] * image[m];
    if (!(std::abs(size) > 0.0)) continue;
    for (std::size_t m = 0; m < M; ++m)
      for (std::size_t n = 0; n < M; ++n) inverse[M * m + n][lane] += (-step[m][lane] - image[m]) * along[n] / size;
  }
}

/// What is left of the balance of the modes, and the lanes in which it is not zero.
struct alignas(laneBytes) Unbalanced {
  Modes residual;
  unsigned open;
};

/// The way of the modes.
struct Search {
  Modes base{}, step{};  ///< last place whose step was taken, and that step or what is left of it
  Lane size{};           ///< of the whole step

  /// Some lanes go on from α by a step.
  void go(unsigned lanes, const Modes& next, Modes& alpha) {
    const Lane whole = largest(next);
    copyLanes(lanes, alpha, base);
    copyLanes(lanes, next, step);
    for (int lane = 0; lane < laneCount; ++lane)
      if (lanes >> lane & 1) size[lane] = whole[lane];
    take(lanes, alpha);
  }
  /// Others had gone too far.
  void halve(unsigned lanes, Modes& alpha) {
    Modes half;
    for (std::size_t m = 0; m < M; ++m) half[m] = 0.5 * step[m];
    copyLanes(lanes, half, step);
    take(lanes, alpha);
  }

private:
  void take(unsigned lanes, Modes& alpha) const {
    Modes next;
    for (std::size_t m = 0; m < M; ++m) next[m] = base[m] - step[m];
    copyLanes(lanes, next, alpha);
  }
};

}  // namespace dovetail::fem::detail::enhanced
