// Contacts side by side: what turns the law of one contact into a loop that vectorises.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

#include "dovetail/dem/laws/contact.hpp"

// The passes of the loop that follows do not touch each other's data. (Clang warns where it cannot use that.)
#ifdef __clang__
#define DOVETAIL_INDEPENDENT
#else
#define DOVETAIL_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace dovetail::dem::detail {

inline constexpr std::size_t blockSize = 64;
inline constexpr std::size_t channels = 8;  // of ContactWork
inline constexpr double timeless = 1e-90;   // s; in shorter steps nothing moves on and no velocity is remembered

/// Up to blockSize contacts: rows that are filled before `answer`, and rows that it fills. Rows that a law does not
/// need are never touched.
struct ContactBlock {
  using Row = std::array<double, blockSize>;
  struct Rows3 {
    alignas(64) Row x, y, z;
    Vec3 at(std::size_t l) const { return {x[l], y[l], z[l]}; }
    void set(std::size_t l, const Vec3& v) {
      x[l] = v.x;
      y[l] = v.y;
      z[l] = v.z;
    }
  };
  // Given: pairs
  Rows3 separation;                  ///< x_particle − x_partner, m
  alignas(64) Row radiusI, radiusJ;  ///< m
  // Given: walls
  Rows3 normal;                    ///< unit, from the wall to the particle
  alignas(64) Row overlap;         ///< m
  alignas(64) Row energyFraction;  ///< factor on what normal springs store and plastic flow takes
  // Given: both
  Rows3 velocity;                   ///< v_particle − v_partner, m/s: of the centres (pairs), at the contact (walls)
  Rows3 spinSum, spinDifference;    ///< ω_particle ± ω_partner, rad/s
  alignas(64) Row rootMass;         ///< √ of the effective mass, kg^½
  alignas(64) Row effectiveRadius;  ///< m
  alignas(64) Row scale;            ///< factor on forces and energies
  alignas(64) std::array<int, blockSize> kind;  ///< row of the law table
  std::array<double*, 18> memory;  ///< of the law, and of velocities (ContactLaw::recalled), by component; advanced
  bool recalls = false;            ///< velocities are remembered
  /// Of `count` rows from number `first` on, which are of velocities, says whether they are kept; if not, all are
  /// `none`.
  void recall(int first, int count, bool kept, Row& none) {
    recalls = kept;
    for (int c = first; c < first + count && !kept; ++c) memory[static_cast<std::size_t>(c)] = none.data();
  }

  // Between the passes
  Rows3 drift;  ///< what the contact's turning in a step adds to n·v (x), or to the velocity, m/s

  // Answered
  Rows3 force;                                 ///< on the particle, N
  Rows3 couple;                                ///< on the particle beyond arm × force, N m (walls)
  Rows3 torqueI, torqueJ;                      ///< on the particle and its partner about their centres, N m (pairs)
  alignas(64) std::array<Row, channels> work;  ///< channels of ContactWork
};

/// Which rows are in use.
struct BlockOptions {
  bool spins = false;   ///< the law exerts torques
  bool wall = false;    ///< normal, overlap and velocity at the contact are given, not those of the centres
  bool varied = false;  ///< contacts have a scale and a row of the law table
  bool booked = true;   ///< energies are wanted
  Recall recall = Recall::nothing;
};

template <std::size_t... C>
inline void loadMemory(double* const* rows, [[maybe_unused]] std::size_t l, double* memory, std::index_sequence<C...>) {
  ((memory[C] = rows[C][l]), ...);
}
template <std::size_t... C>
inline void storeMemory(double* const* rows, [[maybe_unused]] std::size_t l, const double* memory, bool keep,
                        std::index_sequence<C...>) {
  ((rows[C][l] = keep ? memory[C] : 0.0), ...);
}

/// @param ended what a contact that no longer touches takes with it
inline void storeWork(ContactBlock& block, std::size_t l, const ContactWork& now, const ContactWork& ended,
                      bool touches, double scale, double normalScale) {
  const auto put = [&](std::size_t channel, double factor, double a, double b) {
    block.work[channel][l] = factor * (touches ? a : b);
  };
  put(0, normalScale, now.elasticEnergy, 0.0);
  put(1, scale, now.dissipatedPower, 0.0);
  put(2, scale, now.tangentialEnergy, 0.0);
  put(3, scale, now.frictionPower, ended.frictionPower);
  put(4, scale, now.rollingEnergy, 0.0);
  put(5, scale, now.rollingPower, ended.rollingPower);
  put(6, normalScale, now.plasticPower, ended.plasticPower);
  put(7, scale, now.fracturePower, ended.fracturePower);
}

