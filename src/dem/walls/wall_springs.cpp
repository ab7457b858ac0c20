// Tangential springs survive when a contact passes from one facet to the next.
#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/walls/wall_collide.hpp"

namespace dovetail::dem::detail {

namespace {

bool touch(const geometry::Facet& a, const geometry::Facet& b) {
  for (const int vertex : a)
    if (std::find(b.begin(), b.end(), vertex) != b.end()) return true;
  return false;
}

/// The free old spring that is on this facet or one that shares a vertex with it, and whose normal is nearest.
std::size_t bestMatch(const WallContacts& contacts, const TriangulatedWall& wall, std::size_t c, std::size_t begin,
                      std::size_t end) {
  const WallSprings& old = contacts.springs;
  const auto& facet = wall.facets[static_cast<std::size_t>(contacts.facet[c])];
  std::size_t best = end;
  double bestCosine = -2.0;
  for (std::size_t o = begin; o < end; ++o) {
    if (old.taken[o] || !touch(facet, wall.facets[static_cast<std::size_t>(old.facet[o])])) continue;
    const double cosine = dot(contacts.normal[c], old.normal[o]);
    if (cosine > bestCosine) {
      bestCosine = cosine;
      best = o;
    }
  }
  return best;
}

}  // namespace

void requireStep(double dt) { requirePositive(dt, "time step of a law that remembers"); }

EndedMemories carrySprings(WallContacts& contacts, const TriangulatedWall& wall, int memory) {
  WallSprings& springs = contacts.springs;
  const auto components = static_cast<std::size_t>(memory);
  springs.memory.resize(components * springs.particle.size());
  springs.next.assign(components * contacts.size(), 0.0);
  springs.taken.assign(springs.particle.size(), 0);
  std::size_t begin = 0;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    while (begin < springs.particle.size() && springs.particle[begin] < contacts.particle[c]) ++begin;
    std::size_t end = begin;
    while (end < springs.particle.size() && springs.particle[end] == contacts.particle[c]) ++end;
    const std::size_t match = bestMatch(contacts, wall, c, begin, end);
    if (match == end) continue;
    for (std::size_t m = 0; m < components; ++m)
      springs.next[c * components + m] = springs.memory[match * components + m];
    springs.taken[match] = 1;
  }
  EndedMemories ended;
  for (std::size_t o = 0; o < springs.particle.size(); ++o) {
    if (springs.taken[o]) continue;
    ended.particle.push_back(springs.particle[o]);
    for (std::size_t m = 0; m < components; ++m) ended.memory.push_back(springs.memory[o * components + m]);
  }
  return ended;
}

void keepSprings(WallContacts& contacts) {
  WallSprings& springs = contacts.springs;
  springs.particle = contacts.particle;
  springs.facet = contacts.facet;
  springs.normal = contacts.normal;
  springs.memory.swap(springs.next);
}

Vec3 relativeVelocity(const Particles& particles, const TriangulatedWall& wall, const WallContacts& contacts,
                      std::size_t c, bool spins) {
  const auto i = static_cast<std::size_t>(contacts.particle[c]);
  Vec3 velocity = particles.v[i] - wallVelocity(contacts, wall, c);
  if (spins && particles.rotates())
    velocity += cross(particles.omega[i], contactPoint(contacts, wall, c) - particles.x[i]);
  return velocity;
}

void addToParticles(Particles& particles, const TriangulatedWall& wall, const WallContacts& contacts, bool spins) {
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto i = static_cast<std::size_t>(contacts.particle[c]);
    particles.f[i] += contacts.force[c];
    if (spins)
      particles.torque[i] +=
          cross(contactPoint(contacts, wall, c) - particles.x[i], contacts.force[c]) + contacts.couple[c];
  }
}

}  // namespace dovetail::dem::detail
