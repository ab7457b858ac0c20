// Contacts side by side: what turns the law of one contact into a loop that vectorises.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include "dovetail/dem/laws/contact.hpp"

namespace dovetail::dem::detail {

inline constexpr std::size_t blockSize = 64;
inline constexpr std::size_t channels = 8;  // of ContactWork

/// Up to blockSize contacts. `gather` fills the first group, `answer` turns it into the second, which shares its rows.
/// Rows that a law does not need are never touched.
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
  Rows3 separation;          ///< in: x_particle − x_partner (pairs) or the unit normal (walls); out: n × force
  Rows3 velocity;            ///< in: v_particle − v_partner; out: force on the particle
  Rows3 spinI;               ///< in: ω of the particle; out: couple on the particle
  Rows3 spinJ;               ///< in: ω of the partner
  alignas(64) Row armI;      ///< in: radius of the particle; out: distance of its centre from the contact
  alignas(64) Row armJ;      ///< the same of the partner; walls: in: overlap
  alignas(64) Row rootMass;  ///< √ of the effective mass, kg^½
  alignas(64) Row radius;    ///< effective, m
  alignas(64) Row scale;
  alignas(64) std::array<int, blockSize> kind;  ///< row of the law table
  alignas(64) std::array<Row, 12> memory;       ///< of the law, by component
  alignas(64) std::array<Row, channels> work;   ///< channels of ContactWork
};

/// Which rows are in use.
struct BlockOptions {
  bool spins = false;   ///< the law exerts torques
  bool wall = false;    ///< normal, overlap and velocity at the contact are given, not those of the centres
  bool varied = false;  ///< contacts have a scale and a row of the law table
  bool booked = true;   ///< energies are wanted
};

template <std::size_t... C>
inline void loadMemory(const ContactBlock& block, [[maybe_unused]] std::size_t l, double* memory,
                       std::index_sequence<C...>) {
  ((memory[C] = block.memory[C][l]), ...);
}
template <std::size_t... C>
inline void storeMemory(ContactBlock& block, [[maybe_unused]] std::size_t l, const double* memory, bool keep,
                        std::index_sequence<C...>) {
  ((block.memory[C][l] = keep ? memory[C] : 0.0), ...);
}

inline void storeWork(ContactBlock& block, std::size_t l, const ContactWork& now, const ContactWork& ended,
                      bool touches, double scale) {
  const auto put = [&](std::size_t channel, double a, double b) { block.work[channel][l] = scale * (touches ? a : b); };
  put(0, now.elasticEnergy, 0.0);
  put(1, now.dissipatedPower, 0.0);
  put(2, now.tangentialEnergy, 0.0);
  put(3, now.frictionPower, ended.frictionPower);
  put(4, now.rollingEnergy, 0.0);
  put(5, now.rollingPower, ended.rollingPower);
  put(6, now.plasticPower, ended.plasticPower);
  put(7, now.fracturePower, 0.0);
}

template <class Prepared, std::size_t... C>
[[gnu::always_inline]] inline Prepared fromRows(const double (*rows)[blockSize], std::size_t l,
                                                std::index_sequence<C...>) {
  return std::bit_cast<Prepared>(std::array<double, sizeof...(C)>{rows[C][l]...});
}

/// Forces of the first n contacts of the block.
template <class Law, BlockOptions options>
void answer(ContactBlock& block, std::size_t n, const typename Law::Prepared* laws, double dt) {
  using Prepared = typename Law::Prepared;
  constexpr auto components = std::make_index_sequence<static_cast<std::size_t>(Law::memory)>{};
  const Prepared single = laws[0];  // a copy nobody else can write to
  constexpr std::size_t parameters = sizeof(Prepared) / sizeof(double);
  alignas(64) double rows[options.varied ? parameters : 1][blockSize];
  if constexpr (options.varied)
    for (std::size_t l = 0; l < n; ++l) {
      double v[parameters];
      std::memcpy(v, laws + block.kind[l], sizeof v);
      for (std::size_t c = 0; c < parameters; ++c) rows[c][l] = v[c];
    }
  for (std::size_t l = 0; l < n; ++l) {
    Prepared law = single;
    if constexpr (options.varied) law = fromRows<Prepared>(rows, l, std::make_index_sequence<parameters>{});
    Contact contact;
    Vec3 normal = block.separation.at(l);
    double armI = block.armI[l], armJ = block.armJ[l], overlap = armJ;
    if constexpr (!options.wall) {
      const double squared = squaredNorm(normal);
      const double distance = std::sqrt(squared), inverse = 1.0 / (squared > 0.0 ? distance : 1.0);
      normal = {squared > 0.0 ? normal.x * inverse : 1.0, normal.y * inverse, normal.z * inverse};
      overlap = armI + armJ - distance;
      armI -= 0.5 * overlap;
      armJ -= 0.5 * overlap;
    }
    const bool touches = overlap > -law.reach();
    Vec3 velocity = block.velocity.at(l);
    if constexpr (options.spins) {
      const Vec3 spinI = block.spinI.at(l), spinJ = block.spinJ.at(l);
      if constexpr (!options.wall) velocity -= cross(armI * spinI + armJ * spinJ, normal);
      contact.spin = spinI - spinJ;
      contact.twist = 0.5 * dot(spinI + spinJ, normal);
    }
    contact.normal = normal;
    contact.overlap = touches ? overlap : 0.0;
    contact.separating = dot(normal, velocity);
    if constexpr (Law::needsSlip) contact.slip = velocity - contact.separating * normal;
    const double scale = options.varied ? block.scale[l] : 1.0;
    contact.rootMass = block.rootMass[l];
    if constexpr (options.varied &&
                  !options.wall)  // masses carry the scale too, so it is divided out of the effective one
      contact.rootMass = scale > 0.0 ? contact.rootMass / std::sqrt(scale > 0.0 ? scale : 1.0) : 0.0;
    contact.effectiveMass = contact.rootMass * contact.rootMass;
    contact.effectiveRadius = block.radius[l];
    contact.dt = dt;
    double memory[Law::memory + 1];
    loadMemory(block, l, memory, components);
    ContactWork ended;
    if constexpr (Law::memory > 0 && options.booked) ended = law.ended(memory, dt);
    const ContactResponse response = law.respond(contact, memory);
    const Vec3 force{touches ? scale * response.force.x : 0.0, touches ? scale * response.force.y : 0.0,
                     touches ? scale * response.force.z : 0.0};
    block.velocity.set(l, force);
    if constexpr (options.spins) {
      block.separation.set(l, cross(normal, force));
      block.armI[l] = armI;
      block.armJ[l] = armJ;
      block.spinI.set(l, {touches ? scale * response.couple.x : 0.0, touches ? scale * response.couple.y : 0.0,
                          touches ? scale * response.couple.z : 0.0});
    }
    storeMemory(block, l, memory, touches, components);
    if constexpr (options.booked) storeWork(block, l, response.work, ended, touches, scale);
  }
}

/// Sum of the work of the first n contacts, in an order of their own: eight interleaved sums, then those.
ContactWork sumWork(const ContactBlock& block, std::size_t n);

}  // namespace dovetail::dem::detail
