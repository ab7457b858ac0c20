// Pairs in and out of blocks.
#include <algorithm>
#include <cstring>
#include <memory>

#include "dovetail/core/error.hpp"
#include "dovetail/core/lane_sum.hpp"
#include "dovetail/core/vector_code.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"
#include "vectors.hpp"

namespace dovetail::dem::detail {

namespace {

/// What is asked of the motion of two particles, each with what stands before it.
enum class Asked { places, velocities, spinSums, spinDifferences };

/// Places up to the next multiple of four repeat the last pair.
/// @tparam within  none of the pairs is of the last particle, behind which nothing may be read
template <Asked asked, bool within>
void gatherStates(const Particles& particles, const std::array<int, 2>* pairs, std::size_t n, ContactBlock& block) {
  const Vec3 *const x = particles.x.data(), *const v = particles.v.data(), *const omega = particles.omega.data();
  const auto four = [&](std::size_t l, const std::array<int, 2>* of) {
    // Inlined, because functions that give a Four differ in their registers from version to version.
    const auto apart = [&](const Vec3* values, int k) __attribute__((always_inline)) {
      return load<within>(values[of[k][0]]) - load<within>(values[of[k][1]]);
    };
    const auto sum = [&](const Vec3* values, int k) __attribute__((always_inline)) {
      return load<within>(values[of[k][0]]) + load<within>(values[of[k][1]]);
    };
    setRows(block.normal, l, apart(x, 0), apart(x, 1), apart(x, 2), apart(x, 3));
    if constexpr (asked >= Asked::velocities)
      setRows(block.velocity, l, apart(v, 0), apart(v, 1), apart(v, 2), apart(v, 3));
    if constexpr (asked >= Asked::spinSums)
      setRows(block.spinSum, l, sum(omega, 0), sum(omega, 1), sum(omega, 2), sum(omega, 3));
    if constexpr (asked >= Asked::spinDifferences)
      setRows(block.spinDifference, l, apart(omega, 0), apart(omega, 1), apart(omega, 2), apart(omega, 3));
  };
  std::size_t l = 0;
  for (; l + 4 <= n; l += 4) four(l, pairs + l);
  if (l == n) return;
  std::array<std::array<int, 2>, 4> rest;
  for (std::size_t k = 0; k < 4; ++k) rest[k] = pairs[std::min(l + k, n - 1)];
  four(l, rest.data());
}

template <Asked asked>
void gatherStates(const Particles& particles, const std::array<int, 2>* pairs, std::size_t n, bool within,
                  ContactBlock& block) {
  withVectors([&] {
    within ? gatherStates<asked, true>(particles, pairs, n, block)
           : gatherStates<asked, false>(particles, pairs, n, block);
  });
}

void gatherStates(const Particles& particles, const std::array<int, 2>* pairs, std::size_t n, const PairRows& rows,
                  bool within, ContactBlock& block) {
  if (rows.turns && rows.spinDifferences)
    gatherStates<Asked::spinDifferences>(particles, pairs, n, within, block);
  else if (rows.turns)
    gatherStates<Asked::spinSums>(particles, pairs, n, within, block);
  else if (rows.velocities)
    gatherStates<Asked::velocities>(particles, pairs, n, within, block);
  else
    gatherStates<Asked::places>(particles, pairs, n, within, block);
}

void gatherRadii(const Particles& particles, const std::array<int, 2>* pairs, std::size_t n, ContactBlock& block) {
  const double* const radius = particles.radius.data();
  for (std::size_t l = 0; l < n; ++l) {
    block.radiusI[l] = radius[pairs[l][0]];
    block.radiusJ[l] = radius[pairs[l][1]];
  }
}

void gatherVaried(const Particles& particles, const PairParts& list, std::size_t first, int materials, std::size_t n,
                  ContactBlock& block) {
  const auto material = [&](int i) {
    return particles.material.empty() ? 0 : static_cast<int>(particles.material[static_cast<std::size_t>(i)]);
  };
  for (std::size_t l = 0; l < n; ++l) {
    const auto& pair = list.pairs[first + l];
    block.scale[l] = list.factors.empty() ? 1.0 : list.factors[first + l];
    block.kind[l] = materials > 1 ? material(pair[0]) * materials + material(pair[1]) : 0;
  }
}

/// Adds forces and torques to the sums of the chunk.
/// @tparam spins  there are torques
/// @tparam alike  they are the same on both particles
template <bool spins, bool alike>
void addToSums(const PairParts& list, PairCursor& cursor, std::size_t n, const ContactBlock& block) {
  const auto* const pairs = list.pairs.data() + cursor.pair;
  constexpr std::size_t numbers = spins ? 2 : 1;
  const auto first = static_cast<int>(cursor.firstParticle), size = static_cast<int>(cursor.particles);
  int crossing = size + static_cast<int>(cursor.crossing);
  Four* const sums = cursor.sums;
  const auto add = [&](std::size_t l, const Four& force, const Four& torqueI, const Four& torqueJ) {
    const int i = pairs[l][0] - first, inside = pairs[l][1] - first;
    const int crosses = inside >= size ? 1 : 0, j = inside + crosses * (crossing - inside);
    crossing += crosses;
    Four *const ofI = sums + numbers * static_cast<std::size_t>(i), *const ofJ =
                                                                        sums + numbers * static_cast<std::size_t>(j);
    ofI[0] += force;
    ofJ[0] -= force;
    if constexpr (spins) {
      ofI[1] += torqueI;
      ofJ[1] += torqueJ;
    }
  };
  const auto addFour = [&](std::size_t l, std::size_t count) {
    const FourVectors force = vectorsOf(block.force, l);
    FourVectors torqueI, torqueJ;
    if constexpr (spins) {
      torqueI = vectorsOf(block.torqueI, l);
      torqueJ = alike ? torqueI : vectorsOf(block.torqueJ, l);
    }
    add(l, force.a, torqueI.a, torqueJ.a);
    if (count > 1) add(l + 1, force.b, torqueI.b, torqueJ.b);
    if (count > 2) add(l + 2, force.c, torqueI.c, torqueJ.c);
    if (count > 3) add(l + 3, force.d, torqueI.d, torqueJ.d);
  };
  std::size_t l = 0;
  for (; l + 4 <= n; l += 4) addFour(l, 4);
  if (l < n) addFour(l, n - l);
  cursor.crossing = static_cast<std::size_t>(crossing - size);
}

/// Adds vectors (x, y, z, ·) to vectors of three, or puts them there. Goes by fours; returns how many it took.
template <bool adds>
std::size_t layDown(const Four* of, std::size_t count, Vec3* vectors) {
  const std::size_t most = count - count % 4;
  if (most > 0)
    withVectors([=] {
      double* to = &vectors->x;
      const auto put = [](double* row, const Four& values) __attribute__((always_inline)) {
        store(row, adds ? loadRow(row) + values : values);
      };
      for (const Four *four = of, *const end = of + most; four != end; four += 4, to += 12) {
        put(to, __builtin_shufflevector(four[0], four[1], 0, 1, 2, 4));
        put(to + 4, __builtin_shufflevector(four[1], four[2], 1, 2, 4, 5));
        put(to + 8, __builtin_shufflevector(four[2], four[3], 2, 4, 5, 6));
      }
    });
  return most;
}

/// Room for the sums of a chunk, aligned; the thread keeps it.
Four* roomForSums(std::size_t size) {
  struct Room {
    std::unique_ptr<Four[]> sums;
    std::size_t size = 0;
  };
  static thread_local Room room;
  if (room.size < size) room = {std::make_unique_for_overwrite<Four[]>(size + size / 4), size + size / 4};
  std::memset(static_cast<void*>(room.sums.get()), 0, size * sizeof(Four));  // which also brings them near
  return room.sums.get();
}

}  // namespace

void shareSizes(const Particles& particles, const PairRows& rows, ContactBlock& block) {
  const auto clear = [](ContactBlock::Rows3& row) {
    row.x.fill(0.0);
    row.y.fill(0.0);
    row.z.fill(0.0);
  };
  if (!rows.velocities) clear(block.velocity);
  block.recalls = rows.motion > 0;
  if (rows.oneRadius) {
    block.radiusI.fill(particles.radius[0]);
    block.radiusJ.fill(particles.radius[0]);
  }
  if (rows.spins && !rows.turns) clear(block.spinSum);
  if (rows.spins && !(rows.turns && rows.spinDifferences)) clear(block.spinDifference);
  if (!rows.mass || rows.oneMass) {
    const double mass = rows.mass ? 0.5 * particles.mass[0] : 0.0;
    block.rootMass.fill(std::sqrt(mass));
    block.inverseMass.fill(mass > 0.0 ? 1.0 / mass : 0.0);
  }
  if (!rows.radius)
    block.effectiveRadius.fill(0.0);
  else if (rows.oneRadius)
    block.effectiveRadius.fill(0.5 * particles.radius[0]);
}

PairCursor startOfChunk(const Particles& particles, const PairParts& list, const PairRows& rows, std::size_t chunk) {
  const PairChunks& chunks = list.chunks;
  const std::size_t first = chunk * chunks.size, count = std::min(chunks.size, particles.size() - first);
  const std::size_t crossing = chunks.crosses[chunk + 1] - chunks.crosses[chunk];
  return {chunk,
          chunks.begin[chunk],
          chunks.begin[chunk + 1],
          chunks.images[chunk],
          first,
          count,
          0,
          static_cast<std::size_t>(chunks.largest[chunk]) + 1 < particles.size(),
          roomForSums((rows.turns ? 2 : 1) * (count + crossing))};
}

void finishChunk(Particles& particles, PairParts& list, const PairRows& rows, const PairCursor& cursor) {
  PairChunks& chunks = list.chunks;
  const std::size_t begin = chunks.crosses[cursor.chunk], crossing = chunks.crosses[cursor.chunk + 1] - begin;
  const Four* sum = cursor.sums;
  const auto take = [&] { return vectorOf(*sum++); };
  std::size_t done = 0, crossed = 0;
  if (!rows.turns) {
    done = layDown<true>(sum, cursor.particles, particles.f.data() + cursor.firstParticle);
    crossed = layDown<false>(sum + cursor.particles, crossing, chunks.force.data() + begin);
  }
  for (sum += done; done < cursor.particles; ++done) {
    particles.f[cursor.firstParticle + done] += take();
    if (rows.turns) particles.torque[cursor.firstParticle + done] += take();
  }
  for (sum += crossed; crossed < crossing; ++crossed) {
    chunks.force[begin + crossed] = take();
    if (rows.turns) chunks.torque[begin + crossed] = take();
  }
}

std::size_t gatherPairs(const Particles& particles, PairParts& list, const PairRows& rows, PairCursor& cursor,
                        ContactBlock& block) {
  const std::size_t first = cursor.pair, n = std::min(blockSize, cursor.end - first);
  const auto* const pairs = list.pairs.data() + first;
  gatherStates(particles, pairs, n, rows, cursor.within, block);
  for (; cursor.image < list.images.size() && list.images[cursor.image].pair < first + n; ++cursor.image) {
    const PairImage& image = list.images[cursor.image];
    const std::size_t l = image.pair - first;
    block.normal.set(l, block.normal.at(l) + shiftOf(list.periodicity, image));
  }
  if (!rows.oneRadius) gatherRadii(particles, pairs, n, block);
  if (rows.mass && !rows.oneMass) gatherMasses(particles, {pairs, n}, block);
  if (rows.radius && !rows.oneRadius) makeRadii(n, block);
  if (rows.varied) gatherVaried(particles, list, first, rows.materials, n, block);
  for (std::size_t c = 0; c < static_cast<std::size_t>(rows.memory); ++c) {
    block.memory[c] = list.memory.data() + c * list.size() + first;
    for (std::size_t l = blockSize; l < 2 * blockSize; l += 8) __builtin_prefetch(block.memory[c] + l, 1);
  }
  for (std::size_t c = 0; c < static_cast<std::size_t>(rows.motion); ++c) {
    block.motion[c] = list.motion.data() + c * list.size() + first;
    for (std::size_t l = blockSize; l < 2 * blockSize; l += 8) __builtin_prefetch(block.motion[c] + l, 1);
  }
  return n;
}

void scatterPairs(const PairParts& list, const PairRows& rows, std::size_t n, PairCursor& cursor,
                  const ContactBlock& block) {
  withVectors([&] {
    if (!rows.turns)
      addToSums<false, false>(list, cursor, n, block);
    else if (rows.spinDifferences)
      addToSums<true, false>(list, cursor, n, block);
    else
      addToSums<true, true>(list, cursor, n, block);
  });
  cursor.pair += n;
}

void addCrossing(Particles& particles, const PairParts& list, bool spins) {
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

ContactWork sumWork(const ContactBlock& block, std::size_t n) {
  std::array<double, channels> total{};
  for (std::size_t c = 0; c < channels; ++c) {
    LaneSum sum;
    sum.add(block.work[c].data(), n);
    total[c] = sum.total();
  }
  return {total[0], total[1], total[2], total[3], total[4], total[5], total[6], total[7]};
}

}  // namespace dovetail::dem::detail
