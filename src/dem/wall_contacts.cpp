#include "dovetail/dem/wall_contacts.hpp"

namespace dovetail::dem {

void findWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                      EdgeRule rule, WallContacts& contacts) {
  switch (rule) {
    case EdgeRule::projected:
      return projectWallContacts(particles, wall, candidates, contacts);
    case EdgeRule::paper:
      return paperWallContacts(particles, wall, candidates, contacts);
  }
}

void addWallForces(const WallContacts& contacts, std::span<const geometry::Facet> facets, std::span<Vec3> f) {
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto& vertex = facets[static_cast<std::size_t>(contacts.facet[c])];
    for (std::size_t k = 0; k < 3; ++k)
      f[static_cast<std::size_t>(vertex[k])] -= contacts.weight[c][k] * contacts.force[c];
  }
}

}  // namespace dovetail::dem
