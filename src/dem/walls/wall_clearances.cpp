#include "dovetail/dem/walls/wall_clearances.hpp"

#include "dovetail/core/parallel.hpp"
#include "facet_view.hpp"
#include "wall_sweep.hpp"

namespace dovetail::dem {

WallClearances clearancesNow(const Particles& particles, const TriangulatedWall& wall,
                             const WallCandidates& candidates) {
  WallClearances clearances;
  clearances.whenListed.resize(candidates.facet.size());
  parallelFor(candidates.particle.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Encounter e = encounter(particles, candidates, nullptr, k);
      const auto first = static_cast<std::size_t>(candidates.offsets[k]);
      for (std::size_t entry = 0; entry < e.size(); ++entry) {
        const FacetCorners t(wall, e.facet[entry], e.seenFrom(entry));
        clearances.whenListed[first + entry] =
            norm(geometry::closestPointOnTriangle({}, t.a, t.b, t.c).point) - e.radius;
      }
    }
  });
  return clearances;
}

}  // namespace dovetail::dem
