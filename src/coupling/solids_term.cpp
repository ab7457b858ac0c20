#include "run_impl.hpp"

namespace dovetail::coupling {

/// Also where forces are found anew between steps, if the solids' own kick together with the connectors'.
bool SolidsTerm::ownForcesDue(const dem::Step& step) const {
  return run_ && (run_->ownForcesDue || (step.timeless && run_->kicksTogether()));
}

void SolidsTerm::addForces(dem::Model&, const dem::Step& step) {
  if (!run_) return;
  for (const auto& solid : run_->solids) {
    solid->side.load.clear();
    if (ownForcesDue(step)) solid->findForces(run_->sampled);
  }
}

void SolidsTerm::book(dem::Model&, const dem::Step& step) {
  if (!ownForcesDue(step) || !run_->kicksTogether()) return;
  for (const auto& solid : run_->solids) solid->takeLoad();
}

}  // namespace dovetail::coupling
