// Static deflection of the cantilever under the particles' weight.
#pragma once

#include "reference/beam_case.hpp"

namespace dovetail::cantilever {

struct StaticOptions {
  double armOrigin = 0.0;  ///< the arm is a = y − armOrigin, m: 0 is the true arm, 0.2 (the start) the authors'
  bool shear = false;      ///< add Timoshenko's F a / (κGA)
};

/// Sag of the axis under a load F at distance `arm` from the clamp, F a³ / (3EI) [+ F a / (κGA)], m, > 0 downwards for
/// F > 0. A negative arm gives 0.
double staticDeflection(const Section& section, double force, double arm, bool shear = false);

/// Height z of the particles' centres when they rest at y: start height minus the sag under their joint weight, m.
double staticHeight(const BeamCase& beam, double y, const StaticOptions& settings = {});

}  // namespace dovetail::cantilever
