// Edge rule of Cheng et al. 2022, sec. 5.1.1 and Algorithm 1, as their code applies it.
#include <vector>

#include "facet_view.hpp"
#include "wall_sweep.hpp"

namespace dovetail::dem {

namespace {

struct Touch {
  int facet;
  FacetView view;
};

void paperContacts(int particle, const Vec3& x, double radius, const TriangulatedWall& wall,
                   std::span<const int> facets, std::vector<Touch>& touches, WallContacts& contacts) {
  touches.clear();
  std::size_t largest = 0;
  for (const int facet : facets) {
    const FacetCorners corners(wall, facet, x);
    if (corners.beyond(radius)) continue;
    const FacetView view = viewFacet({}, corners, radius, radius, wall.oneSided);
    if (!(view.distance < radius)) continue;
    touches.push_back({facet, view});
    if (view.distance < touches[largest].view.distance) largest = touches.size() - 1;
  }
  if (touches.empty()) return;
  const auto kept = [&](std::size_t i) {
    return i == largest || (touches[largest].view.face() && touches[i].view.face());
  };
  double sum = 0.0;
  for (std::size_t i = 0; i < touches.size(); ++i)
    if (kept(i)) sum += radius - touches[i].view.distance;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    if (!kept(i)) continue;
    const FacetView& view = touches[i].view;
    const double overlap = radius - view.distance, share = overlap / sum;
    addContact(contacts, particle, touches[i].facet, view.weight, view.normal, share * overlap, share);
  }
}

}  // namespace

void paperWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                       WallContacts& contacts) {
  sweepParticles(candidates, contacts, [&](std::size_t, int particle, std::span<const int> facets, WallContacts& into) {
    thread_local std::vector<Touch> touches;
    const auto i = static_cast<std::size_t>(particle);
    paperContacts(particle, particles.x[i], particles.radius[i], wall, facets, touches, into);
  });
}

}  // namespace dovetail::dem
