// Forces between particles.
#pragma once

#include <algorithm>
#include <cmath>

#include "dovetail/core/parallel.hpp"
#include "dovetail/core/vector_code.hpp"
#include "dovetail/dem/laws/answer.hpp"
#include "dovetail/dem/laws/listed_laws.hpp"
#include "dovetail/dem/pairs/pairs.hpp"

namespace dovetail::dem {

/// Two spheres that may touch.
struct PairContact {
  Vec3 normal;     ///< unit, from particle j to particle i
  double overlap;  ///< m, > 0 when touching
  Vec3 armI;       ///< from the centre of i to the middle of the overlap, m
  Vec3 armJ;       ///< from the centre of j, m
};

/// Where centres coincide, particle i (the lower number) is pushed towards +x.
/// @param shift added to x_i − x_j, m: for periodic images, see PairList::shift
inline PairContact pairContact(const Particles& particles, std::size_t i, std::size_t j, const Vec3& shift = {}) {
  const Vec3 d = particles.x[i] - particles.x[j] + shift;
  const double distance = norm(d);
  const Vec3 normal = distance > 0.0 ? d / distance : Vec3{1.0, 0.0, 0.0};
  const double overlap = particles.radius[i] + particles.radius[j] - distance;
  const Vec3 armI = -(particles.radius[i] - 0.5 * overlap) * normal;
  return {normal, overlap, armI, armI + d};
}

namespace detail {

/// @throws InputError unless dt is finite and > 0
void requireStep(double dt);

/// What a law asks for, and what all particles share.
struct PairRows {
  bool spins = false, rolls = false, mass = false, radius = false, varied = false;
  int memory = 0, motion = 0, materials = 1;
  bool turns = false;            ///< the law exerts torques and the particles spin
  bool spinDifferences = false;  ///< not only sums of spins count, and torques differ
  bool oneRadius = false;        ///< all particles have the same
  bool oneMass = false;
  bool velocities = true;  ///< the law sees how fast particles move
  int material = 0;        ///< of all particles; −1: they differ
};
/// Where a sweep over the pairs of a chunk stands.
struct PairCursor {
  std::size_t chunk, pair, end, image;
  std::size_t firstParticle, particles, crossing;
  bool within;  ///< no pair is of the last particle
  /// Force (and torque, if they turn) so far on each particle of the chunk, and then on the second particle of each
  /// crossing pair.
  double __attribute__((vector_size(32))) * sums;
};
/// Looks whether all particles have one radius, one mass and one material, which saves gathering them.
/// @throws InputError naming a particle whose material has no law
void findUniform(const Particles& particles, PairRows& rows);
PairCursor startOfChunk(const Particles& particles, const PairParts& list, const PairRows& rows, std::size_t chunk);
/// Adds the sums to the particles of the chunk, and keeps those for others.
void finishChunk(Particles& particles, PairParts& list, const PairRows& rows, const PairCursor& cursor);
/// Fills the rows of radii, masses and velocities once for all pairs, if they share them or nobody asks for them.
void shareSizes(const Particles& particles, const PairRows& rows, ContactBlock& block);
void gatherMasses(const Particles& particles, std::span<const std::array<int, 2>> pairs, ContactBlock& block);
/// Effective radii from the radii.
void makeRadii(std::size_t n, ContactBlock& block);
/// Fills the block with the next pairs; returns how many.
std::size_t gatherPairs(const Particles& particles, PairParts& list, const PairRows& rows, PairCursor& cursor,
                        ContactBlock& block);
/// Adds the block's forces to the sums; moves on.
void scatterPairs(const PairParts& list, const PairRows& rows, std::size_t n, PairCursor& cursor,
                  const ContactBlock& block);
/// Adds what pairs of other chunks do to particles.
void addCrossing(Particles& particles, const PairParts& list, bool spins);
/// The contact of a pair that went with a particle, as if nobody moved.
Contact atRest(const EndedPair& pair);

/// What pairs that have left the list hold, J in place of W. Those that went with a particle and still touch hold their
/// normal springs' energy, which counts as fracture, and have lost nothing else yet.
template <class Law>
ContactWork endedWork(const EndedPairs& left, const PreparedLaws<Law>& laws) {
  constexpr auto numbers = static_cast<std::size_t>(Law::memory);
  ContactWork work;
  if (left.memory.size() != numbers * left.pairs.size()) return work;
  for (std::size_t k = 0; k < left.pairs.size(); ++k) {
    const EndedPair& pair = left.pairs[k];
    if (std::max(pair.materials[0], pair.materials[1]) >= laws.materials && laws.materials > 1) continue;
    const auto& law = laws.materials == 1 ? laws.table[0] : laws.at(pair.materials[0], pair.materials[1]);
    double memory[numbers + 1] = {};
    std::copy_n(left.memory.data() + k * numbers, numbers, memory);
    ContactWork ended = law.ended(memory, 1.0);
    if (pair.overlap > -law.reach()) {
      ended.fracturePower = law.respond(atRest(pair), memory).work.elasticEnergy;
      ended.plasticPower = 0.0;
    }
    work.frictionPower += pair.factor * ended.frictionPower;
    work.rollingPower += pair.factor * ended.rollingPower;
    work.plasticPower += pair.factor * ended.plasticPower;
    work.fracturePower += pair.factor * ended.fracturePower;
  }
  return work;
}

/// All of it, as lost in one step, W: whole, whatever the next step's length.
template <class Law>
ContactWork bookEnded(const EndedPairs& left, const PreparedLaws<Law>& laws, double dt) {
  ContactWork work = endedWork(left, laws);
  for (double* const power : {&work.frictionPower, &work.rollingPower, &work.plasticPower, &work.fracturePower})
    *power /= dt;
  return work;
}

/// Whether forces depend on how fast particles move. Of the laws that the library lists, those that remember nothing
/// ask for velocities in their dashpots alone, as they do for masses.
template <class Law>
bool seesVelocities(const PreparedLaws<Law>& laws) {
  return Law::memory > 0 || !isListed<Law> || laws.usesMass();
}

/// @param laws  the table, or the only law that occurs
template <class Law, BlockOptions options>
ContactWork collideChunk(Particles& particles, PairParts& list, std::size_t chunk, const PairRows& rows,
                         const typename Law::Prepared* laws, double dt) {
  ContactBlock block;
  shareSizes(particles, rows, block);
  ContactWork work;
  PairCursor cursor = startOfChunk(particles, list, rows, chunk);
  while (cursor.pair < cursor.end) {
    const std::size_t n = gatherPairs(particles, list, rows, cursor, block);
    withVectors([&] { answer<Law, options>(block, n, laws, dt); });
    scatterPairs(list, rows, n, cursor, block);
    if constexpr (options.booked) work += sumWork(block, n);
  }
  finishChunk(particles, list, rows, cursor);
  return work;
}

template <class Law, BlockOptions options>
ContactWork collideChunks(Particles& particles, PairParts& list, const PairRows& rows,
                          const typename Law::Prepared* laws, double dt) {
  const ContactWork work = parallelSum(list.chunks.count(), 1, [&](std::size_t chunk, std::size_t) {
    return collideChunk<Law, options>(particles, list, chunk, rows, laws, dt);
  });
  addCrossing(particles, list, options.spins && particles.rotates());
  return work;
}

template <class Law, bool varied, Recall recall>
ContactWork collideBooked(Particles& particles, PairParts& list, const PairRows& rows,
                          const typename Law::Prepared* laws, double dt, Booking booking) {
  constexpr BlockOptions quiet{Law::rotates, false, varied, false, recall},
      booked{Law::rotates, false, varied, true, recall};
  if (booking == Booking::on) return collideChunks<Law, booked>(particles, list, rows, laws, dt);
  collideChunks<Law, quiet>(particles, list, rows, laws, dt);
  return {};
}

/// With what contacts remember known.
template <class Law>
ContactWork collideRecalled(Particles& particles, PairParts& list, const PairRows& rows,
                            const typename Law::Prepared* laws, double dt, Booking booking, Recall recall) {
  if constexpr (Law::rotates)
    if (recall == Recall::motion)
      return rows.varied ? collideBooked<Law, true, Recall::motion>(particles, list, rows, laws, dt, booking)
                         : collideBooked<Law, false, Recall::motion>(particles, list, rows, laws, dt, booking);
  if (rows.varied) return collideBooked<Law, true, Recall::approach>(particles, list, rows, laws, dt, booking);
  if (recall == Recall::approach)
    return collideBooked<Law, false, Recall::approach>(particles, list, rows, laws, dt, booking);
  return collideBooked<Law, false, Recall::nothing>(particles, list, rows, laws, dt, booking);
}

/// ContactLaws::pairs, with the law known.
template <class Law>
ContactWork collide(Particles& particles, PairList& list, const PreparedLaws<Law>& laws, double dt, Booking booking) {
  if constexpr (Law::memory > 0) requireStep(dt);
  const Recall recall = laws.recall();
  list.prepareMemory(Law::memory, Law::turns, Law::memoryKind);  // what another law has left is forgotten
  list.prepareMotion(Law::recalled(recall), recall == Recall::motion);
  PairParts& parts = partsOf(list);
  PairRows rows{.spins = Law::rotates,
                .rolls = Law::needsSpin,
                .mass = Law::needsMass && laws.usesMass(),
                .radius = Law::needsRadius,
                .memory = Law::memory,
                .motion = Law::recalled(recall),
                .materials = laws.materials,
                .velocities = seesVelocities(laws)};
  findUniform(particles, rows);
  rows.varied = !parts.factors.empty() || rows.material < 0;
  const auto* const table = rows.varied ? laws.table.data() : &laws.at(rows.material, rows.material);
  if constexpr (Law::rotates) parts.chunks.torque.resize(parts.chunks.force.size());
  ContactWork work = collideRecalled<Law>(particles, parts, rows, table, dt, booking, recall);
  const bool booked = booking == Booking::on;
  const EndedPairs left = list.takeEnded();
  if (booked && dt > 0.0) work += bookEnded(left, laws, dt);
  return work;
}

}  // namespace detail

}  // namespace dovetail::dem
