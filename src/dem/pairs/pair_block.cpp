// Pairs in and out of blocks.
#include "dovetail/core/error.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"

namespace dovetail::dem::detail {

namespace {

/// Pairs between asking the cache for a particle and using it.
constexpr std::size_t lookAhead = 128;

/// Asks the cache for what will be read of the particles some pairs later.
void announce(const Particles& particles, const PairList& list, std::size_t first, std::size_t n, bool spins) {
  const std::size_t begin = std::min(first + lookAhead, list.size()), end = std::min(begin + n, list.size());
  const Vec3 *const x = particles.x.data(), *const v = particles.v.data(), *const f = particles.f.data();
  const Vec3 *const omega = particles.omega.data(), *const torque = particles.torque.data();
  for (std::size_t p = begin; p < end; ++p) {
    const int j = list.pairs[p][1];
    __builtin_prefetch(x + j);
    __builtin_prefetch(v + j);
    __builtin_prefetch(f + j, 1);
    if (!spins) continue;
    __builtin_prefetch(omega + j);
    __builtin_prefetch(torque + j, 1);
  }
}

/// Separations and velocities.
void gatherCentres(const Particles& particles, const std::array<int, 2>* pairs, std::size_t n, ContactBlock& block) {
  const Vec3 *const x = particles.x.data(), *const v = particles.v.data();
  for (std::size_t l = 0; l < n; ++l) {
    const int i = pairs[l][0], j = pairs[l][1];
    block.separation.set(l, x[i] - x[j]);
    block.velocity.set(l, v[i] - v[j]);
  }
}

void gatherRadii(const Particles& particles, const std::array<int, 2>* pairs, std::size_t n, bool same,
                 ContactBlock& block) {
  const double* const radius = particles.radius.data();
  if (same) {
    std::fill_n(block.radiusI.begin(), n, radius[0]);
    std::fill_n(block.radiusJ.begin(), n, radius[0]);
    return;
  }
  for (std::size_t l = 0; l < n; ++l) {
    block.radiusI[l] = radius[pairs[l][0]];
    block.radiusJ[l] = radius[pairs[l][1]];
  }
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

void gatherVaried(const Particles& particles, const PairList& list, std::size_t first, int materials, std::size_t n,
                  ContactBlock& block) {
  const auto material = [&](int i) {
    return particles.material.empty() ? 0 : static_cast<int>(particles.material[static_cast<std::size_t>(i)]);
  };
  for (std::size_t l = 0; l < n; ++l) {
    const auto& pair = list.pairs[first + l];
    block.scale[l] = list.scale.empty() ? 1.0 : list.scale[first + l];
    block.kind[l] = materials > 1 ? material(pair[0]) * materials + material(pair[1]) : 0;
  }
}

/// Force and torque of one side, gathered over the successive pairs of one particle.
template <bool spins>
struct Sum {
  std::size_t particle;
  Vec3 force, torque;
  Sum(const Particles& particles, std::size_t i)
      : particle(i), force(particles.f[i]), torque(spins ? particles.torque[i] : Vec3{}) {}
  void store(Particles& particles) const {
    particles.f[particle] = force;
    if constexpr (spins) particles.torque[particle] = torque;
  }
};

template <bool spins>
void scatterForces(Particles& particles, PairList& list, PairCursor& cursor, std::size_t n, const ContactBlock& block) {
  const auto* const pairs = list.pairs.data() + cursor.pair;
  Vec3 *const f = particles.f.data(), *const torque = particles.torque.data();
  const std::size_t chunkEnd = (cursor.chunk + 1) * list.chunks.size;
  std::size_t crossing = cursor.crossing;
  Sum<spins> sum(particles, static_cast<std::size_t>(pairs[0][0]));
  for (std::size_t l = 0; l < n; ++l) {
    const auto i = static_cast<std::size_t>(pairs[l][0]), j = static_cast<std::size_t>(pairs[l][1]);
    if (i != sum.particle) {
      sum.store(particles);
      sum = Sum<spins>(particles, i);
    }
    const Vec3 force = block.force.at(l);
    sum.force += force;
    Vec3 torqueJ;
    if constexpr (spins) {
      const Vec3 turning = block.turning.at(l), couple = block.couple.at(l);
      sum.torque += couple - block.armI[l] * turning;
      torqueJ = -(couple + block.armJ[l] * turning);
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
  sum.store(particles);
  cursor.crossing = crossing;
}

}  // namespace

void requireMaterials(const Particles& particles, int materials) {
  if (materials == 1) return;
  parallelFor(particles.material.size(), 16384, [&](std::size_t begin, std::size_t end) {
    const auto first = particles.material.begin();
    const auto unknown = std::find_if(first + static_cast<std::ptrdiff_t>(begin),
                                      first + static_cast<std::ptrdiff_t>(end), [=](int m) { return m >= materials; });
    if (const auto i = static_cast<std::size_t>(unknown - first); i < end)
      throw InputError("material " + std::to_string(particles.material[i]) + " has no law",
                       "particle " + std::to_string(i) + ", material",
                       "give materials from 0 to " + std::to_string(materials - 1) + ", or a larger table of laws");
  });
}

void findUniform(const Particles& particles, PairRows& rows) {
  requireMaterials(particles, rows.materials);
  // Where the ends differ nobody looks between them: sizes are either the same or mixed, as a rule.
  const auto uniform = [](const std::vector<double>& values) {
    if (values.empty() || values.front() != values.back()) return false;
    return parallelSum(values.size(), 16384, [&](std::size_t begin, std::size_t end) {
             int differ = 0;
             for (std::size_t i = begin; i < end; ++i) differ += values[i] != values[0] ? 1 : 0;
             return differ;
           }) == 0;
  };
  rows.oneRadius = uniform(particles.radius);
  rows.oneMass = rows.mass && particles.weight.empty() && uniform(particles.mass);
}

void shareSizes(const Particles& particles, const PairRows& rows, ContactBlock& block) {
  if (!rows.mass)
    block.rootMass.fill(0.0);
  else if (rows.oneMass)
    block.rootMass.fill(std::sqrt(0.5 * particles.mass[0]));
  if (!rows.radius)
    block.effectiveRadius.fill(0.0);
  else if (rows.oneRadius)
    block.effectiveRadius.fill(0.5 * particles.radius[0]);
}

PairCursor startOfChunk(const PairList& list, std::size_t chunk) {
  return {chunk, list.chunks.begin[chunk], list.chunks.begin[chunk + 1], list.chunks.crosses[chunk],
          list.chunks.images[chunk]};
}

std::size_t gatherPairs(const Particles& particles, const PairList& list, const PairRows& rows, PairCursor& cursor,
                        ContactBlock& block) {
  const std::size_t first = cursor.pair, n = std::min(blockSize, cursor.end - first);
  const auto* const pairs = list.pairs.data() + first;
  announce(particles, list, first, n, rows.spins && particles.rotates());
  gatherCentres(particles, pairs, n, block);
  for (; cursor.image < list.images.size() && list.images[cursor.image].pair < first + n; ++cursor.image) {
    const PairImage& image = list.images[cursor.image];
    const std::size_t l = image.pair - first;
    block.separation.set(l, block.separation.at(l) + list.shift(image));
  }
  gatherRadii(particles, pairs, n, rows.oneRadius, block);
  if (rows.mass && !rows.oneMass) gatherMasses(particles, {pairs, n}, block);
  if (rows.radius && !rows.oneRadius) makeRadii(n, block);
  if (rows.spins) gatherSpins(particles, pairs, n, block);
  if (rows.varied) gatherVaried(particles, list, first, rows.materials, n, block);
  for (std::size_t c = 0; c < static_cast<std::size_t>(rows.memory); ++c)
    std::copy_n(list.memory.data() + c * list.size() + first, n, block.memory[c].begin());
  return n;
}

void scatterPairs(Particles& particles, PairList& list, const PairRows& rows, std::size_t n, PairCursor& cursor,
                  const ContactBlock& block) {
  for (std::size_t c = 0; c < static_cast<std::size_t>(rows.memory); ++c)
    std::copy_n(block.memory[c].begin(), n, list.memory.data() + c * list.size() + cursor.pair);
  if (rows.spins && particles.rotates())
    scatterForces<true>(particles, list, cursor, n, block);
  else
    scatterForces<false>(particles, list, cursor, n, block);
  cursor.pair += n;
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
