// Runs that end at another time than was planned.
#pragma once

#include "checkpoints.hpp"
#include "plan.hpp"

namespace dovetail::scene {

/// Lets the last stage of the scene end at `until`, s since the start, from where the run stands.
/// @throws InputError if that has passed, if the last stage brings to rest, or if one before it still has to
void lengthen(Scene& scene, const Plan& plan, const Progress& progress, const coupling::CoupledRun& run, double until);

}  // namespace dovetail::scene
