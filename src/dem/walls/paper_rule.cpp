// Edge rule of Cheng et al. 2022, sec. 5.1.1 and Algorithm 1, as their code applies it.
#include <vector>

#include "facet_view.hpp"
#include "wall_sweep.hpp"

namespace dovetail::dem {

namespace {

struct Touch {
  std::size_t entry;
  FacetView view;
};

void paperContacts(const Encounter& e, const TriangulatedWall& wall, std::vector<Touch>& touches,
                   WallContacts& contacts) {
  touches.clear();
  std::size_t largest = 0;
  FacetView view;
  for (std::size_t k = 0; k < e.size(); ++k) {
    if (!e.mayBeWithin(k, 0.0)) continue;
    const FacetCorners corners(wall, e.facet[k], e.seenFrom(k));
    if (corners.beyond(e.radius)) continue;
    viewFacet({}, corners, e.radius, e.radius, wall.oneSided, view);
    if (!(view.distance < e.radius)) continue;
    touches.push_back({k, view});
    if (view.distance < touches[largest].view.distance) largest = touches.size() - 1;
  }
  if (touches.empty()) return;
  const auto kept = [&](std::size_t i) {
    return i == largest || (touches[largest].view.face() && touches[i].view.face());
  };
  double sum = 0.0;
  for (std::size_t i = 0; i < touches.size(); ++i)
    if (kept(i)) sum += e.radius - touches[i].view.distance;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    if (!kept(i)) continue;
    const FacetView& seen = touches[i].view;
    const double overlap = e.radius - seen.distance, fraction = overlap / sum;
    addContact(contacts, e, touches[i].entry, seen.weight, seen.normal, fraction * overlap, fraction, fraction);
  }
}

}  // namespace

void paperWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                       const WallClearances* clearances, WallContacts& contacts) {
  sweepParticles(particles, candidates, clearances, contacts, [&](std::size_t, const Encounter& e, WallContacts& into) {
    thread_local std::vector<Touch> touches;
    const std::size_t first = into.size();
    paperContacts(e, wall, touches, into);
    if (candidates.reach > 0.0) appendBeyondTouch(e, wall, candidates.reach, 0.2, first, into);
  });
}

void paperWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                       WallContacts& contacts) {
  paperWallContacts(particles, wall, candidates, nullptr, contacts);
}

}  // namespace dovetail::dem
