// Lists of pairs in checkpoints.
#include <algorithm>
#include <cmath>
#include <concepts>
#include <type_traits>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/error.hpp"
#include "list_update.hpp"

// Members of structures that have gaps.
namespace dovetail::geometry {
template <class Archive, class T>
requires std::same_as<std::remove_const_t<T>, Periodicity>
void archiveFields(Archive& archive, T& space) { archive(space.box, space.axes); }
}  // namespace dovetail::geometry

namespace dovetail::dem {

template <class Archive, class T>
requires std::same_as<std::remove_const_t<T>, PairImage>
void archiveFields(Archive& archive, T& image) { archive(image.pair, image.periods); }
template <class Archive, class T>
requires std::same_as<std::remove_const_t<T>, EndedPair>
void archiveFields(Archive& archive, T& pair) {
  archive(pair.materials, pair.factor, pair.overlap, pair.effectiveMass, pair.effectiveRadius);
}

namespace {

using detail::Pair;
using detail::PairParts;

template <class Archive, class List>
void archiveParts(Archive& archive, List& l) {
  archive(l.skin, l.periodicity, l.pairs, l.builds, l.revision, l.innerSkin, l.candidates, l.innerTravel,
          l.positionAtPruning, l.updatesSincePruning, l.images, l.factors, l.memory, l.turns, l.memoryKind, l.motion,
          l.motionTurns, l.ended.memory, l.ended.pairs, l.positionAtBuild, l.particleRevision, l.wraps, l.travel);
}

void require(bool holds, const char* otherwise) {
  if (!holds) throw InputError(otherwise, "pair list of a checkpoint", "read a file that this version has written");
}

/// Whether pairs are sorted, i < j, none of them twice, of so many particles.
bool areInOrder(const Pairs& pairs, std::size_t particles) {
  const auto wrong = [&](const Pair& pair) {
    return pair[0] < 0 || pair[0] >= pair[1] || static_cast<std::size_t>(pair[1]) >= particles;
  };
  return std::none_of(pairs.begin(), pairs.end(), wrong) &&
         std::adjacent_find(pairs.begin(), pairs.end(), std::greater_equal<>()) == pairs.end();
}

bool areImagesOf(const std::vector<PairImage>& images, std::size_t pairs) {
  const auto disorder = [](const PairImage& a, const PairImage& b) { return a.pair >= b.pair; };
  return std::adjacent_find(images.begin(), images.end(), disorder) == images.end() &&
         (images.empty() || images.back().pair < pairs);
}

/// Whether there are as many numbers for each.
bool areFor(std::size_t items, std::size_t numbers) { return items == 0 ? numbers == 0 : numbers % items == 0; }

bool isLength(double x) { return x >= 0.0 && std::isfinite(x); }

void requireSearch(const PairParts& list) {
  require(!list.skin || isLength(*list.skin), "the skin is not finite and >= 0");
  require(isLength(list.innerSkin) && list.travel >= 0.0 && list.innerTravel >= 0.0, "a skin or a path is negative");
  require(areInOrder(list.candidates, list.particles()), "candidates are out of order");
  require(!list.pruned() || list.positionAtPruning.size() == list.particles(), "positions of a pruning are missing");
  require(list.particleRevision < 0 || !list.pruned() || list.candidates.size() >= list.size(),
          "a pruned list lacks its candidates");
}

void requirePairs(const PairParts& list) {
  require(areInOrder(list.pairs, list.particles()), "pairs are out of order");
  require(areImagesOf(list.images, list.size()), "images are out of order");
  require(list.factors.empty() || list.factors.size() == list.size(), "factors are not one per pair");
  require(areFor(list.size(), list.memory.size()), "memories are not as many for each pair");
  require(areFor(list.size(), list.motion.size()), "velocities are not as many for each pair");
  require(areFor(list.ended.pairs.size(), list.ended.memory.size()), "memories are not as many for each ended pair");
}

}  // namespace

void PairList::save(ByteWriter& writer) const {
  if (!parts_.outdated) return archiveParts(writer, parts_);
  PairParts parts = parts_;
  parts.particleRevision = -1;  // says that it is to be made anew
  archiveParts(writer, parts);
}

void PairList::load(ByteReader& reader) {
  PairParts parts;
  archiveParts(reader, parts);
  requireSearch(parts);
  requirePairs(parts);
  parts.reach = parts_.reach;
  detail::makeChunks(parts.particles(), parts);
  detail::findRanges(parts.particles(), parts.candidates, parts.chunks.candidates);
  parts_ = std::move(parts);
}

}  // namespace dovetail::dem
