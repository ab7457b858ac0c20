// A constant force moving at constant speed over a beam.
#pragma once

#include <vector>

#include "reference/beam_modes.hpp"

namespace dovetail::cantilever {

struct MovingForce {
  double force = 1.0;  ///< downwards, N
  double speed = 1.0;  ///< m/s
  double dt = 0.0;     ///< s
};

struct BeamHistory {
  std::vector<double> time, deflection;  ///< s; m, upwards
};

/// Deflection of the axis at `observed` (m from the left support) while the force crosses the beam, which starts at
/// rest. Velocity Verlet on the modal equations. @throws InputError if dt is unstable for the highest mode
BeamHistory simulateMovingForce(const BeamModes& modes, const MovingForce& load, double observed);

}  // namespace dovetail::cantilever
