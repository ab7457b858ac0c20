// Which facets a particle may soon touch: found through the hierarchical grid, reused while nobody has moved far.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/walls/wall.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::dem {

/// Facets within radius + skin of each particle at the time of building (Cheng et al. 2022, Algorithm 2: facet boxes
/// are looked up in a grid of the particles). Only particles that have candidates are listed.
struct WallCandidates {
  double skin = 0.0;          ///< m; larger = fewer rebuilds, longer lists. A tenth to a half of the radius is sensible
  std::vector<int> particle;  ///< ascending
  std::vector<int> offsets;   ///< facets of particle[k]: facet[offsets[k]] … facet[offsets[k + 1] − 1]
  std::vector<int> facet;     ///< ascending for each particle
  /// Rigid walls only, else empty: per listed particle, whether all its facets lie in one plane and face the same way.
  std::vector<char> flat;
  mutable std::vector<int> lastFacet;  ///< the same length: where the contact was, as a place to look first

  std::int64_t builds = 0;      ///< how often the lists were made
  std::int64_t lateBuilds = 0;  ///< how often a scan of the wall found the skin used up before the scan; see below

  // Where everybody was when the lists were made.
  std::vector<Vec3> particleAtBuild, vertexAtBuild;
  double particleTravel = 0.0;  ///< bound on how far any particle has moved since, m; if `particleStep` is given
  std::size_t facetsAtBuild = 0;
  double vertexTravel = 0.0;  ///< largest displacement of a vertex at the last scan, m
  std::int64_t updatesSinceBuild = 0, nextScan = 0;
  geometry::HierarchicalGrid grid;
  std::vector<std::array<int, 2>> pairScratch;
};

/// Makes the lists anew.
/// @throws InputError if skin is not finite and ≥ 0; NumericalError naming a particle or vertex that is not finite
void findWallCandidates(const Particles& particles, const TriangulatedWall& wall, double skin,
                        WallCandidates& candidates);

/// Makes the lists anew if particles and vertices may together have used up the skin since the lists were made, or if
/// the number of particles or facets changed. Returns whether it did.
///
/// @param wallTravel  an upper bound, m, on how far any vertex has moved since the lists were made (0 for a wall at
///   rest): the lists last while it plus the particles' largest displacement is within the skin, and nothing is spent
///   per vertex. Without it particles and vertices get half of the skin each, and the vertices are scanned, not at
///   every call but so often (1, 2, 4 … at most 64 calls apart) that a vertex four times as fast as the fastest so far
///   is still caught in time. Should a scan come too late all the same, `lateBuilds` counts it.
/// @param particleStep a bound, m, on how far any particle has moved since the last call: then not every particle is
///   looked at
bool updateWallCandidates(const Particles& particles, const TriangulatedWall& wall, WallCandidates& candidates,
                          std::optional<double> wallTravel = std::nullopt,
                          std::optional<double> particleStep = std::nullopt);

}  // namespace dovetail::dem
