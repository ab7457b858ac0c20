// Glass beads: the grains of all three examples, and their law.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "dovetail/dem/laws/rolling.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/packing.hpp"

namespace dovetail::example {

/// Beads of 2 mm, diameters uniform to ± 10 % so that they do not order into a crystal. The spring is soft, as usual
/// where grains are hard enough to hardly overlap: k = 10⁴ m g/d sinks in by 10⁻⁴ d under a bead's own weight.
struct Beads {
  double diameter = 2e-3;    ///< d, m
  double density = 2500.0;   ///< kg/m³
  double friction = 0.5;     ///< of beads and walls
  double restitution = 0.7;  ///< e
  double rolling = 0.0;      ///< μ_r, see dem::RollingResistance; 0: none
  double gravity = 9.81;     ///< m/s²

  double mass() const { return density * std::numbers::pi / 6.0 * diameter * diameter * diameter; }  // kg
  double stiffness() const { return 1e4 * mass() * gravity / diameter; }                             // N/m
  /// √(d/g), s: in which a bead falls half its diameter.
  double fallTime() const { return std::sqrt(diameter / gravity); }
  dem::UniformSizes sizes() const { return {0.45 * diameter, 0.55 * diameter}; }

  dem::LinearSpringDashpot normal() const { return {stiffness(), restitution, false, false, true}; }
  dem::TangentialSpring tangential() const { return {2.0 / 7.0 * stiffness(), friction}; }
  /// Spring of the rolling resistance as Ai et al. 2011 take it.
  dem::RollingResistance rollingResistance() const { return {rolling, 2.25 * rolling * rolling}; }
  /// A step: 1/18 of the time two beads touch.
  double step() const { return normal().contactTime(0.5 * mass()) / 18.0; }
};

using SlidingLaw = dem::ContactLaw<dem::LinearSpringDashpot, dem::TangentialSpring>;
using RollingLaw = dem::ContactLaw<dem::LinearSpringDashpot, dem::TangentialSpring, dem::RollingResistance>;

/// A box of beads at random places, loose enough to be made in a moment, dense enough to settle soon.
inline dem::Packing looseBeads(const Beads& beads, const geometry::Periodicity& space, std::uint64_t seed) {
  dem::GrowthOptions growth;
  growth.solidFraction = 0.5;
  growth.overlap = 1e-2;
  growth.seed = seed;
  dem::PackingReport report;
  return dem::growPacking(beads.sizes(), space, growth, report);
}

/// A model of beads that knows its law and gravity, but has neither beads nor walls.
template <class Law>
dem::Model emptyModel(const Beads& beads, const Law& law, Profile& profile) {
  dem::Model model;
  model.laws = dem::makeContactLaws(law);
  model.gravity = {0.0, 0.0, -beads.gravity};
  model.pairs.setSkin(0.2 * beads.diameter);
  model.profile = &profile;
  return model;
}

/// Runs on; calls watch(model) `samples` times at even distances, the last time at the end.
template <class Watch>
void runAndWatch(dem::Model& model, double dt, double duration, int samples, Watch&& watch) {
  const auto steps = static_cast<std::int64_t>(duration / dt / samples + 0.5);
  for (int s = 0; s < samples; ++s) {
    dem::run(model, dt, steps);
    watch(model);
  }
}

}  // namespace dovetail::example
