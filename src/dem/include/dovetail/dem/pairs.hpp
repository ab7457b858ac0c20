// Particle–particle contacts: which pairs are near, and what they do to each other.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dovetail/dem/particles.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::dem {

/// Pairs closer than the sum of their radii + skin when the list was made.
struct PairList {
  double skin = 0.0;                      ///< m
  std::vector<std::array<int, 2>> pairs;  ///< i < j, sorted
  std::int64_t builds = 0;

  /// Per pair: factor on its force and energies, such as the particles' share of an overlap; empty = 1. A new list has
  /// none; whoever set it sets it again when `builds` has changed.
  std::vector<double> scale;
  std::vector<Vec3> positionAtBuild;
  std::vector<Vec3> force;    ///< per pair, on particle i, N; set by collide
  std::vector<Vec3> stretch;  ///< per pair, tangential spring, m; empty unless the law has one
  double endedStretch = 0.0;  ///< Σ|stretch|² of pairs that left the list with a spring, m²; booked by the next collide
  std::vector<int> offsets, incident;  ///< CSR: pairs of each particle, ascending
  geometry::HierarchicalGrid grid;
};

/// Makes the list anew; springs of pairs that stay are kept.
/// @throws InputError if skin is not finite and ≥ 0; NumericalError naming a particle whose position is not finite
void findPairs(const Particles& particles, double skin, PairList& list);

/// Makes the list anew if some particle has moved more than skin/2 since it was made, or their number changed.
/// Returns whether it did.
bool updatePairs(const Particles& particles, PairList& list);

}  // namespace dovetail::dem
