#include "plan.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "frames.hpp"
#include "series.hpp"

namespace dovetail::scene {

namespace {

std::int64_t windowsIn(double seconds, double window, const std::string& where) {
  const double count = seconds / window;
  if (!(count < 1e15))
    throw InputError(formatNumber(seconds) + " s are more than 1e15 windows of " + formatNumber(window) + " s", where,
                     "take a shorter time or a larger step, or look at the units of radii and meshes, which set it");
  return std::max<std::int64_t>(1, std::llround(count));
}

void requireOutputs(const Output& output) {
  const char* const asked = !output.probes.empty() ? "probes" : output.hdf5 ? "hdf5" : nullptr;
  if (asked && !output.series)
    throw InputError(std::string("output has ") + asked + ", but no series", output.where,
                     "give output.series an interval, or leave them out");
  if (output.hdf5) requireHdf5();
  if (output.frames) requireFrames(output);
}

}  // namespace

Plan planOf(const Built& built, const Scene& scene) {
  requireOutputs(scene.output);
  Plan plan;
  const double window = built.run->window();
  for (const Stage& stage : scene.stages)
    if (const auto* const settle = std::get_if<Settle>(&stage.kind))
      plan.stages.push_back(settle->windows);
    else
      plan.stages.push_back(windowsIn(std::get<RunFor>(stage.kind).time, window, stage.where));
  const auto interval = [&](const std::optional<double>& seconds) {
    return seconds ? windowsIn(*seconds, window, scene.output.where) : 0;
  };
  plan.series = interval(scene.output.series);
  plan.frames = interval(scene.output.frames);
  plan.checkpoints = interval(scene.output.checkpoints);
  return plan;
}

}  // namespace dovetail::scene
