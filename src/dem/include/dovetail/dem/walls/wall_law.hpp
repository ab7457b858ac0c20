// The law at contacts with walls and facets, which count as flat.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/laws/answer.hpp"
#include "dovetail/dem/laws/law_table.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/walls/ended_memories.hpp"

namespace dovetail::dem {

/// Fractions of one of several contacts of a particle with a wall.
struct WallFraction {
  double overlap;  ///< what the law sees, m
  double force;    ///< factor on forces, couples and what they lose
  double energy;   ///< factor on what normal springs store and plastic flow takes
};

namespace detail {

/// @throws InputError unless dt is finite and > 0
void requireStep(double dt);

/// @param touching numbers of the particles that touch
/// @throws InputError naming one whose material has no law, or the wall's material if that has none
void requireWallMaterials(const Particles& particles, const std::vector<int>& touching, int materials,
                          int wallMaterial);

inline int materialOf(const Particles& particles, std::size_t i) {
  return particles.material.empty() ? 0 : static_cast<int>(particles.material[i]);
}

/// What ended contacts take with them.
template <class Law>
ContactWork bookEnded(const EndedMemories& ended, const PreparedLaws<Law>& laws, int wallMaterial, double dt) {
  const auto numbers = static_cast<std::size_t>(laws.wallNumbers());
  ContactWork work;
  if (ended.memory.size() != numbers * ended.material.size()) return work;  // of another law
  const bool several = laws.materials > 1;
  for (std::size_t k = 0; k < ended.material.size(); ++k) {
    const ContactWork one = laws.at(several ? ended.material[k] : 0, several ? wallMaterial : 0)
                                .ended(ended.memory.data() + k * numbers, 1.0 / dt);
    work.frictionPower += ended.fraction[k] * one.frictionPower;
    work.rollingPower += ended.fraction[k] * one.rollingPower;
    work.plasticPower += ended.fraction[k] * one.plasticPower;
    work.fracturePower += ended.fraction[k] * one.fracturePower;
  }
  return work;
}

/// Mass that meets the wall in a head-on impact, kg.
inline double massAgainst(double wall, double particle) {
  return std::isfinite(wall) ? wall * particle / (wall + particle) : particle;
}
/// What a law has to know of a wall.
struct WallSide {
  int material = 0;
  double mass = std::numeric_limits<double>::infinity();  ///< kg
};

/// Contacts first … first + n − 1 into a block.
/// @param numbers  of memory per contact
template <class Law, class Contacts, class Motion>
void gatherWall(const Particles& particles, const Contacts& contacts, const std::vector<double>& memory,
                std::size_t numbers, const PreparedLaws<Law>& laws, const WallSide& wall, std::size_t first,
                std::size_t n, const Motion& motion, ContactBlock& block) {
  constexpr auto own = static_cast<std::size_t>(Law::memory);
  for (std::size_t l = 0; l < n; ++l) {
    const std::size_t c = first + l;
    const auto i = static_cast<std::size_t>(contacts.particle[c]);
    const WallFraction fraction = fractionOf(contacts, c);
    block.normal.set(l, contacts.normal[c]);
    block.velocity.set(l, motion.velocity(c));
    block.overlap[l] = fraction.overlap;
    block.scale[l] = particles.weightOf(i) * fraction.force;
    block.energyFraction[l] = particles.weightOf(i) * fraction.energy;
    block.effectiveRadius[l] = particles.radius[i];
    const double mass = massAgainst(wall.mass, particles.mass[i]);
    block.rootMass[l] = std::sqrt(mass);
    block.inverseMass[l] = mass > 0.0 ? 1.0 / mass : 0.0;
    block.kind[l] = laws.materials > 1 ? materialOf(particles, i) * laws.materials + wall.material : 0;
    if constexpr (Law::rotates) {
      const Vec3 spin = particles.rotates() ? particles.omega[i] : Vec3{}, wallSpin = motion.spin(c);
      block.spinSum.set(l, spin + wallSpin);
      block.spinDifference.set(l, spin - wallSpin);
    }
    const double* const held = memory.data() + c * numbers;
    for (std::size_t m = 0; m < own; ++m) block.memory[m][l] = held[m];
    for (std::size_t m = own; m < numbers; ++m) block.motion[m - own][l] = held[m];
  }
}

/// Sets contacts.force (and couple, if the law has torques) and advances the memories.
/// @param contacts  arrays particle, normal, force, couple, energy; fractionOf(contacts, c)
/// @param memory    laws.wallNumbers() numbers per contact
/// @param booking   off: returns nothing but zeros
/// @param motion    velocity(c): of the particle relative to the wall at contact c, m/s; spin(c): of the wall there
template <class Law, class Contacts, class Motion>
ContactWork answerWall(const Particles& particles, Contacts& contacts, std::vector<double>& memory,
                       const PreparedLaws<Law>& laws, const WallSide& wall, double dt, Booking booking,
                       const Motion& motion) {
  constexpr BlockOptions quiet{Law::rotates, true, true, false, Recall::motion};
  constexpr BlockOptions booked{Law::rotates, true, true, true, Recall::motion};
  constexpr auto own = static_cast<std::size_t>(Law::memory);
  const auto numbers = static_cast<std::size_t>(laws.wallNumbers());
  const auto answerBlock = [&](std::size_t first, std::size_t end) {
    ContactBlock block;
    std::array<ContactBlock::Row, Law::memory + 1> held;
    std::array<ContactBlock::Row, 6> moved;
    for (std::size_t m = 0; m < own; ++m) block.memory[m] = held[m].data();
    for (std::size_t m = own; m < numbers; ++m) block.motion[m - own] = moved[m - own].data();
    block.recalls = numbers > own;
    const std::size_t n = end - first;
    gatherWall<Law>(particles, contacts, memory, numbers, laws, wall, first, n, motion, block);
    if (booking == Booking::on)
      answer<Law, booked>(block, n, laws.table.data(), dt);
    else
      answer<Law, quiet>(block, n, laws.table.data(), dt);
    for (std::size_t l = 0; l < n; ++l) {
      contacts.force[first + l] = block.force.at(l);
      if constexpr (Law::rotates) contacts.couple[first + l] = block.couple.at(l);
      double* const to = memory.data() + (first + l) * numbers;
      for (std::size_t m = 0; m < own; ++m) to[m] = block.memory[m][l];
      for (std::size_t m = own; m < numbers; ++m) to[m] = block.motion[m - own][l];
      contacts.energy[first + l] = booking == Booking::on ? block.work[0][l] : 0.0;
      if constexpr (Law::memory > 0)
        contacts.sideEnergy[first + l] = booking == Booking::on ? block.work[2][l] + block.work[4][l] : 0.0;
    }
    return booking == Booking::on ? sumWork(block, n) : ContactWork{};
  };
  const std::size_t count = contacts.particle.size();
  contacts.energy.resize(count);
  contacts.sideEnergy.resize(Law::memory > 0 ? count : 0);
  if (count == 0) return {};
  requireWallMaterials(particles, contacts.particle, laws.materials, wall.material);
  return count <= blockSize ? answerBlock(0, count) : parallelSum(count, blockSize, answerBlock);
}

}  // namespace detail

}  // namespace dovetail::dem