template <class Prepared, std::size_t... C>
[[gnu::always_inline]] inline Prepared fromRows(const double (*rows)[blockSize], std::size_t l,
                                                std::index_sequence<C...>) {
  return std::bit_cast<Prepared>(std::array<double, sizeof...(C)>{rows[C][l]...});
}

/// How two particles meet.
struct Meeting {
  Vec3 normal;     ///< unit, from the partner to the particle
  Vec3 velocity;   ///< of the particle relative to the partner at the contact, m/s
  double overlap;  ///< m
  Vec3 drift;      ///< see ContactBlock
};

/// @tparam recall  approach: drift.x is that of n·v, d(n)/dt·v dt; motion: drift is that of the velocity at the contact
template <bool spins, Recall recall>
[[gnu::always_inline]] inline Meeting meetingOf(const ContactBlock& block, std::size_t l, [[maybe_unused]] double dt) {
  const Vec3 separation = block.separation.at(l);
  const double squared = squaredNorm(separation);
  const double distance = std::sqrt(squared), inverse = 1.0 / (squared > 0.0 ? distance : 1.0);
  const Vec3 normal{squared > 0.0 ? separation.x * inverse : 1.0, separation.y * inverse, separation.z * inverse};
  const double overlap = block.radiusI[l] + block.radiusJ[l] - distance;
  Vec3 velocity = block.velocity.at(l), drift;
  if constexpr (recall == Recall::approach) {
    const double separating = dot(normal, velocity);
    drift.x = (squaredNorm(velocity) - separating * separating) * inverse * dt;
  }
  // The arms, R − overlap/2, add up to the distance, and differ as the radii do.
  if constexpr (spins) {
    const Vec3 turning = (0.5 * distance) * block.spinSum.at(l) +
                         (0.5 * (block.radiusI[l] - block.radiusJ[l])) * block.spinDifference.at(l);
    if constexpr (recall == Recall::motion)
      drift = (-inverse * dt) * cross(turning, velocity - dot(normal, velocity) * normal);
    velocity -= cross(turning, normal);
  }
  return {normal, velocity, overlap, drift};
}

template <bool spins, Recall recall>
[[gnu::always_inline]] inline void meet(ContactBlock& block, std::size_t n, double dt) {
  DOVETAIL_INDEPENDENT
  for (std::size_t l = 0; l < n; ++l) {
    const Meeting meeting = meetingOf<spins, recall>(block, l, dt);
    block.normal.set(l, meeting.normal);
    block.velocity.set(l, meeting.velocity);
    block.overlap[l] = meeting.overlap;
    if constexpr (recall != Recall::nothing) block.drift.x[l] = meeting.drift.x;
    if constexpr (recall == Recall::motion) {
      block.drift.y[l] = meeting.drift.y;
      block.drift.z[l] = meeting.drift.z;
    }
  }
}

/// Whether contacts are worked on in several passes. In one pass the roots and quotients of a law that remembers would
/// wait for one another in a chain so long that the processor runs dry; short laws are faster in one.
template <class Law>
inline constexpr bool prepares = Law::memory > 0;

/// Velocities at a contact.
struct Velocities {
  double separating = 0.0;
  Vec3 slip, spin;
};

