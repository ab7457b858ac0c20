// Tangential springs survive when a contact passes from one facet to the next.
#include <algorithm>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/walls/facet_spin.hpp"
#include "dovetail/dem/walls/wall_collide.hpp"
#include "particle_runs.hpp"

namespace dovetail::dem::detail {

namespace {

/// The free old spring at the same place of the particle, told by the normal: begin to end are the particle's. Facets
/// do not matter, as surfaces go on over seams without common vertices.
std::size_t bestMatch(const WallContacts& contacts, std::size_t c, std::size_t begin, std::size_t end) {
  const WallSprings& old = contacts.springs;
  double cosine = samePlace;
  std::size_t best = end;
  for (std::size_t o = begin; o < end; ++o) {
    const double here = dot(contacts.normal[c], old.normal[o]);
    if (old.successor[o] >= 0 || !(here > cosine)) continue;
    cosine = here;
    best = o;
  }
  return best;
}

}  // namespace

void requireStep(double dt) { requirePositive(dt, "time step of a law with memory"); }

EndedMemories carrySprings(const Particles& particles, WallContacts& contacts, int memory, const WallMemoryKind& kind) {
  WallSprings& springs = contacts.springs;
  const auto components = static_cast<std::size_t>(memory);
  readAs(kind, memory, springs.particle.size(), springs.memoryKind, springs.memory);
  springs.next.assign(components * contacts.size(), 0.0);
  springs.successor.assign(springs.particle.size(), -1);
  forParticleRuns(contacts.particle, [&](std::size_t first, std::size_t last) {
    if (first >= last) return;
    const std::vector<int>& old = springs.particle;
    auto begin =
        static_cast<std::size_t>(std::lower_bound(old.begin(), old.end(), contacts.particle[first]) - old.begin());
    for (std::size_t c = first; c < last; ++c) {
      while (begin < old.size() && old[begin] < contacts.particle[c]) ++begin;
      std::size_t end = begin;
      while (end < old.size() && old[end] == contacts.particle[c]) ++end;
      const std::size_t match = bestMatch(contacts, c, begin, end);
      if (match == end) continue;
      for (std::size_t m = 0; m < components; ++m)
        springs.next[c * components + m] = springs.memory[match * components + m];
      springs.successor[match] = static_cast<int>(c);
    }
  });
  EndedMemories ended;
  for (std::size_t o = 0; o < springs.particle.size(); ++o) {
    const int c = springs.successor[o];
    const double lost = springs.fraction[o] - (c < 0 ? 0.0 : contacts.engagement[static_cast<std::size_t>(c)]);
    if (c < 0 || lost != 0.0) addEnded(ended, particles, springs.particle[o], springs.memory, o, components, lost);
  }
  return ended;
}

void keepSprings(WallContacts& contacts) {
  WallSprings& springs = contacts.springs;
  springs.particle = contacts.particle;
  springs.normal = contacts.normal;
  springs.fraction = contacts.engagement;
  springs.memory.swap(springs.next);
}

Vec3 AgainstFacets::velocity(std::size_t c) const {
  const auto i = static_cast<std::size_t>(contacts.particle[c]);
  const Vec3 relative = particles.v[i] - wallVelocity(contacts, wall, c);
  return spins ? relative + cross(particles.omega[i], contactArm(particles, contacts, wall, c)) : relative;
}

Vec3 AgainstFacets::spin(std::size_t c) const {
  const auto& vertex = wall.facets[static_cast<std::size_t>(contacts.facet[c])];
  const auto a = static_cast<std::size_t>(vertex[0]), b = static_cast<std::size_t>(vertex[1]),
             d = static_cast<std::size_t>(vertex[2]);
  if (wall.v[a] == wall.v[b] && wall.v[a] == wall.v[d]) return {};
  return FacetSpin(wall.x[a], wall.x[b], wall.x[d])(wall.v[a], wall.v[b], wall.v[d]);
}

void addToParticles(Particles& particles, const TriangulatedWall& wall, const WallContacts& contacts, bool spins) {
  forParticleRuns(contacts.particle, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      const auto i = static_cast<std::size_t>(contacts.particle[c]);
      particles.f[i] += contacts.force[c];
      if (spins)
        particles.torque[i] += cross(contactArm(particles, contacts, wall, c), contacts.force[c]) + contacts.couple[c];
    }
  });
}

void requireWallMaterials(const Particles& particles, const std::vector<int>& touching, int materials,
                          int wallMaterial) {
  if (materials == 1) return;
  if (wallMaterial < 0 || wallMaterial >= materials)
    throw InputError("there is no law for material " + std::to_string(wallMaterial), "material of a wall",
                     "give materials from 0 to " + std::to_string(materials - 1) + ", or a larger table of laws");
  if (particles.material.empty()) return;
  for (const int i : touching)
    if (const int material = particles.material[static_cast<std::size_t>(i)]; material >= materials)
      throw InputError("material " + std::to_string(material) + " has no law",
                       "particle " + std::to_string(i) + ", material",
                       "give materials from 0 to " + std::to_string(materials - 1) + ", or a larger table of laws");
}

}  // namespace dovetail::dem::detail
