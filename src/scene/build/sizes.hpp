// Sizes of the grains of packings and insertions.
#pragma once

#include "dovetail/dem/bodies/clumps.hpp"
#include "dovetail/dem/setup/sizes.hpp"
#include "dovetail/scene/scene.hpp"

namespace dovetail::scene {

dem::Sizes sizesOf(const Sizes& sizes);
/// Of the clumps that an insertion brings in; none if these are spheres. @throws InputError as dem::makeClumpShape
std::vector<dem::ClumpShape> shapesOf(const Insertion& insertion);

/// The grains that an insertion brings in.
struct Entering {
  double smallest, largest;  ///< radii of their spheres, m
  double lightest;           ///< kg, with the smallest sphere
  double meanMass;           ///< kg
};
Entering enteringOf(const Insertion& insertion);
/// How many its totals allow; infinite without any.
double totalOf(const Insertion& insertion);
/// How many enter in the first `time` s of a run where there is room; without those that replace others.
double expectedIn(const Insertion& insertion, double time);

}  // namespace dovetail::scene
