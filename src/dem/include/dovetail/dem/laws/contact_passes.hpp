// What is done with the contacts of a block before the law is asked.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "dovetail/dem/laws/contact_block.hpp"

namespace dovetail::dem::detail {

/// How two particles meet.
struct Meeting {
  Vec3 normal;     ///< unit, from the partner to the particle
  Vec3 velocity;   ///< of the particle relative to the partner at the contact, m/s
  double overlap;  ///< m
  double drift;    ///< what the turning of the normal in a step adds to what is remembered, m/s along the normal
};

/// @tparam recall  what is remembered. approach: drift is that of n·v, v·(dn/dt) dt. motion: that of the velocity at
///                 the contact, as the arms turn; its part along the normal (the rest needs spin about the normal)
template <bool spins, Recall recall>
[[gnu::always_inline]] inline Meeting meetingOf(const ContactBlock& block, std::size_t l, [[maybe_unused]] double dt) {
  const Vec3 separation = block.normal.at(l);
  const double squared = squaredNorm(separation);
  const double distance = std::sqrt(squared), inverse = 1.0 / (squared > 0.0 ? distance : 1.0);
  const Vec3 normal{squared > 0.0 ? separation.x * inverse : 1.0, separation.y * inverse, separation.z * inverse};
  const double overlap = block.radiusI[l] + block.radiusJ[l] - distance;
  const Vec3 centres = block.velocity.at(l);
  const double perDistance = inverse * dt;
  Vec3 velocity = centres;
  double drift = 0.0;
  if constexpr (recall == Recall::approach) {
    const double separating = dot(normal, centres);
    drift = (squaredNorm(centres) - separating * separating) * perDistance;
  }
  // The arms, R − overlap/2, add up to the distance, and differ as the radii do.
  if constexpr (spins) {
    const Vec3 turning = (0.5 * distance) * block.spinSum.at(l) +
                         (0.5 * (block.radiusI[l] - block.radiusJ[l])) * block.spinDifference.at(l);
    const Vec3 ofSpins = cross(turning, normal);
    if constexpr (recall == Recall::motion) drift = dot(ofSpins, centres) * perDistance;
    velocity -= ofSpins;
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
    if constexpr (recall != Recall::nothing) block.drift[l] = meeting.drift;
  }
}

/// Velocities at the instant of the force, from those of the last two half steps; remembers the present ones. A contact
/// that has just begun, or was at rest, knows of none before: it has those of the last half step. Marks the contacts
/// that begin or end within a step.
/// @tparam Law   needsSpin (spins are remembered too), jumps
/// @param laws   at(l): reach(), normal.reach()
/// @param rows   ContactBlock::motion
/// @return whether any are marked
template <class Law, BlockOptions options, class Laws>
[[gnu::always_inline]] inline bool lookAhead(ContactBlock& block, std::size_t n, const Laws& laws,
                                             const std::array<double*, 6> rows, double dt) {
  std::int64_t any = 0;
  DOVETAIL_INDEPENDENT
  for (std::size_t l = 0; l < n; ++l) {
    const auto& law = laws.at(l);
    const double overlap = block.overlap[l], left = overlap + law.reach();  // m, until they part
    const Vec3 normal = block.normal.at(l), velocity = block.velocity.at(l);
    const double separating = dot(normal, velocity);
    const double before = overlap > 0.0 ? overlap + separating * dt : 1.0;  // beyond touch there is no first one
    const bool begins = before <= -law.normal.reach();
    // One selection after the other: the loop would not vectorise with what selects between conditions.
    [[maybe_unused]] const auto kept = [&](std::size_t c) { return rows[c][l]; };
    [[maybe_unused]] const auto leadOf = [&](double known) {
      const double half = known != 0.0 ? 0.5 : 0.0;
      return begins ? 0.0 : half;
    };
    [[maybe_unused]] const auto ahead = [&](std::size_t c, double now, double drift, double lead) {
      const double change = now - kept(c);
      rows[c][l] = left > 0.0 ? now + drift : 0.0;
      return now + lead * change;
    };
    double along = separating;
    if constexpr (options.recall == Recall::approach) {
      along = ahead(0, separating, block.drift[l], leadOf(kept(0)));
    } else if constexpr (options.recall == Recall::motion) {
      const double lead = leadOf(squaredNorm({kept(0), kept(1), kept(2)}));
      const auto allAhead = [&](std::size_t c, const Vec3& now, const Vec3& drift) {
        return Vec3{ahead(c, now.x, drift.x, lead), ahead(c + 1, now.y, drift.y, lead),
                    ahead(c + 2, now.z, drift.z, lead)};
      };
      const Vec3 now = allAhead(0, velocity, options.wall ? Vec3{} : block.drift[l] * normal);
      along = dot(normal, now);
      block.slip.set(l, now - along * normal);
      if constexpr (Law::needsSpin) block.spin.set(l, allAhead(3, block.spinDifference.at(l), {}));
    }
    const double far = left > 0.0 ? left : 1e300;
    const std::int64_t first = begins ? 1 : 0, last = along * dt > far ? 2 : 0;
    any |= first | last;
    block.separating[l] = along;
    block.kink[l] = first | last;
    block.share[l] = 1.0;
    block.engagement[l] = 1.0;
    if constexpr (Law::jumps) block.engagementUntilEnd[l] = 1.0;
  }
  return any != 0;
}

/// The same, where perhaps no velocity is remembered.
template <class Law, BlockOptions options, class Laws>
[[gnu::always_inline]] inline bool lookAhead(ContactBlock& block, std::size_t n, const Laws& laws, double dt) {
  std::array<double*, 6> rows = block.motion;
  std::array<ContactBlock::Row, rows.size()> unknown;
  if (!block.recalls || !(dt > timeless))
    for (std::size_t c = 0; c < rows.size(); ++c) {
      unknown[c].fill(0.0);
      rows[c] = unknown[c].data();
    }
  return lookAhead<Law, options>(block, n, laws, rows, dt);
}

/// Factor on dashpots in a step of whose length the part `fraction` is in touch: Contact::engagement.
template <class Normal>
double engagementIn(const Normal& normal, double fraction) {
  if constexpr (requires { normal.engagement(fraction); })
    return normal.engagement(fraction);
  else
    return 0.5 + fraction;
}
/// Whether they act until the contact has ended.
template <class Normal>
bool dampsToTheEnd(const Normal& normal) {
  if constexpr (requires { normal.pulls(); })
    return normal.pulls();
  else
    return false;
}

/// How much of a step counts for contacts that begin or end within it.
template <class Law, class Laws>
void engage(ContactBlock& block, std::size_t n, const Laws& laws, double dt) {
  for (std::size_t l = 0; l < n; ++l) {
    if (block.kink[l] == 0) continue;
    const auto& law = laws.at(l);
    const bool begins = block.kink[l] != 2;
    const double overlap = block.overlap[l], closed = -dot(block.normal.at(l), block.velocity.at(l)) * dt;
    const double fraction = begins ? overlap / closed : (overlap + law.reach()) / (block.separating[l] * dt);
    if (begins) block.share[l] = fraction;
    if (begins || dampsToTheEnd(law.normal)) block.engagement[l] = engagementIn(law.normal, fraction);
    if constexpr (Law::jumps) block.engagementUntilEnd[l] = 0.5 + fraction;
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

}  // namespace dovetail::dem::detail
