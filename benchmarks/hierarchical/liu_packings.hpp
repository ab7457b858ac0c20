// Packings like those of Liu 2018: dense, made without friction, cut open.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/packing.hpp"

namespace dovetail::benchmark {

struct PackingSettings {
  int count;           ///< grains before the border is copied
  double least, most;  ///< radii, m
  double density;      ///< kg/m³, discs 1 m thick
  rve::Springs springs;
};

/// Pressed to 1e-4 k_n without friction; the next seed is taken where no frame can be cut.
inline rve::Cell densePacking(const PackingSettings& s, std::uint64_t& seed) {
  for (;; ++seed) {
    rve::Cell cell = rve::randomCell({.count = s.count,
                                      .sizes = dem::UniformSizes{s.least, s.most},
                                      .thickness = 1.0,
                                      .density = s.density,
                                      .seed = seed},
                                     s.springs);
    const double pressure = 1e-4 * s.springs.stiffness;
    try {
      rve::compress(cell, {.pressure = {pressure, pressure, pressure}, .friction = 0.0, .tolerance = 1e-2});
      rve::framed(cell, rve::everywhere(rve::Condition::periodic));
      return cell;
    } catch (const Error&) {
      if (seed > 1000) throw;
    }
  }
}

/// Cauchy stress of a framed cell, Pa.
inline Eigen::Matrix3d cauchyOf(const rve::Cell& cell) {
  const Eigen::Matrix3d& F = cell.state.F;
  return rve::stressOfReactions(cell) * F.transpose() / F.determinant();
}

struct Mean {
  double mean = 0.0, scatter = 0.0;
};
inline Mean meanOf(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, n > 1.0 ? std::sqrt(squares / (n - 1.0)) : 0.0};
}

}  // namespace dovetail::benchmark
