#include "step_control.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "run_state.hpp"

namespace dovetail::fem::detail {

namespace {

constexpr double wantedChange = 0.02;  // of the bound from look to look

/// Lumped mass over the least that the blended one can be.
double leastMass(double fraction) { return 1.0 - 26.0 / 27.0 * fraction; }

bool hasBody(const Model& model) {
  return std::ranges::any_of(model.terms, [](const auto& term) { return term->isBody(); });
}

void requireOptions(const ExplicitOptions& options) {
  if (!(options.safety >= 0.0 && options.safety <= 1.0))
    throw InputError("safety is " + formatNumber(options.safety), "ExplicitOptions",
                     "give a fraction of the stable step, 0 to 1");
  if (options.safety > 0.0 && options.measureEvery < 1)
    throw InputError("measureEvery is " + std::to_string(options.measureEvery), "ExplicitOptions", "give 1 or more");
  requireNonNegative(options.shortest, "shortest");
}

}  // namespace

StepControl::StepControl(Model& model, double dt, const ExplicitOptions& options)
    : options_(options), longest_(requirePositive(dt, "dt")), dt_(dt) {
  requireOptions(options);
  if (follows()) {
    follow(model);
  } else if (options.checkStep && hasBody(model)) {
    const StableStep stable = look(model);
    if (dt > critical_)
      throw InputError("dt is " + formatNumber(dt) + " s, the largest stable step is " + formatNumber(critical_) + " s",
                       stable.owner + " sets it",
                       "take a smaller step, a coarser mesh there, an implicit scheme, or ExplicitOptions::safety");
  }
}

StableStep StepControl::look(Model& model) {
  const StableStep stable = stableStep(model);
  critical_ = stable.dt * std::sqrt(leastMass(options_.massFraction));
  return stable;
}

void StepControl::follow(Model& model) {
  const double before = critical_;
  const StableStep stable = look(model);
  const double dt = std::min(longest_, options_.safety * critical_);
  if (!(dt > 0.0 && dt >= options_.shortest * first_))
    throw NumericalError("the step has fallen to " + formatNumber(dt) + " s",
                         stable.owner + ", t = " + formatNumber(model.t) + " s",
                         "the element is crushed: take a law or a mesh that resists, or a smaller "
                         "ExplicitOptions::shortest");
  dt_ = dt;
  if (before == 0.0) first_ = dt, range_ = {dt, dt, stable.element, stable.solid};
  range_.longest = std::max(range_.longest, dt);
  if (dt < range_.shortest) range_.shortest = dt, range_.element = stable.element, range_.solid = stable.solid;
  const double change = before == 0.0 ? wantedChange : std::abs(critical_ / before - 1.0);
  const double wanted = static_cast<double>(interval_) * wantedChange / std::max(change, 0.5 * wantedChange);
  interval_ =
      std::clamp(static_cast<std::int64_t>(wanted), std::int64_t{1}, static_cast<std::int64_t>(options_.measureEvery));
  wait_ = interval_;
}

void StepControl::accept(Model& model) {
  if (follows() && --wait_ == 0) follow(model);
}

void StepControl::save(ByteWriter& archive) const {
  if (!follows()) return;
  archive(dt_, first_, critical_, interval_, wait_, range_.shortest, range_.longest,
          static_cast<std::int64_t>(range_.element), range_.solid);
}

StepControl StepControl::read(ByteReader& archive) const {
  StepControl control = *this;
  if (!follows()) return control;
  control.dt_ = requirePositive(readNumber(archive, "step"), "step of the state");
  control.first_ = requirePositive(readNumber(archive, "first step"), "first step of the state");
  control.critical_ = requirePositive(readNumber(archive, "stable step"), "stable step of the state");
  control.interval_ = readCount(archive, "number of steps");
  control.wait_ = readCount(archive, "number of steps");
  control.range_.shortest = readNumber(archive, "shortest step");
  control.range_.longest = readNumber(archive, "longest step");
  control.range_.element = static_cast<int>(readCount(archive, "number of an element"));
  control.range_.solid = readText(archive);
  if (control.wait_ < 1)
    throw InputError("no steps are left to the next look", "state", "load it into the run that saved it");
  return control;
}

}  // namespace dovetail::fem::detail
