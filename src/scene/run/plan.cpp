#include "plan.hpp"

#include <algorithm>
#include <cmath>

#include "cell_fields.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "frames.hpp"
#include "series.hpp"

namespace dovetail::scene {

namespace {

std::int64_t macroStepsIn(double seconds, double macroStep, const std::string& where) {
  const double count = seconds / macroStep;
  if (!(count < 1e15))
    throw InputError(formatNumber(seconds) + " s are more than 1e15 macro steps of " + formatNumber(macroStep) + " s",
                     where,
                     "take a shorter time or a larger step, or check the units of radii and meshes, which set it");
  return std::max<std::int64_t>(1, std::llround(count));
}

void requireOutputs(const Built& built, const Output& output) {
  const char* const asked = !output.probes.empty() ? "probes" : output.hdf5 ? "hdf5" : nullptr;
  if (asked && !output.series)
    throw InputError(std::string("output has ") + asked + ", but no series", output.where,
                     "give output.series an interval, or leave them out");
  if (!output.cells.empty() && !output.frames)
    throw InputError("output has cells, but no frames", output.where,
                     "give output.frames an interval, or leave them out");
  if (output.hdf5) requireHdf5();
  if (output.frames) requireFrames(output);
  shownCells(built, output);
}

}  // namespace

Plan planOf(const Built& built, const Scene& scene) {
  requireOutputs(built, scene.output);
  Plan plan;
  const double macroStep = built.run->macroStep();
  for (const Stage& stage : scene.stages)
    if (const auto* const relax = std::get_if<Relax>(&stage.kind))
      plan.stages.push_back(relax->macroSteps);
    else if (const auto* const statics = std::get_if<Statics>(&stage.kind))
      plan.stages.push_back(statics->loadSteps);
    else if (std::holds_alternative<FindModes>(stage.kind))
      plan.stages.push_back(0);
    else
      plan.stages.push_back(macroStepsIn(std::get<RunFor>(stage.kind).time, macroStep, stage.where));
  const auto interval = [&](const std::optional<double>& seconds) {
    return seconds ? macroStepsIn(*seconds, macroStep, scene.output.where) : 0;
  };
  plan.series = interval(scene.output.series);
  plan.frames = interval(scene.output.frames);
  plan.checkpoints = interval(scene.output.checkpoints);
  return plan;
}

}  // namespace dovetail::scene
