// Vibration modes of a beam by the Ritz method with polynomials.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "reference/beam_case.hpp"

namespace dovetail::cantilever {

enum class Supports { clampedFree, simplySupported };

struct BeamTheory {
  Supports supports = Supports::clampedFree;
  bool shear = true;          ///< Timoshenko's shear flexibility; off: Bernoulli's θ = w'
  bool rotaryInertia = true;  ///< kinetic energy ½ ρI θ̇²
  int basis = 48;             ///< polynomials per field
};

/// A field Σ_k c_k J_k(s / L), where J_k is the `integrals`-fold integral of P_{k + first}.
struct RitzField {
  int integrals = 0, first = 0;
  Eigen::MatrixXd coefficient;  ///< polynomials × modes
};

/// Modes normalised to unit modal mass: the beam's energy is ½ Σ (q̇_j² + ω_j² q_j²), with w(s) = Σ q_j φ_j(s) upwards
/// and θ(s) = Σ q_j ψ_j(s), the rotation of the section, which equals w' minus the shear angle.
struct BeamModes {
  double length = 0.0;
  std::vector<double> omega;  ///< rad/s, ascending
  RitzField deflection, rotation;
};

/// Minimises V = ½∫ EI θ'² + κGA (w' − θ)² against T = ½∫ ρA ẇ² + ρI θ̇².
/// @param count modes kept, the lowest ones
/// @throws InputError if the basis holds fewer modes, or is not in 2 … 160
BeamModes computeModes(const Section& section, double length, const BeamTheory& theory, int count);

/// Values and derivatives by s of every mode at one point; one row per mode.
struct ModeShapes {
  Eigen::MatrixX3d deflection, rotation;  ///< columns: value, first, second derivative
};
/// @param s distance from the left support, 0 … length, m
ModeShapes evaluateModes(const BeamModes& modes, double s);

}  // namespace dovetail::cantilever
