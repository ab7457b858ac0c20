#include "run_impl.hpp"

namespace dovetail::coupling {

double SolidsTerm::move(dem::Model&, const dem::Step& step) {
  if (isAwake()) run_->outside.begin(step.dt);
  return 0.0;
}

bool SolidsTerm::isAwake() const { return run_ && run_->hasStep(); }

/// Also where forces are found anew between steps, if the solids' own kick together with the connectors'.
bool SolidsTerm::ownForcesDue(const dem::Step& step) const {
  return run_ && (run_->ownForcesDue || (step.timeless && run_->kicksTogether()));
}

void SolidsTerm::addForces(dem::Model&, const dem::Step& step) {
  if (!run_) return;
  for (const auto& solid : run_->solids) solid->side.load.clear();
  if (!isAwake()) return;
  for (const auto& solid : run_->solids) {
    solid->showVelocities(step.timeless);
    if (ownForcesDue(step)) solid->findForces(run_->sampled);
  }
}

void SolidsTerm::book(dem::Model& m, const dem::Step& step) {
  if (!isAwake()) return;
  for (const auto& solid : run_->solids) solid->hideVelocities();
  run_->outside.evaluated(m, step, run_->lateLoads());
  if (!ownForcesDue(step) || !run_->kicksTogether()) return;
  for (const auto& solid : run_->solids) solid->takeLoad();
}

/// What constraints do in both half macro steps around their ends goes with its particles.
double SolidsTerm::renumber(std::span<const int> newNumber, const dem::Particles& before) {
  if (isAwake()) run_->outside.left(run_->grains, newNumber, before);
  if (!run_ || run_->macroForce.empty()) return 0.0;
  std::vector<Vec3> moved(newNumber.size());
  std::size_t stay = 0;
  for (std::size_t i = 0; i < newNumber.size() && i < run_->macroForce.size(); ++i) {
    if (newNumber[i] < 0) continue;
    moved[static_cast<std::size_t>(newNumber[i])] = run_->macroForce[i];
    ++stay;
  }
  moved.resize(stay);
  run_->macroForce = std::move(moved);
  return 0.0;
}

}  // namespace dovetail::coupling
