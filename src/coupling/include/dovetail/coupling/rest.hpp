// Relaxing a run in parts, to inspect, save or end it on the way.
#pragma once

#include "dovetail/coupling/run.hpp"

namespace dovetail::coupling {

/// Progress of a relaxation; with the state of the run it is enough to continue.
struct RestProgress {
  RestReport report;
  std::int64_t stops = 0;
  double before = 0.0;     ///< J, kinetic energy at the macro step before
  std::int32_t quiet = 0;  ///< oscillations in a row that were at rest
};

/// Continues relax(run, rest) by up to so many macro steps; the result does not depend on the number of parts.
/// @return whether it has ended, at rest or given up (report.atRest)
/// @throws as relax
bool relaxOn(CoupledRun& run, const RestCriterion& rest, RestProgress& progress, std::int64_t macroSteps);

}  // namespace dovetail::coupling
