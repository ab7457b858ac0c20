// The contacts of a state one by one, for fields, averages and files.
#pragma once

#include <algorithm>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bodies/clumps.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "dovetail/dem/walls/wall_contacts.hpp"

namespace dovetail::dem {

/// Contacts that carry a force; all arrays have one entry per contact.
struct ContactSample {
  std::vector<int> first;   ///< particle
  std::vector<int> second;  ///< particle, or −1 for a wall
  std::vector<Vec3> from;   ///< centre of the first, m
  /// Centre of the second (its image next to the first one), or the contact point on the wall, m.
  std::vector<Vec3> to;
  std::vector<Vec3> point;   ///< middle of the overlap, or the contact point on the wall, m
  std::vector<Vec3> normal;  ///< unit, from the second to the first
  std::vector<Vec3> force;   ///< on the first, N; the second gets the opposite
  /// N m, on the first about `from`, and on the second about `to`; zero where the law exerts no torques.
  std::vector<Vec3> torqueFirst, torqueSecond;

  std::size_t size() const { return first.size(); }
};

namespace detail {
/// Some pairs out of a list, each with two particles of its own, so that the force on a particle is that of its pair.
struct PairsApart {
  Particles particles;
  PairList list;
  explicit PairsApart(std::size_t count);
  /// Takes the pairs from number `first` on. @param memory numbers that the law remembers per contact
  void take(const Particles& particles, const PairList& list, std::size_t first, int memory);
};
/// Appends those of the pairs that carry a force. @param first their number in the list
void appendPairs(const PairsApart& apart, const PairList& list, std::size_t first, ContactSample& sample);
void reserve(ContactSample& sample, std::size_t contacts);
/// One after the other.
ContactSample joined(std::vector<ContactSample> parts);
/// @throws InputError unless the list has as many memories as a law asks for
void requireMemory(const PairList& list, int memory);
/// ContactLaws::sample, with the law known.
template <class Law>
ContactSample samplePairs(const Particles& particles, const PairList& list, const PreparedLaws<Law>& laws) {
  requireMemory(list, Law::memory);
  constexpr double noTime = 1e-100;  // so short a step that no memory advances
  constexpr std::size_t atOnce = 64, chunkSize = 16 * atOnce;
  std::vector<ContactSample> parts((list.size() + chunkSize - 1) / chunkSize);
  parallelFor(list.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    ContactSample& part = parts[begin / chunkSize];
    reserve(part, end - begin);
    for (std::size_t first = begin; first < end;) {
      const std::size_t left = end - first, rounds = std::max<std::size_t>(left / atOnce, 1);
      PairsApart apart(std::min(left, atOnce));
      for (std::size_t r = 0; r < rounds; ++r, first += apart.list.size()) {
        apart.take(particles, list, first, Law::memory);
        collide(apart.particles, apart.list, laws, noTime, Booking::off);
        appendPairs(apart, list, first, part);
      }
    }
  });
  return joined(std::move(parts));
}

}  // namespace detail

/// Appends the contacts with a wall, with the forces that the last sweep has set: one for each facet that takes part.
void addWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallContacts& contacts,
                     ContactSample& sample);
void addWallContacts(const Particles& particles, const PrimitiveWall& wall, ContactSample& sample);

/// Moves the ends of branches from members of clumps to the centres of their bodies: forces run through a rigid body,
/// and the stress of an assembly of bodies is a sum over branches between their centres. Torques are about these ends
/// then. Points, normals, forces and the numbers of the particles stay. For the kinetic part of a stress take bodies
/// instead of their members.
/// @param particles, bodies as they were when the sample was taken
/// @param space the particles': members lie at any image
void joinMembers(const Particles& particles, const Bodies& bodies, const Clumps& clumps,
                 const geometry::Periodicity& space, ContactSample& sample);

}  // namespace dovetail::dem
