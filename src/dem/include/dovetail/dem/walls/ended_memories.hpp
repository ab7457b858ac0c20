// What contacts with walls remembered when they ended, to be booked as lost.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace dovetail::dem {

/// Memories, one after the other, and of what material the particles were.
struct EndedMemories {
  std::vector<double> memory;
  std::vector<std::uint8_t> material;
  std::vector<double> share;  ///< of what they stand for: of the particle, times that of the contact with its facet
};

/// What `sweep` gives. Where no time passes, what leavers' springs held is kept for a step in which it becomes a power.
template <class Sweep>
auto sweepWall(bool timeless, EndedMemories& left, Sweep&& sweep) {
  if (!timeless) return sweep();
  EndedMemories kept = std::exchange(left, {});
  const auto work = sweep();
  left = std::move(kept);
  return work;
}

}  // namespace dovetail::dem
