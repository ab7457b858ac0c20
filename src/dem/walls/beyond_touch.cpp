// Contacts with facets that a particle does not touch.
#include "facet_view.hpp"
#include "wall_sweep.hpp"

namespace dovetail::dem {

void appendBeyondTouch(const Encounter& e, const TriangulatedWall& wall, double reach, double alike, std::size_t first,
                       WallContacts& contacts) {
  while (true) {
    FacetView nearest, seen;
    std::size_t entry = 0;
    for (std::size_t k = 0; k < e.size(); ++k) {
      if (!e.mayBeWithin(k, reach)) continue;
      const FacetCorners corners(wall, e.facet[k], e.seenFrom(k));
      if (corners.beyond(e.radius + reach)) continue;
      viewFacet({}, corners, e.radius, e.radius + reach, wall.oneSided, seen);
      if (!(seen.distance >= e.radius && seen.distance < e.radius + reach && seen.distance < nearest.distance))
        continue;
      const auto isAlike = [&](std::size_t c) { return dot(contacts.normal[c], seen.normal) > alike; };
      bool met = false;
      for (std::size_t c = first; c < contacts.size() && !met; ++c) met = isAlike(c);
      if (met) continue;
      nearest = seen;
      entry = k;
    }
    if (nearest.distance == FacetView::unseen) return;
    addContact(contacts, e, entry, nearest.weight, nearest.normal, e.radius - nearest.distance, 1.0, 1.0);
  }
}

}  // namespace dovetail::dem
