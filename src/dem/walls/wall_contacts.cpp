#include "dovetail/dem/walls/wall_contacts.hpp"

#include <algorithm>
#include <utility>

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

void renumber(WallContacts& contacts, std::span<const int> newNumber) {
  WallSprings& springs = contacts.springs;
  const WallSprings old = std::move(springs);
  springs = {};
  const std::size_t count = old.particle.size(), components = count == 0 ? 0 : old.memory.size() / count;
  std::vector<std::pair<int, std::size_t>> kept;
  for (std::size_t c = 0; c < count; ++c)
    if (const int i = newNumber[static_cast<std::size_t>(old.particle[c])]; i >= 0) kept.emplace_back(i, c);
  std::sort(kept.begin(), kept.end());
  for (const auto& [i, c] : kept) {
    springs.particle.push_back(i);
    springs.facet.push_back(old.facet[c]);
    springs.normal.push_back(old.normal[c]);
    for (std::size_t m = 0; m < components; ++m) springs.memory.push_back(old.memory[c * components + m]);
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
