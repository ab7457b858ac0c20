// F of points by the motion of the nodes, and its transpose.
#pragma once

#include <span>
#include <vector>

#include "scatter.hpp"

namespace dovetail::mpm::detail {

/// F = (1 + Σ u ⊗ ∂w/∂x) F₀ of the points of a cell; in the plane the third row stays as it is.
template <int axes>
void deform(const GridRows& rows, std::size_t cell, const OfReached<Vec3>& u, const std::vector<double>& F0,
            std::span<double> F) {
  eachPointOf(rows, cell, [&](std::size_t p) {
    double G[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const Vec3* const slope = &rows.slope[rows.perPoint * p];
    for (std::size_t a = 0; a < rows.perPoint; ++a) addOuter<axes>(u[a], slope[a], G);
    const double* const before = &F0[9 * p];
    for (std::size_t J = 0; J < 3; ++J) {
      Vec3 column;
      addProduct<axes>(G, {before[J], before[3 + J], before[6 + J]}, column);
      F[9 * p + J] = column.x, F[9 * p + 3 + J] = column.y;
      F[9 * p + 6 + J] = axes == 3 ? column.z : before[6 + J];
    }
  });
}

/// @param F0  of the points when the grid was laid out, [9 point]
inline void findDeformation(const GridRows& rows, bool plane, const std::vector<double>& F0, std::span<const Vec3> u,
                            std::span<double> F) {
  withAxes(plane, [&](auto axes) {
    eachCell(rows, [&](std::size_t c) {
      OfReached<Vec3> seen;
      look(rows, c, u, seen);
      deform<axes>(rows, c, seen, F0, F);
    });
  });
}

/// f −= Σ V P F₀ᵀ ∂w/∂x, N: what stresses P, Pa, of points of the volumes V, m³, do.
inline void addStresses(const GridRows& rows, bool plane, const std::vector<double>& F0, std::span<const double> P,
                        const std::vector<double>& volume, std::span<Vec3> f) {
  withAxes(plane, [&](auto axes) {
    addToNodes<Vec3>(rows, f, [&](std::size_t p, OfReached<Vec3>& sums) {
      const double *const own = &P[9 * p], *const before = &F0[9 * p];
      double stress[9] = {};
      for (std::size_t J = 0; J < 3; ++J)
        addOuter<axes>({own[J], own[3 + J], own[6 + J]}, -volume[p] * Vec3{before[J], before[3 + J], before[6 + J]},
                       stress);
      const Vec3* const slope = &rows.slope[rows.perPoint * p];
      for (std::size_t a = 0; a < rows.perPoint; ++a) addProduct<axes>(stress, slope[a], sums[a]);
    });
  });
}

}  // namespace dovetail::mpm::detail
