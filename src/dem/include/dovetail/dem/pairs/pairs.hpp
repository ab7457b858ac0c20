// Particle–particle contacts: which pairs are near, and what they remember.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "dovetail/dem/pairs/pair_parts.hpp"
#include "dovetail/dem/particles/particles.hpp"

namespace dovetail {
class ByteReader;
class ByteWriter;
}  // namespace dovetail

namespace dovetail::dem {

class PairList;

namespace detail {
/// For the functions that make lists and go through them: who takes the parts keeps them in step.
PairParts& partsOf(PairList& list);
const PairParts& partsOf(const PairList& list);
}  // namespace detail

/// Pairs closer than the sum of their radii + skin when the list was made, and what stays with them.
///
/// A Verlet list, `candidates`, rebuilt when a particle has moved more than skin/2, with a pruned inner list (Páll &
/// Hess, Comput. Phys. Commun. 184, 2013): `pairs` are the candidates closer than the sum of their radii + innerSkin,
/// pruned anew when a particle has moved more than innerSkin/2. The inner skin adapts: the longer the candidates last,
/// the thinner it is, and the fewer pairs without contact are listed. Lists of fewer than pruneFrom pairs are not
/// pruned: innerSkin = skin.
class PairList {
public:
  static constexpr double defaultSkin = 0.15;
  static constexpr std::size_t pruneFrom = 4096;

  // ---- settings: a list that was made under others no longer fits, and is made anew at its next update

  /// m; 0 = a search at every step. Not set: defaultSkin mean diameters, from the first search on.
  std::optional<double> skin() const { return parts_.skin; }
  /// @throws InputError unless it is finite and ≥ 0
  void setSkin(std::optional<double> skin);
  /// m: of the law beyond touch, see ContactLaws::reach; adds to the skins.
  double reach() const { return parts_.reach; }
  /// @throws InputError unless it is finite and ≥ 0
  void setReach(double reach);
  /// Periodic axes. Each search moves particles into the box, so that they leave it by no more than the skin.
  const geometry::Periodicity& periodicity() const { return parts_.periodicity; }
  void setPeriodicity(const geometry::Periodicity& periodicity);

  // ---- which pairs there are

  const Pairs& pairs() const { return parts_.pairs; }  ///< i < j, sorted
  std::size_t size() const { return parts_.size(); }
  /// The place of a pair i < j among them. O(log n).
  std::optional<std::size_t> find(const std::array<int, 2>& pair) const;
  /// Of the pairs that meet across a period, ascending.
  const std::vector<PairImage>& images() const { return parts_.images; }
  /// Vector to be added to x_i − x_j of a pair, m; zero without periodic axes. O(log n).
  Vec3 shift(std::size_t pair) const;
  const PairChunks& chunks() const { return parts_.chunks; }
  std::int64_t builds() const { return parts_.builds; }      ///< number of searches
  std::int64_t revision() const { return parts_.revision; }  ///< how often `pairs` has changed

  // ---- how long they last

  /// Whether the list was made for the particles as they are numbered now, under the settings as they are.
  bool fits(const Particles& particles) const;
  /// Whether the next update may search for pairs, if no particle moves farther than `step` (m) until then.
  bool maySearch(const Particles& particles, double step) const;
  std::size_t particles() const { return parts_.particles(); }   ///< for how many it was made
  const Pairs& candidates() const { return parts_.candidates; }  ///< i < j, sorted; empty unless pruned
  double innerSkin() const { return parts_.innerSkin; }          ///< m
  /// Bound on how far any particle has moved since the list was made, m, by the steps that updatePairs was given; ∞ of
  /// lists that keepPairs keeps.
  double travel() const { return parts_.travel; }

  // ---- what stays with a pair while it is listed

  /// Per pair: factor on its force and energies, such as the particles' fraction of an overlap, 0 = muted; empty = 1. A
  /// new pair has 1 until it is set, which is due when `revision` has changed.
  const RawVector<double>& factors() const { return parts_.factors; }
  double factor(std::size_t pair) const { return parts_.factors.empty() ? 1.0 : parts_.factors[pair]; }
  /// The same for writing, one for each pair.
  std::span<double> writeFactors();
  /// All are 1 again.
  void clearFactors() { parts_.factors.clear(); }

