// Packings like those of Liu 2018: dense, made without friction, cut open.
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <cstdint>

#include "dovetail/core/error.hpp"
#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/packing.hpp"

namespace dovetail::benchmark {

/// All round, without friction; what the cell is then is its new F = 1.
inline void strainTo(rve::Rve& cell, double solidFraction) {
  const rve::Springs springs = cell.springs;
  rve::Springs smooth = springs;
  smooth.friction = 0.0;
  rve::setSprings(cell, smooth);
  const double stretch = std::sqrt(rve::solidFraction(cell) / solidFraction);
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 0) = F(1, 1) = stretch;
  rve::followPath(cell, F, {.rest = {.tolerance = 1e-4}});
  rve::setSprings(cell, springs);
}

struct PackingOptions {
  int count;           ///< grains before the border is copied
  double least, most;  ///< radii, m
  double density;      ///< kg/m³, discs 1 m thick
  rve::Springs springs;
  double solidFraction = 0.0;
};

/// Pressed to 1e-4 k_n without friction, then strained to a solid fraction, if one is given, and relaxed; the next seed
/// is taken where no frame can be cut.
inline rve::Rve densePacking(const PackingOptions& s, std::uint64_t seed) {
  for (const std::uint64_t last = seed + 1000;; ++seed) {
    rve::Rve cell = rve::randomCell({.count = s.count,
                                     .sizes = dem::UniformSizes{s.least, s.most},
                                     .thickness = 1.0,
                                     .density = s.density,
                                     .seed = seed},
                                    s.springs);
    const double pressure = 1e-4 * s.springs.stiffness;
    try {
      rve::compress(cell, {.pressure = {pressure, pressure, pressure}, .friction = 0.0, .tolerance = 1e-2});
      if (s.solidFraction > 0.0) strainTo(cell, s.solidFraction);
      rve::framed(cell, rve::everywhere(rve::Condition::periodic));
      return cell;
    } catch (const Error&) {
      if (seed > last) throw;
    }
  }
}

/// Cauchy stress of a framed cell, Pa.
inline Eigen::Matrix3d cauchyOf(const rve::Rve& cell) {
  const Eigen::Matrix3d& F = cell.state.F;
  return rve::stressOfReactions(cell) * F.transpose() / F.determinant();
}

}  // namespace dovetail::benchmark
