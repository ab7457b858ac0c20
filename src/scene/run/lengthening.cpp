#include "lengthening.hpp"

#include <cstdio>
#include <cstdlib>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::scene {

namespace {

constexpr const char* where = "--until";

/// When the last stage began or will begin, s.
double startOfLast(const Scene& scene, const Plan& plan, const Progress& progress, const coupling::CoupledRun& run) {
  const std::size_t last = scene.stages.size() - 1;
  const bool isRunning = progress.stage <= last && std::holds_alternative<RunFor>(scene.stages[progress.stage].kind);
  std::int64_t macroSteps = isRunning ? -progress.macroStep : 0;
  double loading = 0.0;  // s
  for (std::size_t k = progress.stage; k < last; ++k) {
    if (std::holds_alternative<Relax>(scene.stages[k].kind))
      throw InputError(
          "stage " + std::to_string(k + 1) + " has not come to rest yet, so that the time until rest is unknown", where,
          "resume the run without it until stage " + std::to_string(k + 2) + " has begun");
    if (const auto* const statics = std::get_if<Statics>(&scene.stages[k].kind)) {
      const std::int64_t left = plan.stages[k] - (k == progress.stage ? progress.macroStep : 0);
      loading += statics->time.value_or(0.0) * static_cast<double>(left) / static_cast<double>(plan.stages[k]);
      continue;
    }
    macroSteps += plan.stages[k];
  }
  return run.time() + loading + static_cast<double>(macroSteps) * run.macroStep();
}

/// Without what is left over of sums of steps.
double withoutRoundoff(double seconds) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.12g", seconds);
  return std::strtod(digits, nullptr);
}

}  // namespace

void lengthen(Scene& scene, const Plan& plan, const Progress& progress, const coupling::CoupledRun& run, double until) {
  auto* const last = scene.stages.empty() ? nullptr : std::get_if<RunFor>(&scene.stages.back().kind);
  if (!last)
    throw InputError("the last stage does not run for a time", where,
                     "continue in another scene whose grains and solids start from this run's checkpoint");
  const double time = until - startOfLast(scene, plan, progress, run);
  if (!(until >= run.time() - 0.5 * run.macroStep() && time > 0.5 * run.macroStep()))
    throw InputError(
        formatNumber(until) + " s is not later than the checkpoint, at t = " + formatNumber(run.time()) + " s", where,
        "give a later time");
  last->time = withoutRoundoff(time);
}

}  // namespace dovetail::scene
