// What a scene of the matrix is measured for.
#pragma once

#include <array>
#include <string>

#include "matrix_case.hpp"

namespace dovetail::coupling_matrix {

/// Fractions of the critical step that the energy is looked at with; the second one serves for all else.
inline constexpr std::array<double, 3> fractions{0.04, 0.02, 0.01};

struct Figures {
  std::string refused;  ///< why the combination cannot be; empty: it can, and what follows is measured
  std::string broke{};  ///< what the run broke down with; empty: it did not
  double dt = 0.0;      ///< s, of the second fraction
  /// Residual of the ledger over the energy turned over, by fractions: the median of ten looks in a run.
  std::array<double, 3> energy{};
  double largestEnergy = 0.0;       ///< the largest of these looks
  std::array<double, 3> angular{};  ///< residual of angular momentum over the moments of all impulses, by fractions
  double momentum = 0.0;            ///< residual over the magnitudes of all impulses
  double mass = 0.0;                ///< residual over the mass
  double friction = 0.0;            ///< what sliding contacts lost over the energy turned over
  bool threads = false;             ///< one and two threads give the same digits
  bool restart = false;             ///< a run that goes on from a saved state gives the same digits
  double seconds = 0.0;             ///< it took

  double energyOrder() const;   ///< between the first and the last fraction
  double angularOrder() const;  ///< the same
};

/// @param steps  of the particles at the second fraction, a multiple of 80; the others go on for the same time
/// @throws InputError for another number of steps
Figures measure(const Case& c, int steps);

/// What is asked of a case: empty, or what falls short.
std::string shortfall(const Case& c, const Figures& figures);

}  // namespace dovetail::coupling_matrix
