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
  std::array<double*, 12> memory;               ///< of the law, rows by component; advanced

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
  put(1, scale, now.dissipatedPower, ended.dissipatedPower);
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
};

template <bool spins>
[[gnu::always_inline]] inline Meeting meetingOf(const ContactBlock& block, std::size_t l) {
  const Vec3 separation = block.separation.at(l);
  const double squared = squaredNorm(separation);
  const double distance = std::sqrt(squared), inverse = 1.0 / (squared > 0.0 ? distance : 1.0);
  const Vec3 normal{squared > 0.0 ? separation.x * inverse : 1.0, separation.y * inverse, separation.z * inverse};
  const double overlap = block.radiusI[l] + block.radiusJ[l] - distance;
  Vec3 velocity = block.velocity.at(l);
  // The arms, R − overlap/2, add up to the distance, and differ as the radii do.
  if constexpr (spins)
    velocity -= cross((0.5 * distance) * block.spinSum.at(l) +
                          (0.5 * (block.radiusI[l] - block.radiusJ[l])) * block.spinDifference.at(l),
                      normal);
  return {normal, velocity, overlap};
}

template <bool spins>
[[gnu::always_inline]] inline void meet(ContactBlock& block, std::size_t n) {
  DOVETAIL_INDEPENDENT
  for (std::size_t l = 0; l < n; ++l) {
    const Meeting meeting = meetingOf<spins>(block, l);
    block.normal.set(l, meeting.normal);
    block.velocity.set(l, meeting.velocity);
    block.overlap[l] = meeting.overlap;
  }
}

/// Whether contacts are worked on in several passes. In one pass the roots and quotients of a law that remembers would
/// wait for one another in a chain so long that the processor runs dry; short laws are faster in one.
template <class Law>
inline constexpr bool prepares = Law::memory > 0;

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
  DOVETAIL_INDEPENDENT
  for (std::size_t l = 0; l < n; ++l) {
    Prepared law = single;
    if constexpr (options.varied) law = fromRows<Prepared>(rows, l, std::make_index_sequence<parameters>{});
    Contact contact;
    Meeting meeting;
    if constexpr (options.wall || prepares<Law>)
      meeting = {block.normal.at(l), block.velocity.at(l), block.overlap[l]};
    else
      meeting = meetingOf<options.spins>(block, l);
    const auto& [normal, velocity, overlap] = meeting;
    if constexpr (options.spins) contact.spin = block.spinDifference.at(l);
    const bool touches = overlap > -law.reach();
    contact.normal = normal;
    contact.separating = dot(normal, velocity);
    contact.overlapBefore = overlap + contact.separating * dt;
    const double last = contact.overlapBefore > 0.0 ? contact.overlapBefore : 0.0;
    contact.overlap = touches ? overlap : last;
    if constexpr (Law::needsSlip) contact.slip = velocity - contact.separating * normal;
    const double scale = options.varied ? block.scale[l] : 1.0;
    contact.rootMass = block.rootMass[l];
    if constexpr (options.varied &&
                  !options.wall)  // masses carry the scale too, so it is divided out of the effective one
      contact.rootMass = scale > 0.0 ? contact.rootMass / std::sqrt(scale > 0.0 ? scale : 1.0) : 0.0;
    contact.effectiveMass = contact.rootMass * contact.rootMass;
    contact.effectiveRadius = block.effectiveRadius[l];
    contact.dt = dt;
    contact.inverseDt = inverseDt;
    double memory[Law::memory + 1];
    loadMemory(held.data(), l, memory, components);
    ContactWork ended;
    if constexpr (Law::memory > 0 && options.booked) ended = law.ended(memory, inverseDt);
    const ContactResponse response = law.respond(contact, memory);
    ended.dissipatedPower = response.dashpotAfter;
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
  if constexpr (!options.wall && prepares<Law>) meet<options.spins>(block, n);
  for (std::size_t c = 0; c < static_cast<std::size_t>(Law::memory); ++c)
    if ((Law::carries >> c & 1u) != 0) carry(block, n, c, dt);
  if constexpr (!options.wall && !options.varied &&
                !std::is_same_v<decltype(laws->withoutDashpot()), typename Law::Prepared>)
    if (laws->sparesDashpot()) {
      const auto lighter = laws->withoutDashpot();
      return answerAll<Law, options>(block, n, &lighter, dt);
    }
  answerAll<Law, options>(block, n, laws, dt);
}

/// Sum of the work of the first n contacts, in an order of their own: eight interleaved sums, then those.
ContactWork sumWork(const ContactBlock& block, std::size_t n);

}  // namespace dovetail::dem::detail
