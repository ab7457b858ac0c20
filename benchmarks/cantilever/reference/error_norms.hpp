// Time-mean distance of two simulated particles from a reference.
#pragma once

#include <array>
#include <span>

#include "dovetail/core/vec3.hpp"
#include "reference/moving_mass.hpp"
#include "reference/static_reference.hpp"

namespace dovetail::cantilever {

/// Centres of the two particles; x = 0 in the middle plane, y from the clamp, z from the undeformed axis, m.
struct PairSample {
  double time;            ///< s
  std::array<Vec3, 2> x;  ///< started at x = +startX and −startX, in either order throughout
};

/// err(t) = √Σ(Δx² + Δz²) over both particles, with Δx from the start's ±startX and Δz from the reference.
struct PairError {
  double mean = 0.0;     ///< ∫ err dt / T, trapezoidal rule, m
  double largest = 0.0;  ///< m
  double until = 0.0;    ///< last sample used, s
};

/// The functions below use the samples up to the last one where both particles are on the beam (y ≤ length).
/// Times ascend. @throws InputError if fewer than two samples can be used

/// Δz at the particle's own y from the static formula.
PairError errorFromStatic(std::span<const PairSample> samples, const BeamCase& beam,
                          const StaticOptions& settings = {});
/// Δz at the same time from the dynamic reference; ends when the reference's particles leave, if that is earlier.
PairError errorFromDynamicAtTime(std::span<const PairSample> samples, const BeamCase& beam,
                                 const DynamicReference& reference);
/// Δz at the same y from the dynamic reference: blind to a particle that is late. A secondary figure.
PairError errorFromDynamicAtY(std::span<const PairSample> samples, const BeamCase& beam,
                              const DynamicReference& reference);

/// The reference's own trajectory as samples of two particles that stay at x = ±startX.
std::vector<PairSample> pairSamples(const BeamCase& beam, const DynamicReference& reference);

}  // namespace dovetail::cantilever
