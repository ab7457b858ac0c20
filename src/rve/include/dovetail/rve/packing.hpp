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

/// Grains at random places in a square (discs) or cube that repeats, relaxed until what overlaps no longer pushes, or
/// as far as that goes; numbered along the box, so that neighbours have near numbers. What `compress` starts from.
/// @throws InputError if a setting is not valid, or as makeRve
Rve randomCell(const CloudOptions& settings, const Springs& springs);

}  // namespace dovetail::rve
