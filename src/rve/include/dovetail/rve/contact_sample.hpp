// Every contact of a cell, for pictures and statistics.
#pragma once

#include <cstdint>
#include <vector>

#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// Contacts that touch, in the order of the list, then bonds. Σ force ⊗ branch is CellState::virial.
struct ContactSample {
  std::vector<int> first, second;    ///< grains
  std::vector<Vec3> branch;          ///< from the centre of the first to that of the second, across periods, m
  std::vector<Vec3> force;           ///< on the first, N
  std::vector<std::uint8_t> slides;  ///< whether it is at the limit of friction

  std::size_t size() const { return first.size(); }
};
ContactSample sampleContacts(const Rve& cell);

}  // namespace dovetail::rve
