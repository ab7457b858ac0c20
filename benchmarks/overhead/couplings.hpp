// What joins grains and block.
#pragma once

#include "dovetail/coupling/run.hpp"
#include "grains.hpp"
#include "solids.hpp"

namespace dovetail::overhead {

/// Steps a run whose parts are there, and prints what its grains and solids have.
inline void finish(coupling::CoupledRun& run, const Size& size) {
  run.start(dt);
  run.advance(size.steps);
  double kinetic = dem::energies(run.grains).kinetic;
  for (std::size_t s = 0; s < run.solids(); ++s) kinetic += fem::kineticEnergy(run.solid(s).nodes());
  printEnergy(kinetic);
}

}  // namespace dovetail::overhead
