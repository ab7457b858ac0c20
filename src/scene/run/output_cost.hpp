// What a run writes, and what enters it.
#pragma once

#include <iosfwd>

#include "plan.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene {

/// Rows, frames with their room on disk, and grains that are expected to enter, one a line.
void reportOutput(const Built& built, const Scene& scene, const Plan& plan, std::ostream& log);
/// Frames at every macro step, and more of them than the disk holds. Of a started run.
void lookAtOutput(const Built& built, const Scene& scene, Lines& lines);

}  // namespace dovetail::scene
