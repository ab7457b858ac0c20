// The law at contacts side by side, in a loop that vectorises.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

#include "dovetail/dem/laws/contact_passes.hpp"

namespace dovetail::dem::detail {

/// Whether contacts are worked on in several passes. In one pass the roots and quotients of a law that remembers would
/// wait for one another in a chain so long that the processor runs dry; short laws are faster in one.
template <class Law, BlockOptions options>
inline constexpr bool inPasses = Law::memory > 0 || Law::jumps || options.recall != Recall::nothing;

/// The laws of the contacts of a block: one for all, or each its own of a table.
template <class Prepared, bool varied>
class LawRows {
public:
  LawRows(const Prepared* laws, const ContactBlock&, std::size_t) : single_(laws[0]) {}
  [[gnu::always_inline]] const Prepared& at(std::size_t) const { return single_; }

private:
  const Prepared single_;  // a copy nobody else can write to
};
template <class Prepared>
class LawRows<Prepared, true> {
public:
  LawRows(const Prepared* laws, const ContactBlock& block, std::size_t n) {
    for (std::size_t l = 0; l < n; ++l) {
      double v[parameters];
      std::memcpy(v, laws + block.kind[l], sizeof v);
      for (std::size_t c = 0; c < parameters; ++c) rows_[c][l] = v[c];
    }
  }
  [[gnu::always_inline]] Prepared at(std::size_t l) const { return from(l, std::make_index_sequence<parameters>{}); }

private:
  static constexpr std::size_t parameters = sizeof(Prepared) / sizeof(double);
  template <std::size_t... C>
  [[gnu::always_inline]] Prepared from(std::size_t l, std::index_sequence<C...>) const {
    return std::bit_cast<Prepared>(std::array<double, parameters>{rows_[C][l]...});
  }
  alignas(64) double rows_[parameters][blockSize];
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

/// The law at the first n contacts, after the passes before it.
template <class Law, BlockOptions options, class Laws>
[[gnu::always_inline]] inline void respondAll(ContactBlock& block, std::size_t n, const Laws& laws, double dt) {
  constexpr auto components = std::make_index_sequence<static_cast<std::size_t>(Law::memory)>{};
  constexpr bool passes = inPasses<Law, options>;
  const double inverseDt = dt > 0.0 ? 1.0 / dt : 0.0;
  const auto held = block.memory;
  DOVETAIL_INDEPENDENT
  for (std::size_t l = 0; l < n; ++l) {
    const auto& law = laws.at(l);
    Contact contact;
    Meeting meeting;
    if constexpr (options.wall || passes)
      meeting = {block.normal.at(l), block.velocity.at(l), block.overlap[l], {}};
    else
      meeting = meetingOf<options.spins, options.recall>(block, l, dt);
    const auto& [normal, velocity, overlap, drift] = meeting;
    const bool touches = overlap > -law.reach();
    const double separating = dot(normal, velocity), moving = passes ? block.share[l] * dt : dt;
    contact.normal = normal;
    contact.overlap = touches ? overlap : 0.0;
    contact.overlapBefore = overlap + separating * dt;
    contact.separating = passes ? block.separating[l] : separating;
    contact.separated = moving * separating;
    if constexpr (passes) contact.engagement = block.engagement[l];
    if constexpr (Law::jumps) contact.engagementUntilEnd = block.engagementUntilEnd[l];
    if constexpr (Law::needsSlip) {
      const Vec3 slip = velocity - separating * normal;
      contact.slip = options.recall == Recall::motion ? block.slip.at(l) : slip;
      contact.slipped = moving * slip;
    }
    if constexpr (Law::needsSpin) {
      const Vec3 spin = options.spins ? block.spinDifference.at(l) : Vec3{};
      contact.spin = options.recall == Recall::motion ? block.spin.at(l) : spin;
      contact.turned = moving * spin;
    }
    const double scale = options.varied ? block.scale[l] : 1.0;
    contact.rootMass = block.rootMass[l];
    contact.inverseMass = block.inverseMass[l];
    if constexpr (options.varied && !options.wall) {  // masses carry the scale too, which is divided out
      contact.rootMass = scale > 0.0 ? contact.rootMass / std::sqrt(scale > 0.0 ? scale : 1.0) : 0.0;
      contact.inverseMass *= scale;
    }
    contact.effectiveMass = contact.rootMass * contact.rootMass;
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

/// All passes: how the bodies meet and moved, then what the law says.
template <class Law, BlockOptions options, class Laws>
[[gnu::always_inline]] inline void answerAll(ContactBlock& block, std::size_t n, const Laws& laws, double dt) {
  if constexpr (inPasses<Law, options>) {
    if constexpr (!options.wall) meet<options.spins, options.recall>(block, n, dt);
    if (lookAhead<Law, options>(block, n, laws, dt)) engage<Law>(block, n, laws, dt);
    for (std::size_t c = 0; c < static_cast<std::size_t>(Law::memory); ++c)
      if ((Law::carries >> c & 1u) != 0) carry(block, n, c, dt);
  }
  respondAll<Law, options>(block, n, laws, dt);
}

/// Forces of the first n contacts of the block.
template <class Law, BlockOptions options>
void answer(ContactBlock& block, std::size_t n, const typename Law::Prepared* laws, double dt) {
  if constexpr (!options.varied && options.recall != Recall::motion) {
    const auto lighter = laws->withoutDashpot();
    answerAll<Law, options>(block, n, LawRows<std::remove_const_t<decltype(lighter)>, false>(&lighter, block, n), dt);
  } else {
    answerAll<Law, options>(block, n, LawRows<typename Law::Prepared, options.varied>(laws, block, n), dt);
  }
}

}  // namespace dovetail::dem::detail
