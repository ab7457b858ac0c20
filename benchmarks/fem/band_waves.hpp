// Stiffness of waves of F in a softening solid: with averages, and with energies of its gradient.
#pragma once

namespace dovetail::benchmark {

/// Over the softening H, of a wave of so many elements; a band of its own needs all short ones above 0.
struct WaveStiffness {
  double average = 0.0;      ///< stress of the mean of F (Liu et al. 2015, A.3), reacting on F by the same weights
  double halfAverage = 0.0;  ///< of F and its mean in equal parts
  double gradient = 0.0;     ///< gradientEnergy() on quad4
  double multipliers = 0.0;  ///< second gradient with a multiplier in each element (Desrues et al. 2019, eq. 41)
};

/// @param period  elements to a wave, ≥ 2
/// @param radius  of the average, elements
/// @param band    2π √(D/H), elements
WaveStiffness stiffnessOfWave(int period, double radius, double band);

}  // namespace dovetail::benchmark
