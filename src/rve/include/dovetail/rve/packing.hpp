// Grains to make cells of.
#pragma once

#include <cstdint>

#include "dovetail/dem/setup/sizes.hpp"
#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

struct CloudOptions {
  Shape shape = Shape::disc;
  int count = 400;  ///< grains
  dem::Sizes sizes = dem::UniformSizes{3e-3, 7e-3};
  double solidFraction = 0.7;  ///< of the cube or square that they fill; overlaps count twice; in (0, 1)
  double thickness = 0.1;      ///< of discs, m
  double density = 2650.0;     ///< kg/m³
  std::uint64_t seed = 1;      ///< same seed, same grains
};

/// A cell of these grains, pushed apart without friction until what overlaps no longer pushes, or as far as that goes;
/// its ledger begins then. What `compress` starts from. @throws InputError as makeRve
Rve relaxedCell(const Grains& grains, const geometry::Lattice& lattice, const Springs& springs);

/// Grains at random places in a square (discs) or cube that repeats, in a relaxedCell; numbered along the box, so
/// that neighbours have near numbers.
/// @throws InputError if a setting is not valid, or as makeRve
Rve randomCell(const CloudOptions& settings, const Springs& springs);

}  // namespace dovetail::rve
