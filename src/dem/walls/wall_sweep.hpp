// Runs a rule over all particles with candidates, in parallel if there are enough of them.
#pragma once

#include <span>
#include <vector>

#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/walls/wall_clearances.hpp"

namespace dovetail::dem {

/// One particle and the facets near it.
struct Encounter {
  int particle;
  Vec3 x;  ///< of the particle as the facets' images count from, m
  double radius;
  std::span<const int> facet;
  std::span<const Image> image;  ///< empty unless space repeats
  Image wrapped{};               ///< by how many periods x is off the particle's position
  Vec3 period;
  const WallClearances* clearances = nullptr;  ///< of all candidates; null: unknown
  std::size_t first = 0;                       ///< the entry of all candidates that `facet` begins with

  std::size_t size() const { return facet.size(); }
  /// Where the particle is as seen from entry k, m.
  Vec3 seenFrom(std::size_t k) const { return image.empty() ? x : x + shiftOf(image[k], period); }
  /// Whether facet k may be closer than radius + beyond, m.
  bool mayBeWithin(std::size_t k, double beyond) const {
    return !clearances || clearances->mayBeWithin(first + k, radius, beyond);
  }
};

inline Encounter encounter(const Particles& particles, const WallCandidates& candidates,
                           const WallClearances* clearances, std::size_t k) {
  const auto i = static_cast<std::size_t>(candidates.particle[k]);
  const auto first = static_cast<std::size_t>(candidates.offsets[k]);
  const auto count = static_cast<std::size_t>(candidates.offsets[k + 1]) - first;
  Encounter e{candidates.particle[k],
              particles.x[i],
              particles.radius[i],
              std::span<const int>(candidates.facet).subspan(first, count),
              {},
              {},
              {},
              clearances,
              first};
  if (candidates.image.empty()) return e;
  e.image = std::span<const Image>(candidates.image).subspan(first, count);
  e.period = candidates.period;
  e.wrapped = periodsIn(e.x - candidates.position[k], e.period);
  e.x -= shiftOf(e.wrapped, e.period);
  return e;
}

inline void addContact(WallContacts& contacts, const Encounter& e, std::size_t k, const std::array<double, 3>& weight,
                       const Vec3& normal, double overlap, double engagement, double energyFraction) {
  contacts.particle.push_back(e.particle);
  contacts.facet.push_back(e.facet[k]);
  contacts.weight.push_back(weight);
  contacts.normal.push_back(normal);
  contacts.overlap.push_back(overlap);
  contacts.engagement.push_back(engagement);
  contacts.energyFraction.push_back(energyFraction);
  if (!e.image.empty())
    contacts.image.push_back(
        {e.image[k][0] - e.wrapped[0], e.image[k][1] - e.wrapped[1], e.image[k][2] - e.wrapped[2]});
}

/// What a law that reaches beyond touch meets there: the nearest facet, and on in order of distance those whose normals
/// are far from the ones of all contacts so far.
/// @param reach      beyond touch, m
/// @param alike      cosine from which on two facets count as one
/// @param first      the particle's first contact
void appendBeyondTouch(const Encounter& e, const TriangulatedWall& wall, double reach, double alike, std::size_t first,
                       WallContacts& contacts);

/// @param clearances  null if nobody has watched
void projectWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                         const WallClearances* clearances, WallContacts& contacts);
void paperWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                       const WallClearances* clearances, WallContacts& contacts);

/// rule(k, encounter, contacts) appends the contacts of one particle, number k of the list.
template <class Rule>
void sweepParticles(const Particles& particles, const WallCandidates& candidates, const WallClearances* clearances,
                    WallContacts& contacts, Rule&& rule) {
  constexpr std::size_t chunkSize = 64;
  const std::size_t listed = candidates.particle.size();
  const auto visit = [&](std::size_t begin, std::size_t end, WallContacts& into) {
    for (std::size_t k = begin; k < end; ++k) rule(k, encounter(particles, candidates, clearances, k), into);
  };
  clear(contacts);
  contacts.period = candidates.period;
  if (threads() == 1 || listed <= chunkSize) {
    visit(0, listed, contacts);
  } else {
    std::vector<WallContacts> parts((listed + chunkSize - 1) / chunkSize);
    parallelFor(listed, chunkSize,
                [&](std::size_t begin, std::size_t end) { visit(begin, end, parts[begin / chunkSize]); });
    for (const WallContacts& part : parts)
      forArrays(contacts, part, [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); });
  }
  contacts.force.assign(contacts.size(), Vec3{});
}

}  // namespace dovetail::dem
