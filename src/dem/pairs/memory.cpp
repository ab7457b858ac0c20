// What stays with a pair when the list or the numbers of particles change.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dovetail/core/distribute.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"
#include "list_update.hpp"

namespace dovetail::dem {

namespace {

using detail::Belongings;
using detail::Pair;
using detail::PairParts;

constexpr double apart = -std::numeric_limits<double>::infinity();

std::uint8_t materialOf(const Particles& particles, int i) {
  const auto k = static_cast<std::size_t>(i);
  return k < particles.material.size() ? particles.material[k] : std::uint8_t{0};
}

bool before(const Pair& a, const Pair& b) {
  const auto key = [](const Pair& pair) {
    return static_cast<std::uint64_t>(pair[0]) << 32 | static_cast<std::uint32_t>(pair[1]);
  };
  return key(a) < key(b);
}

EndedPair withoutTouch(const Particles& particles, const Pair& pair, double factor) {
  const auto [i, j] = pair;
  if (std::max(i, j) >= static_cast<int>(particles.size())) return {{0, 0}, factor, apart, 0.0, 0.0};
  return {{materialOf(particles, i), materialOf(particles, j)}, factor, apart, 0.0, 0.0};
}

/// Of a pair that goes with a particle.
EndedPair asItIs(const Particles& particles, const PairParts& list, std::size_t p, double factor) {
  const auto i = static_cast<std::size_t>(list.pairs[p][0]), j = static_cast<std::size_t>(list.pairs[p][1]);
  EndedPair ended = withoutTouch(particles, list.pairs[p], factor);
  Vec3 d = particles.x[i] - particles.x[j];
  if (list.periodicity.any()) d = list.periodicity.minimumImage(d);
  const double ri = particles.radius[i], rj = particles.radius[j], mi = particles.mass[i], mj = particles.mass[j];
  ended.overlap = ri + rj - norm(d);
  ended.effectiveMass = mi * mj / (mi + mj);
  ended.effectiveRadius = ri * rj / (ri + rj);
  return ended;
}

/// Where an old pair goes.
struct Move {
  Pair pair;
  std::uint32_t from;
  bool swapped;
};

/// The pairs that stay, by their new numbers; the others are ended.
Pairs movePairs(Buckets<Move>& moves, const Belongings& from, PairParts& list) {
  Pairs pairs(moves.size());
  const std::size_t n = pairs.size();
  from.makeRoom(n, list);
  parallelFor(moves.count(), 1, [&](std::size_t b, std::size_t) {
    const auto bucket = moves[b];
    std::sort(bucket.begin(), bucket.end(), [](const Move& a, const Move& c) { return a.pair < c.pair; });
    for (std::size_t k = 0; k < bucket.size(); ++k) {
      const Move& move = bucket[k];
      const std::size_t p = moves.begin[b] + k;
      pairs[p] = move.pair;
      if (!from.factors.empty()) list.factors[p] = from.factors[move.from];
      for (std::size_t c = 0; c < from.components; ++c) {
        const bool turns = move.swapped && (list.turns >> c & 1u) != 0;
        list.memory[c * n + p] = (turns ? -1.0 : 1.0) * from.remembered(c, move.from);
      }
      for (std::size_t c = 0; c < from.motions; ++c) {
        const bool turns = move.swapped && list.motionTurns;
        list.motion[c * n + p] = (turns ? -1.0 : 1.0) * from.motion[c * from.pairs + move.from];
      }
    }
  });
  return pairs;
}

}  // namespace

namespace detail {

Belongings::Belongings(PairBelongings& of, std::size_t count)
    : memory(std::exchange(of.memory, {})),
      factors(std::exchange(of.factors, {})),
      motion(std::exchange(of.motion, {})),
      pairs(count),
      components(count == 0 ? 0 : memory.size() / count),
      motions(count == 0 ? 0 : motion.size() / count) {}

bool Belongings::remembersAnything(std::size_t p) const {
  for (std::size_t c = 0; c < components; ++c)
    if (remembered(c, p) != 0.0) return true;
  return false;
}

void Belongings::makeRoom(std::size_t count, PairParts& list) const {
  list.memory.resize(components * count);
  list.motion.resize(motions * count);
  if (!factors.empty()) list.factors.resize(count);
}

void Belongings::hand(std::size_t o, std::size_t p, std::size_t count, PairParts& list) const {
  for (std::size_t c = 0; c < components; ++c)
    std::copy_n(memory.data() + c * pairs + o, count, list.memory.data() + c * list.size() + p);
  for (std::size_t c = 0; c < motions; ++c)
    std::copy_n(motion.data() + c * pairs + o, count, list.motion.data() + c * list.size() + p);
  if (!factors.empty()) std::copy_n(factors.data() + o, count, list.factors.data() + p);
}

void Belongings::end(const EndedPair& pair, std::size_t p, EndedPairs& ended) const {
  ended.pairs.push_back(pair);
  for (std::size_t c = 0; c < components; ++c) ended.memory.push_back(remembered(c, p));
}

void append(const std::vector<EndedPairs>& parts, EndedPairs& all) {
  for (const EndedPairs& part : parts) {
    all.pairs.insert(all.pairs.end(), part.pairs.begin(), part.pairs.end());
    all.memory.insert(all.memory.end(), part.memory.begin(), part.memory.end());
  }
}

namespace {

/// Newcomers p … end − 1 remember nothing.
void startAnew(const Belongings& from, std::size_t p, std::size_t end, PairParts& list) {
  for (std::size_t c = 0; c < from.components; ++c) std::fill_n(list.memory.data() + c * list.size() + p, end - p, 0.0);
  for (std::size_t c = 0; c < from.motions; ++c) std::fill_n(list.motion.data() + c * list.size() + p, end - p, 0.0);
  if (!from.factors.empty()) std::fill_n(list.factors.data() + p, end - p, 1.0);
}

}  // namespace

void carryChunk(const Particles& particles, const Pairs& old, const Belongings& from, std::size_t chunk,
                PairParts& list, EndedPairs& ended) {
  const std::size_t chunks = list.chunks.count();
  const auto at = [&](std::size_t c) {
    const Pair first{static_cast<int>(c * list.chunks.size), -1};
    return static_cast<std::size_t>(std::lower_bound(old.begin(), old.end(), first) - old.begin());
  };
  std::size_t p = list.chunks.begin[chunk], o = at(chunk);
  const std::size_t end = list.chunks.begin[chunk + 1], oldEnd = chunk + 1 < chunks ? at(chunk + 1) : old.size();
  while (o < oldEnd) {
    const std::size_t newcomers = p;
    while (p < end && before(list.pairs[p], old[o])) ++p;
    if (p > newcomers) startAnew(from, newcomers, p, list);
    std::size_t run = 0;
    while (o + run < oldEnd && p + run < end && list.pairs[p + run] == old[o + run]) ++run;
    from.hand(o, p, run, list);
    o += run;
    p += run;
    if (run > 0) continue;
    if (from.remembersAnything(o)) from.end(withoutTouch(particles, old[o], from.factor(o)), o, ended);
    ++o;
  }
  startAnew(from, p, end, list);
}

}  // namespace detail

Contact detail::atRest(const EndedPair& pair) {
  Contact contact;
  contact.overlap = contact.overlapBefore = pair.overlap;
  contact.effectiveMass = pair.effectiveMass;
  contact.rootMass = std::sqrt(pair.effectiveMass);
  contact.effectiveRadius = pair.effectiveRadius;
  contact.normal = {1.0, 0.0, 0.0};
  contact.dt = 1e-100;  // so short that no memory advances
  return contact;
}

void renumber(PairList& of, std::span<const int> newNumber, const Particles& before) {
  PairParts& list = detail::partsOf(of);
  constexpr std::size_t chunkSize = 16384;
  const Pairs& old = list.pairs;
  const Belongings from(list, old.size());
  const std::size_t tasks = (old.size() + chunkSize - 1) / chunkSize, particles = newNumber.size();
  const std::size_t rows = std::max<std::size_t>(1024, particles / 512), buckets = particles / rows + 1;
  const auto numbers = [&](std::size_t p) {
    return Pair{newNumber[static_cast<std::size_t>(old[p][0])], newNumber[static_cast<std::size_t>(old[p][1])]};
  };
  std::vector<EndedPairs> ended(tasks);
  parallelFor(old.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      if (const Pair to = numbers(p); to[0] < 0 || to[1] < 0)
        from.end(asItIs(before, list, p, from.factor(p)), p, ended[begin / chunkSize]);
  });
  auto moves = distribute<Move>(tasks, buckets, [&](std::size_t task, auto&& sink) {
    for (std::size_t p = task * chunkSize; p < std::min(old.size(), (task + 1) * chunkSize); ++p) {
      const auto [i, j] = numbers(p);
      if (i < 0 || j < 0) continue;
      const Pair pair{std::min(i, j), std::max(i, j)};
      sink(static_cast<std::size_t>(pair[0]) / rows, Move{pair, static_cast<std::uint32_t>(p), i > j});
    }
  });
  detail::append(ended, list.ended);
  list.pairs = movePairs(moves, from, list);
  list.images.clear();
  list.candidates.clear();
  list.particleRevision = -1;
  detail::makeChunks(particles, list);  // without images: for those who look before the next update
}

}  // namespace dovetail::dem
