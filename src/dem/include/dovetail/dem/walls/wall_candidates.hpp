// Facets that particles may touch soon, reused while nothing has moved far.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/walls/wall.hpp"
#include "dovetail/dem/walls/wall_search.hpp"

namespace dovetail::dem {

/// Facets within radius + margin of each particle at the time of building. Only particles near the wall are listed, and
/// nothing is kept of others. In periodic space a particle may be near a facet through an image of its own.
struct WallCandidates {
  /// m; larger = fewer searches, longer lists. Unset: 0.15 of the mean diameter. 0: a search at every step.
  std::optional<double> skin;

  double reach = 0.0;  ///< m: of the law beyond touch, see ContactLaws::reach; adds to the skin, and rules see so far

  std::vector<int> particle;  ///< ascending
  std::vector<int> offsets;   ///< facets of particle[k]: facet[offsets[k]] … facet[offsets[k + 1] − 1]
  std::vector<int> facet;     ///< for each particle by image, then ascending
  /// Only where space repeats: entry by entry of `facet`, the image of the particle that is near the facet, counted
  /// from the particle's position when the list was made; and those positions, particle by particle.
  std::vector<Image> image;
  std::vector<Vec3> position;
  Vec3 period;  ///< m; 0 = does not repeat
  /// Rigid walls only, else empty: per listed particle, whether all its facets lie in one plane and face the same way.
  std::vector<char> flat;
  mutable std::vector<int> lastFacet;  ///< the same length: which of its facets the contact was on, to look there first

  double margin = 0.0;  ///< the skin in use, m
  double reachAtBuild = 0.0;
  std::int64_t builds = 0;  ///< how often the lists were made
  // What they were made from.
  std::int64_t particleRevision = -1;
  std::size_t facetsAtBuild = 0;
  std::vector<Vec3> vertexAtBuild;
  double smallestRadius = 0.0;  ///< m, of all particles
  ParticleTravel particleTravel;
  double wallTravel = 0.0;  ///< bound on how far any vertex is from where it was, m
};

/// Makes the lists anew (Cheng et al. 2022, Algorithm 2: facet boxes are looked up in a grid of the particles, here of
/// those near the wall).
/// @throws InputError if skin is not finite and ≥ 0; NumericalError naming a particle or vertex that is not finite
void findWallCandidates(const Particles& particles, const TriangulatedWall& wall, double skin,
                        WallCandidates& candidates, const geometry::Periodicity& periodicity = {});

/// Makes the lists anew if particles and vertices may together have used up the skin, or particles have been added,
/// removed or sorted. Returns whether it did.
bool updateWallCandidates(const Particles& particles, const TriangulatedWall& wall, WallCandidates& candidates,
                          const Moves& moves, const geometry::Periodicity& periodicity = {});

/// Skin to take where none is set: 0.15 of the mean diameter, m.
double defaultSkin(const Particles& particles);

}  // namespace dovetail::dem
