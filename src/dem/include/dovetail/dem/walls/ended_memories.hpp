// Memory of ended contacts with walls, to be booked as lost.
#pragma once

#include <cstdint>
#include <vector>

namespace dovetail::dem {

/// Memories, one after the other, and of what material the particles were.
struct EndedMemories {
  std::vector<double> memory;
  std::vector<std::uint8_t> material;
  std::vector<double> fraction;  ///< of what they stand for: of the particle, times that of the contact with its facet
};

}  // namespace dovetail::dem
