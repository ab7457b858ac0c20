// What a list of pairs says of itself, and what may be changed of it.
#include <algorithm>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/pairs/pairs.hpp"
#include "list_update.hpp"

namespace dovetail::dem {

namespace {

template <class T>
void change(T& setting, const T& value, bool& outdated) {
  if (setting == value) return;
  setting = value;
  outdated = true;
}

}  // namespace

void PairList::setSkin(std::optional<double> skin) {
  if (skin) requireNonNegative(*skin, "skin of the pair list");
  change(parts_.skin, skin, parts_.outdated);
}

void PairList::setReach(double reach) {
  change(parts_.reach, requireNonNegative(reach, "reach of the pair list"), parts_.outdated);
}

void PairList::setPeriodicity(const geometry::Periodicity& periodicity) {
  change(parts_.periodicity, periodicity, parts_.outdated);
}

std::optional<std::size_t> PairList::find(const std::array<int, 2>& pair) const {
  const auto found = std::lower_bound(parts_.pairs.begin(), parts_.pairs.end(), pair);
  if (found == parts_.pairs.end() || *found != pair) return std::nullopt;
  return static_cast<std::size_t>(found - parts_.pairs.begin());
}

Vec3 PairList::shift(std::size_t pair) const {
  const auto found = std::lower_bound(parts_.images.begin(), parts_.images.end(), pair,
                                      [](const PairImage& image, std::size_t p) { return image.pair < p; });
  return found != parts_.images.end() && found->pair == pair ? detail::shiftOf(parts_.periodicity, *found) : Vec3{};
}

std::span<double> PairList::writeFactors() {
  if (parts_.factors.empty()) parts_.factors.assign(size(), 1.0);
  return parts_.factors;
}

std::span<double> PairList::prepareMemory(int numbers, unsigned turns, unsigned kind) {
  parts_.turns = turns;
  if (parts_.memoryKind != kind) {
    parts_.memoryKind = kind;
    parts_.memory.clear();
    parts_.ended = {};
  }
  const std::size_t needed = static_cast<std::size_t>(numbers) * size();
  if (parts_.memory.size() != needed) parts_.memory.assign(needed, 0.0);
  return parts_.memory;
}

void PairList::prepareMotion(int numbers, bool turns) {
  parts_.motionTurns = turns;
  const std::size_t needed = static_cast<std::size_t>(numbers) * size();
  if (parts_.motion.size() != needed) parts_.motion.assign(needed, 0.0);
}

void PairList::forgetMotion() { std::fill(parts_.motion.begin(), parts_.motion.end(), 0.0); }

void PairList::takeMemory(std::span<const std::size_t> places, const PairList& from) {
  if (places.size() != from.size() || parts_.memory.size() * from.size() != from.memory().size() * size() ||
      (from.size() > 0 && parts_.memoryKind != from.memoryKind()))
    throw InputError(std::to_string(from.memory().size()) + " numbers of memory of " + std::to_string(from.size()) +
                         " pairs do not fit into " + std::to_string(places.size()) + " places of " +
                         std::to_string(size()) + " pairs with " + std::to_string(parts_.memory.size()) + " numbers",
                     "memory of a pair list", "give one place per pair, and both lists to the same law first");
  const auto take = [&](auto& mine, const auto& others) {
    const std::size_t components = size() == 0 ? 0 : mine.size() / size();
    for (std::size_t c = 0; c < components; ++c)
      for (std::size_t k = 0; k < places.size(); ++k) mine[c * size() + places[k]] = others[c * from.size() + k];
  };
  take(parts_.memory, from.memory());
  if (parts_.motion.size() * from.size() == from.motion().size() * size()) take(parts_.motion, from.motion());
}

EndedPairs PairList::takeEnded() { return std::exchange(parts_.ended, {}); }

void PairList::putEnded(EndedPairs ended) {
  if (ended.memory.size() * parts_.ended.pairs.size() != parts_.ended.memory.size() * ended.pairs.size())
    throw InputError("the memory of ended pairs differs in size from that of the list", "putEnded",
                     "hand back what takeEnded gave, before another law sweeps");
  detail::append({parts_.ended}, ended);
  parts_.ended = std::move(ended);
}

std::size_t PairList::bytesHeld() const {
  const auto bytes = [](const auto&... arrays) { return ((arrays.capacity() * sizeof(arrays[0])) + ... + 0); };
  const PairChunks& chunks = parts_.chunks;
  return bytes(parts_.positionAtBuild, parts_.candidates, parts_.positionAtPruning) +
         bytes(parts_.pairs, parts_.images, parts_.factors, parts_.memory, parts_.motion, parts_.ended.pairs,
               parts_.ended.memory) +
         bytes(chunks.begin, chunks.crosses, chunks.force, chunks.torque, chunks.arrives, chunks.arriving,
               chunks.largest, chunks.images, chunks.candidates);
}

PairList selectPairs(const Particles& particles, const PairList& list, std::span<const std::size_t> places) {
  PairList selected;
  detail::PairParts& parts = detail::partsOf(selected);
  parts.periodicity = list.periodicity();
  for (const std::size_t p : places) {
    parts.pairs.push_back(list.pairs()[p]);
    if (!list.factors().empty()) parts.factors.push_back(list.factors()[p]);
  }
  keepPairs(particles, selected);
  return selected;
}

}  // namespace dovetail::dem
