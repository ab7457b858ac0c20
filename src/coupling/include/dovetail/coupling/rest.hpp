// Bringing a run to rest in parts, for those who look at it, save it or end it on the way.
#pragma once

#include "dovetail/coupling/run.hpp"

namespace dovetail::coupling {

/// How far it has come; with the run's own state all that there is to go on from.
struct RestProgress {
  RestReport report;
  double before = 0.0;     ///< J, kinetic energy at the macro step before
  std::int32_t quiet = 0;  ///< oscillations in a row that were at rest
};

/// Goes on with relax(run, options) by up to so many macro steps: any number of parts is the same as one.
/// @return whether it has ended, at rest or given up (report.atRest)
/// @throws as relax
bool relaxOn(CoupledRun& run, const RestOptions& options, RestProgress& progress, std::int64_t macroSteps);

}  // namespace dovetail::coupling