/// Those at the instant of the force, from those of the last two half steps; remembers the present ones. A contact that
/// has just begun, or was at rest, knows of none before: it has those of the last half step.
template <class Law, BlockOptions options>
[[gnu::always_inline]] inline Velocities velocitiesNow([[maybe_unused]] double* const* rows,
                                                       [[maybe_unused]] std::size_t l, const Meeting& meeting,
                                                       const Vec3& spin, [[maybe_unused]] bool begins,
                                                       [[maybe_unused]] bool stays, [[maybe_unused]] double lead,
                                                       [[maybe_unused]] bool remembers) {
  // One selection after the other: the loop would not vectorise with what selects between conditions.
  [[maybe_unused]] const auto ahead = [&](double now, double before, double known) {
    const double carriedOn = known != 0.0 ? now + lead * (now - before) : now;
    return begins ? now : carriedOn;
  };
  [[maybe_unused]] const auto put = [&](std::size_t c, double now, double before) {
    rows[c][l] = stays ? (remembers ? now : before) : 0.0;
  };
  const double separating = dot(meeting.normal, meeting.velocity);
  if constexpr (options.recall == Recall::approach) {
    const double before = rows[0][l];
    put(0, separating + meeting.drift.x, before);
    const double now = ahead(separating, before, before);
    return {now, meeting.velocity - separating * meeting.normal, spin};
  } else if constexpr (options.recall == Recall::motion) {
    const auto lookBack = [&](std::size_t c) { return Vec3{rows[c][l], rows[c + 1][l], rows[c + 2][l]}; };
    const auto putAll = [&](std::size_t c, const Vec3& now, const Vec3& before) {
      put(c, now.x, before.x);
      put(c + 1, now.y, before.y);
      put(c + 2, now.z, before.z);
    };
    const auto allAhead = [&](const Vec3& now, const Vec3& before, double known) {
      return Vec3{ahead(now.x, before.x, known), ahead(now.y, before.y, known), ahead(now.z, before.z, known)};
    };
    const Vec3 before = lookBack(0), drift = options.wall ? Vec3{} : meeting.drift;
    const double known = squaredNorm(before);
    putAll(0, meeting.velocity + drift, before);
    const Vec3 velocity = allAhead(meeting.velocity, before, known);
    const double along = dot(meeting.normal, velocity);
    Vec3 spinNow = spin;
    if constexpr (Law::needsSpin) {
      const Vec3 spinBefore = lookBack(3);
      putAll(3, spin, spinBefore);
      spinNow = allAhead(spin, spinBefore, known);
    }
    return {along, velocity - along * meeting.normal, spinNow};
  } else {
    return {separating, meeting.velocity - separating * meeting.normal, spin};
  }
}

/// Turns remembered vectors with their contacts: numbers c, c + 1 and c + 2 of the memory.
[[gnu::always_inline]] inline void carry(ContactBlock& block, std::size_t n, std::size_t c, double dt) {
  double *const x = block.memory[c], *const y = block.memory[c + 1], *const z = block.memory[c + 2];
  DOVETAIL_INDEPENDENT
  for (std::size_t l = 0; l < n; ++l) {
    const Vec3 normal = block.normal.at(l);
    const Vec3 now = carried({x[l], y[l], z[l]}, normal, dt * (0.5 * dot(block.spinSum.at(l), normal)));
    x[l] = now.x;
    y[l] = now.y;
    z[l] = now.z;
  }
}

