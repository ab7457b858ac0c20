// A discrete gradient for elements of any formulation: the force at the mean state, and forces along the lines between
// all pairs of nodes that give the step the right work.
//
// With f̄ = f(ū), ū = ½(u₀ + u₁), and the changes Δℓ² of the squared distances, f = f̄ + λ Σ Δℓ²_ab x̄_ab on a, −x̄_ab
// on b. Δℓ²_ab = 2 x̄_ab·Δu_ab, so λ = 2(W₁ − W₀ − f̄·Δu)/Σ(Δℓ²)² makes f·Δu = W₁ − W₀; central forces leave sum and
// moment about the mean positions alone (Gonzalez 2000, with squared distances in place of the metric).
#pragma once

#include "elements/lanes/lane.hpp"

namespace dovetail::fem::detail {

/// While no distance between nodes changes its vector by more than this fraction, the work of the force on the straight
/// path by three Gauss points, the mean state among them, is as exact as W₁ − W₀ (its error is of seventh order), and
/// free of the cancellation of that difference.
inline constexpr double shortMove = 1e-2;
/// Changes of distance below this fraction of the motion are a turn and round-off: they are given no work.
inline constexpr double negligibleChange = 1e-7;

/// Adds to the mean force of a batch what its work lacks.
/// @param x     mean positions, [3 a + i], m
/// @param du    u₁ − u₀
/// @param lack  W₁ − W₀ − f̄·Δu, J
/// @param f     ∂U/∂u, N
DOVETAIL_INLINE void addPairForces(std::size_t nodes, const Lane* x, const Lane* du, Lane lack, Lane* f) {
  Lane squares{}, motion{};
  const auto forEachPair = [&](auto&& visit) __attribute__((always_inline)) {
    for (std::size_t a = 0; a < 3 * nodes; a += 3)
      for (std::size_t b = 0; b < a; b += 3) {
        Lane line[3], move[3];
        for (std::size_t i = 0; i < 3; ++i) line[i] = x[a + i] - x[b + i], move[i] = du[a + i] - du[b + i];
        visit(a, b, line, move, line[0] * move[0] + line[1] * move[1] + line[2] * move[2]);
      }
  };
  forEachPair([&](std::size_t, std::size_t, const Lane* line, const Lane* move, const Lane& change)
                  __attribute__((always_inline)) {
                    squares += change * change;
                    for (std::size_t i = 0; i < 3; ++i) motion += line[i] * line[i] * move[i] * move[i];
                  });
  const Lane divisor = squares + negligibleChange * negligibleChange * motion;
  const Lane factor = divisor > 0.0 ? lack / divisor : Lane{};
  forEachPair([&](std::size_t a, std::size_t b, const Lane* line, const Lane*, const Lane& change)
                  __attribute__((always_inline)) {
                    for (std::size_t i = 0; i < 3; ++i) {
                      const Lane force = factor * change * line[i];
                      f[a + i] += force;
                      f[b + i] -= force;
                    }
                  });
}

}  // namespace dovetail::fem::detail
