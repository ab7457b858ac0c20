// The law at contacts with whatever counts as infinitely heavy and flat.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/laws/contact_block.hpp"
#include "dovetail/dem/laws/law_table.hpp"
#include "dovetail/dem/particles/particles.hpp"

namespace dovetail::dem::detail {

/// @throws InputError unless dt is finite and > 0
void requireStep(double dt);

/// @throws InputError naming a particle whose material has no law
void requireMaterials(const Particles& particles, int materials);

inline int materialOf(const Particles& particles, std::size_t i) {
  return particles.material.empty() ? 0 : static_cast<int>(particles.material[i]);
}

/// Memories, one after the other, of contacts that have ended, and whose they were.
struct EndedMemories {
  std::vector<double> memory;
  std::vector<int> particle;
};

/// What ended contacts take with them.
template <class Law>
ContactWork bookEnded(const Particles& particles, const EndedMemories& ended, const PreparedLaws<Law>& laws,
                      int wallMaterial, double dt) {
  ContactWork work;
  for (std::size_t k = 0; k < ended.particle.size(); ++k) {
    const auto i = static_cast<std::size_t>(ended.particle[k]);
    const int material = laws.materials > 1 && i < particles.size() ? materialOf(particles, i) : 0;
    work += laws.at(material, laws.materials > 1 ? wallMaterial : 0)
                .ended(ended.memory.data() + k * static_cast<std::size_t>(Law::memory), dt);
  }
  return work;
}

/// Contacts first … first + n − 1 into a block.
template <class Law, class Contacts, class Velocity>
void gatherWall(const Particles& particles, const Contacts& contacts, const std::vector<double>& memory,
                const PreparedLaws<Law>& laws, int wallMaterial, std::size_t first, std::size_t n,
                const Velocity& velocity, ContactBlock& block) {
  for (std::size_t l = 0; l < n; ++l) {
    const std::size_t c = first + l;
    const auto i = static_cast<std::size_t>(contacts.particle[c]);
    block.separation.set(l, contacts.normal[c]);
    block.velocity.set(l, velocity(c));
    block.armI[l] = block.radius[l] = particles.radius[i];
    block.armJ[l] = contacts.overlap[c] / contacts.engagement[c];
    block.rootMass[l] = std::sqrt(particles.mass[i]);
    block.scale[l] = contacts.engagement[c];
    block.kind[l] = laws.materials > 1 ? materialOf(particles, i) * laws.materials + wallMaterial : 0;
    if constexpr (Law::rotates) {
      block.spinI.set(l, particles.rotates() ? particles.omega[i] : Vec3{});
      block.spinJ.set(l, {});
    }
    for (std::size_t m = 0; m < Law::memory; ++m) block.memory[m][l] = memory[c * Law::memory + m];
  }
}

/// Sets contacts.force (and couple, if the law has torques) and advances the memories.
/// @param contacts  arrays particle, normal, overlap, engagement, force, couple
/// @param memory    Law::memory numbers per contact
/// @param velocity  velocity(c): of the particle relative to the wall at contact c, m/s
template <class Law, class Contacts, class Velocity>
ContactWork answerWall(const Particles& particles, Contacts& contacts, std::vector<double>& memory,
                       const PreparedLaws<Law>& laws, int wallMaterial, double dt, const Velocity& velocity) {
  constexpr BlockOptions options{.spins = Law::rotates, .wall = true, .varied = true, .booked = true};
  const auto answerBlock = [&](std::size_t first, std::size_t end) {
    ContactBlock block;
    const std::size_t n = end - first;
    gatherWall<Law>(particles, contacts, memory, laws, wallMaterial, first, n, velocity, block);
    answer<Law, options>(block, n, laws.table.data(), dt);
    for (std::size_t l = 0; l < n; ++l) {
      contacts.force[first + l] = block.velocity.at(l);
      if constexpr (Law::rotates) contacts.couple[first + l] = block.spinI.at(l);
      for (std::size_t m = 0; m < Law::memory; ++m) memory[(first + l) * Law::memory + m] = block.memory[m][l];
    }
    return sumWork(block, n);
  };
  const std::size_t count = contacts.particle.size();
  if (count == 0) return {};
  requireMaterials(particles, std::max(laws.materials, 1));
  return count <= blockSize ? answerBlock(0, count) : parallelSum(count, blockSize, answerBlock);
}

}  // namespace dovetail::dem::detail
