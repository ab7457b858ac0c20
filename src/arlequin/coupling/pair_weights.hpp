// The weights of the contacts of an overlap.
#pragma once

#include <span>
#include <vector>

#include "dovetail/arlequin/overlap.hpp"
#include "dovetail/dem/pairs/pairs.hpp"

namespace dovetail::arlequin {

/// A pair of particles i < j of which one at least is a member of the overlap.
struct PairWeight {
  int i, j;
  double weight;
};

/// Weights of the listed pairs of an overlap. A pair has the weight w of the place of its contact when it is listed,
/// and keeps it until one of its particles is located anew.
class PairWeights {
public:
  /// Brings the pairs up to those of the list; writes their factors, but for pairs that are muted.
  /// @param position  of the nodes, m   @param memberOf  row of each particle in the overlap, −1: none
  void update(const dem::Particles& particles, dem::PairList& list, const fem::SolidMesh& mesh, const Overlap& overlap,
              std::span<const Vec3> position, std::span<const int> memberOf);
  /// Pairs of these particles get a new weight at the next update. @param isMoved  one per particle
  void forget(std::span<const char> isMoved);
  void renumber(std::span<const int> newNumber);

  std::vector<PairWeight> pairs;  ///< ascending
};

}  // namespace dovetail::arlequin
