// When a list of what is near a wall has to be made anew.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::dem {

/// How many periods along each axis a particle counts as moved.
using Image = std::array<int, 3>;

/// Bounds on how far anything has moved since the last search at a wall, m.
struct Moves {
  static constexpr double unknown = std::numeric_limits<double>::infinity();
  double particles = unknown;  ///< any particle; unknown: the search is made anew
  double wall = unknown;       ///< any vertex of a triangulated wall; unknown: the vertices are compared
  /// The same for particles since the last build of a pair list, and the number of that build (PairList::travel and
  /// builds): a list that measures distances excludes motion to and fro.
  double sinceBuild = unknown;
  std::int64_t build = -1;
};

/// Bound on how far any particle is from where it was at a search, m. Moves by whole periods do not count.
struct ParticleTravel {
  double bound = 0.0;
  double atBuild = 0.0;  ///< the bound when the pair list was last made
  std::int64_t build = -1;

  void add(const Moves& moves) {
    bound += moves.particles;
    if (moves.build != build) {
      build = moves.build;
      atBuild = bound;
    } else {
      bound = std::min(bound, atBuild + moves.sinceBuild);
    }
  }
  void reset(const Moves& moves) { *this = {0.0, moves.build < 0 ? 0.0 : moves.sinceBuild, moves.build}; }
};

/// A maximum for parallelSum. A NaN stays.
struct Largest {
  double value = 0.0;
  void meet(double x) {
    if (!(x <= value || std::isnan(value))) value = x;
  }
  Largest& operator+=(const Largest& other) {
    meet(other.value);
    return *this;
  }
};

/// Lengths of the periods, m; 0 where space does not repeat.
inline Vec3 periodsOf(const geometry::Periodicity& periodicity) {
  Vec3 period;
  for (int k = 0; k < 3; ++k)
    if (periodicity.axes[static_cast<std::size_t>(k)]) period[k] = periodicity.length(k);
  return period;
}

/// Whole periods in d, rounded to the nearest: d − shiftOf(result) is the shortest image of d.
inline Image periodsIn(const Vec3& d, const Vec3& period) {
  Image image{};
  for (int k = 0; k < 3; ++k)
    if (period[k] > 0.0) image[static_cast<std::size_t>(k)] = static_cast<int>(std::round(d[k] / period[k]));
  return image;
}

inline Vec3 shiftOf(const Image& image, const Vec3& period) {
  return {image[0] * period.x, image[1] * period.y, image[2] * period.z};
}

}  // namespace dovetail::dem
