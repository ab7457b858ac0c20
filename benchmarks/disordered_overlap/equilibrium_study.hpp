// A column under gravity at rest in an overlap.
#pragma once

#include <cstdint>
#include <filesystem>

#include "equilibrium.hpp"

namespace dovetail::disordered_overlap {

struct EquilibriumStudy {
  std::int64_t steps = 100000;
  bool quick = false;  ///< fewer lengths of the overlap
  std::filesystem::path folder = ".";
};

/// Prints the stress in the overlap with the correction, what remains of it after the steps, and the peaks of the
/// kinetic energy without, for several lengths of the overlap.
void runEquilibriumStudy(const EquilibriumStudy& study);

}  // namespace dovetail::disordered_overlap