template <class Law, BlockOptions options, class Prepared>
void answerAll(ContactBlock& block, std::size_t n, const Prepared* laws, double dt) {
  constexpr auto components = std::make_index_sequence<static_cast<std::size_t>(Law::memory)>{};
  constexpr bool recalls = options.recall != Recall::nothing;
  const Prepared single = laws[0];  // a copy nobody else can write to
  const double inverseDt = dt > 0.0 ? 1.0 / dt : 0.0;
  constexpr std::size_t parameters = sizeof(Prepared) / sizeof(double);
  alignas(64) double rows[options.varied ? parameters : 1][blockSize];
  if constexpr (options.varied)
    for (std::size_t l = 0; l < n; ++l) {
      double v[parameters];
      std::memcpy(v, laws + block.kind[l], sizeof v);
      for (std::size_t c = 0; c < parameters; ++c) rows[c][l] = v[c];
    }
  const auto held = block.memory;
  const bool remembers = block.recalls && dt > timeless;
  const double lead = remembers ? 0.5 : 0.0;
  DOVETAIL_INDEPENDENT
  for (std::size_t l = 0; l < n; ++l) {
    Prepared law = single;
    if constexpr (options.varied) law = fromRows<Prepared>(rows, l, std::make_index_sequence<parameters>{});
    Contact contact;
    Meeting meeting;
    if constexpr (options.wall || prepares<Law>)
      meeting = {block.normal.at(l), block.velocity.at(l), block.overlap[l],
                 recalls && !options.wall ? block.drift.at(l) : Vec3{}};
    else
      meeting = meetingOf<options.spins, options.recall>(block, l, dt);
    const auto& [normal, velocity, overlap, drift] = meeting;
    const Vec3 spin = options.spins ? block.spinDifference.at(l) : Vec3{};
    const bool touches = overlap > -law.reach();
    const double separating = dot(normal, velocity);
    contact.normal = normal;
    contact.overlap = touches ? overlap : 0.0;
    contact.overlapBefore = overlap + separating * dt;
    const double before =
        overlap > 0.0 ? contact.overlapBefore : 1.0;  // where parts act beyond touch it is no first one
    const bool begins = before <= -law.normal.reach();
    const Velocities now =
        velocitiesNow<Law, options>(held.data() + Law::memory, l, meeting, spin, begins, touches, lead, remembers);
    contact.separating = now.separating;
    double moving = dt;  // s, since they touched
    if constexpr (recalls || Law::jumps || Law::memory > 0) {
      const double left = overlap + law.reach(), goes = now.separating * dt;  // m, until they part
      const bool ends = goes > left;
      const double later = ends ? left : 1.0, top = begins ? overlap : later;
      const double away = ends ? goes : 1.0, bottom = begins ? overlap - contact.overlapBefore : away;
      const double fraction = top / bottom, part = fraction * dt;
      moving = begins ? part : dt;
      if constexpr (recalls || Law::jumps) {
        contact.first = begins;
        contact.last = ends;
        contact.fraction = fraction;
      }
    }
    contact.separated = moving * separating;
    if constexpr (Law::needsSlip) {
      contact.slip = now.slip;
      contact.slipped = moving * (velocity - separating * normal);
    }
    if constexpr (Law::needsSpin) {
      contact.spin = now.spin;
      contact.turned = moving * spin;
    }
    const double scale = options.varied ? block.scale[l] : 1.0;
    contact.rootMass = block.rootMass[l];
    if constexpr (options.varied &&
                  !options.wall)  // masses carry the scale too, so it is divided out of the effective one
      contact.rootMass = scale > 0.0 ? contact.rootMass / std::sqrt(scale > 0.0 ? scale : 1.0) : 0.0;
    contact.effectiveMass = contact.rootMass * contact.rootMass;
    if constexpr (recalls) {
      const bool heavy = contact.effectiveMass > 0.0;
      contact.inverseMass = heavy ? 1.0 / (heavy ? contact.effectiveMass : 1.0) : 0.0;
    }
    contact.effectiveRadius = block.effectiveRadius[l];
    contact.dt = dt;
    contact.inverseDt = inverseDt;
    double memory[Law::memory + 1];
    loadMemory(held.data(), l, memory, components);
    ContactWork ended;
    if constexpr (Law::memory > 0 && options.booked) ended = law.ended(memory, inverseDt);
    const ContactResponse response = law.respond(contact, memory);
    const Vec3 force{touches ? scale * response.force.x : 0.0, touches ? scale * response.force.y : 0.0,
                     touches ? scale * response.force.z : 0.0};
    block.force.set(l, force);
    if constexpr (options.spins) {
      const Vec3 couple{touches ? scale * response.couple.x : 0.0, touches ? scale * response.couple.y : 0.0,
                        touches ? scale * response.couple.z : 0.0};
      if constexpr (options.wall) {
        block.couple.set(l, couple);
      } else {
        const Vec3 turning = cross(force, normal);
        block.torqueI.set(l, (block.radiusI[l] - 0.5 * overlap) * turning + couple);
        block.torqueJ.set(l, (block.radiusJ[l] - 0.5 * overlap) * turning - couple);
      }
    }
    storeMemory(held.data(), l, memory, touches, components);
    if constexpr (options.booked)
      storeWork(block, l, response.work, ended, touches, scale, options.wall ? block.energyFraction[l] : scale);
  }
}

/// Forces of the first n contacts of the block.
template <class Law, BlockOptions options>
void answer(ContactBlock& block, std::size_t n, const typename Law::Prepared* laws, double dt) {
  if constexpr (!options.wall && prepares<Law>) meet<options.spins, options.recall>(block, n, dt);
  for (std::size_t c = 0; c < static_cast<std::size_t>(Law::memory); ++c)
    if ((Law::carries >> c & 1u) != 0) carry(block, n, c, dt);
  if constexpr (!options.varied && options.recall != Recall::motion) {
    const auto lighter = laws->withoutDashpot();
    answerAll<Law, options>(block, n, &lighter, dt);
  } else {
    answerAll<Law, options>(block, n, laws, dt);
  }
}

/// Sum of the work of the first n contacts, in an order of their own: eight interleaved sums, then those.
ContactWork sumWork(const ContactBlock& block, std::size_t n);

}  // namespace dovetail::dem::detail