  /// Memory of the contacts, by component: number c of pair p is memory()[c * size() + p]. A tangential spring takes
  /// three numbers, its stretch, m. Empty unless the law has memory.
  const RawVector<double>& memory() const { return parts_.memory; }
  /// The same for writing, with room for the memories of a law: all zero if they were of another size or kind.
  /// @param numbers per pair @param turns, kind see laws.hpp
  std::span<double> prepareMemory(int numbers, unsigned turns, unsigned kind);
  unsigned memoryKind() const { return parts_.memoryKind; }  ///< ContactLaw::memoryKind
  /// How contacts moved in the last step, for dashpots (see Recall), by component as memory(), m/s and rad/s.
  const RawVector<double>& motion() const { return parts_.motion; }
  /// Makes room for it: all zero, which means unknown, if it was of another size.
  /// @param turns  the numbers change their signs when the two particles change roles
  void prepareMotion(int numbers, bool turns);
  void forgetMotion();
  /// Copies the memory of the pairs of another list into places of this one, and how they moved if both know it.
  /// @throws InputError unless there are as many places as pairs, and both lists have as much memory per pair
  void takeMemory(std::span<const std::size_t> places, const PairList& from);
  /// Pairs that have left the list since the last call.
  EndedPairs takeEnded();
  /// Puts them back, for another caller.
  /// @throws InputError if others have left meanwhile with memory of another size
  void putEnded(EndedPairs ended);

  std::size_t bytesHeld() const;  ///< memory taken

  /// For checkpoints: all but what follows from it.
  void save(ByteWriter& writer) const;
  /// @throws InputError if what was saved is no list: pairs out of order or of no particles, images of no pair, lengths
  /// that do not match
  void load(ByteReader& reader);

private:
  friend detail::PairParts& detail::partsOf(PairList& list);
  friend const detail::PairParts& detail::partsOf(const PairList& list);
  detail::PairParts parts_;
};

namespace detail {
inline PairParts& partsOf(PairList& list) { return list.parts_; }
inline const PairParts& partsOf(const PairList& list) { return list.parts_; }
}  // namespace detail

/// Moves particles into the periodic box and makes the list anew; memories and factors of pairs that stay are kept.
/// @throws InputError if a periodic box is too small for two particles and the skin; NumericalError naming a particle
///         whose position is not finite
void findPairs(Particles& particles, PairList& list);

/// Makes the list anew if some particle has moved more than skin/2 since it was made, or if the list no longer fits;
/// prunes it anew when that is due. Returns whether `pairs` has changed.
/// @param step bound on how far any particle has moved since the last call, m, as kickAndDrift, startStep and turnStep
/// return it; without one every particle is looked at
bool updatePairs(Particles& particles, PairList& list, double step = std::numeric_limits<double>::infinity());

/// Moves positions by whole periods into the periodic box. Pair lists made before are made anew at their next update,
/// and keep their memories.
void wrapPositions(Particles& particles, const geometry::Periodicity& periodicity);

/// Gives the pairs the new numbers of their particles, memories and factors included, and sorts them. Pairs of removed
/// particles (new number < 0) leave: the energy of their springs is booked as lost by the next sweep of a law.
/// @param newNumber one per particle of the list
/// @param before    the particles as they are numbered until now, removed ones included
void renumber(PairList& list, std::span<const int> newNumber, const Particles& before);

/// For fixed lists of bonded laws: if the list is out of date, after renumber or when particles were added (which get
/// no pairs), makes the data anew that depend on the particles' numbers. Images are the nearest ones. Should the list
/// be updated after all, it is made anew.
void keepPairs(const Particles& particles, PairList& list);

/// A fixed list of some pairs of another one, with their factors and without memory.
/// @param places ascending
PairList selectPairs(const Particles& particles, const PairList& list, std::span<const std::size_t> places);

/// Sorts the particles along a space-filling curve, so that near in number means near in space, and makes the list anew
/// if there is one. Returns old number → new number, for whatever else refers to particles.
std::vector<int> sortParticles(Particles& particles, PairList& list);

}  // namespace dovetail::dem
