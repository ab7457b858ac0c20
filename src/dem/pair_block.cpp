// Pairs in and out of blocks.
#include "dovetail/dem/pair_collide.hpp"

namespace dovetail::dem::detail {

namespace {

void gatherGeometry(const Particles& particles, const PairList& list, std::size_t first, std::size_t n, bool spins,
                    ContactBlock& block) {
  const Vec3 *const x = particles.x.data(), *const v = particles.v.data();
  const double* const radius = particles.radius.data();
  const auto* const pairs = list.pairs.data() + first;
  const std::size_t last = list.size() - 1 - first;
  for (std::size_t l = 0; l < n; ++l) {
    const auto i = static_cast<std::size_t>(pairs[l][0]), j = static_cast<std::size_t>(pairs[l][1]);
    const auto next = static_cast<std::size_t>(pairs[std::min(l + blockSize, last)][1]);
    __builtin_prefetch(x + next);
    __builtin_prefetch(v + next);
    if (spins) {
      __builtin_prefetch(particles.omega.data() + j);
      __builtin_prefetch(particles.torque.data() + j, 1);
    }
    __builtin_prefetch(particles.f.data() + j, 1);
    block.separation.set(l, x[i] - x[j]);
    block.velocity.set(l, v[i] - v[j]);
    block.armI[l] = radius[i];
    block.armJ[l] = radius[j];
  }
  if (list.image.empty()) return;
  for (std::size_t l = 0; l < n; ++l)
    if (list.image[first + l] != 0) block.separation.set(l, block.separation.at(l) + list.shift(first + l));
}

void gatherSpins(const Particles& particles, const std::array<int, 2>* pairs, std::size_t n, ContactBlock& block) {
  if (!particles.rotates()) {
    for (std::size_t l = 0; l < n; ++l) {
      block.spinI.set(l, {});
      block.spinJ.set(l, {});
    }
    return;
  }
  const Vec3* const omega = particles.omega.data();
  for (std::size_t l = 0; l < n; ++l) {
    block.spinI.set(l, omega[pairs[l][0]]);
    block.spinJ.set(l, omega[pairs[l][1]]);
  }
}

void gatherVaried(const Particles& particles, const PairList& list, std::size_t first, std::size_t n, int materials,
                  ContactBlock& block) {
  for (std::size_t l = 0; l < n; ++l) {
    const auto& pair = list.pairs[first + l];
    block.scale[l] = list.scale.empty() ? 1.0 : list.scale[first + l];
    const auto material = [&](int i) {
      return particles.material.empty() ? 0 : static_cast<int>(particles.material[static_cast<std::size_t>(i)]);
    };
    block.kind[l] = materials > 1 ? material(pair[0]) * materials + material(pair[1]) : 0;
  }
}

/// Force and torque of one side, gathered over the successive pairs of one particle.
struct Sum {
  std::size_t particle;
  Vec3 force, torque;
};

void add(Particles& particles, const Sum& sum, bool spins) {
  particles.f[sum.particle] = sum.force;
  if (spins) particles.torque[sum.particle] = sum.torque;
}

template <bool spins>
void scatterForces(Particles& particles, PairList& list, std::size_t chunkEnd, std::size_t first, std::size_t n,
                   const ContactBlock& block, std::size_t& crossing) {
  const auto* const pairs = list.pairs.data() + first;
  Vec3 *const f = particles.f.data(), *const torque = particles.torque.data();
  const auto start = [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    return Sum{k, f[k], spins ? torque[k] : Vec3{}};
  };
  Sum sum = start(pairs[0][0]);
  for (std::size_t l = 0; l < n; ++l) {
    const auto i = static_cast<std::size_t>(pairs[l][0]), j = static_cast<std::size_t>(pairs[l][1]);
    if (i != sum.particle) {
      add(particles, sum, spins);
      sum = start(pairs[l][0]);
    }
    const Vec3 force = block.velocity.at(l);
    sum.force += force;
    Vec3 torqueJ;
    if constexpr (spins) {
      const Vec3 turned = block.separation.at(l), couple = block.spinI.at(l);
      sum.torque += couple - block.armI[l] * turned;
      torqueJ = -(couple + block.armJ[l] * turned);
    }
    if (j < chunkEnd) {
      f[j] -= force;
      if constexpr (spins) torque[j] += torqueJ;
    } else {
      list.chunks.force[crossing] = -force;
      if constexpr (spins) list.chunks.torque[crossing] = torqueJ;
      ++crossing;
    }
  }
  add(particles, sum, spins);
}

}  // namespace

void gatherPairs(const Particles& particles, const PairList& list, std::size_t first, std::size_t n,
                 const GatherRows& rows, int materials, ContactBlock& block) {
  gatherGeometry(particles, list, first, n, rows.spins && particles.rotates(), block);
  const auto* const pairs = list.pairs.data() + first;
  if (rows.mass) {
    for (std::size_t l = 0; l < n; ++l) {
      block.massI[l] = particles.mass[static_cast<std::size_t>(pairs[l][0])];
      block.massJ[l] = particles.mass[static_cast<std::size_t>(pairs[l][1])];
    }
  } else {
    std::fill_n(block.massI.begin(), n, 0.0);
    std::fill_n(block.massJ.begin(), n, 1.0);
  }
  if (rows.spins) gatherSpins(particles, pairs, n, block);
  if (rows.varied) gatherVaried(particles, list, first, n, materials, block);
  for (int c = 0; c < rows.memory; ++c)
    std::copy_n(list.memory.data() + static_cast<std::size_t>(c) * list.size() + first, n,
                block.memory[static_cast<std::size_t>(c)].begin());
}

void scatterPairs(Particles& particles, PairList& list, std::size_t chunk, std::size_t first, std::size_t n,
                  const GatherRows& rows, const ContactBlock& block, std::size_t& crossing) {
  for (int c = 0; c < rows.memory; ++c)
    std::copy_n(block.memory[static_cast<std::size_t>(c)].begin(), n,
                list.memory.data() + static_cast<std::size_t>(c) * list.size() + first);
  const std::size_t chunkEnd = (chunk + 1) * list.chunks.size;
  if (rows.spins && particles.rotates())
    scatterForces<true>(particles, list, chunkEnd, first, n, block, crossing);
  else
    scatterForces<false>(particles, list, chunkEnd, first, n, block, crossing);
}

void addCrossing(Particles& particles, const PairList& list, bool spins) {
  const PairChunks& chunks = list.chunks;
  parallelFor(chunks.count(), 1, [&](std::size_t chunk, std::size_t) {
    for (std::size_t a = chunks.arrives[chunk]; a < chunks.arrives[chunk + 1]; ++a) {
      const auto crossing = static_cast<std::size_t>(chunks.arriving[a][0]),
                 j = static_cast<std::size_t>(chunks.arriving[a][1]);
      particles.f[j] += chunks.force[crossing];
      if (spins) particles.torque[j] += chunks.torque[crossing];
    }
  });
}

void prepareMemory(PairList& list, int memory, unsigned turns) {
  list.turns = turns;
  const std::size_t needed = static_cast<std::size_t>(memory) * list.size();
  if (list.memory.size() != needed) list.memory.assign(needed, 0.0);
}

ContactWork sumWork(const ContactBlock& block, std::size_t n) {
  constexpr std::size_t lanes = 8;
  std::array<double, channels> total{};
  for (std::size_t c = 0; c < channels; ++c) {
    std::array<double, lanes> sum{};
    std::size_t l = 0;
    for (; l + lanes <= n; l += lanes)
      for (std::size_t k = 0; k < lanes; ++k) sum[k] += block.work[c][l + k];
    for (std::size_t k = 0; l + k < n; ++k) sum[k] += block.work[c][l + k];
    for (const double s : sum) total[c] += s;
  }
  return {total[0], total[1], total[2], total[3], total[4], total[5], total[6], total[7]};
}

}  // namespace dovetail::dem::detail
