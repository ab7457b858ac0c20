// What a run prints.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "reference_curves.hpp"
#include "run.hpp"

namespace dovetail::wave {

/// What was computed, its errors against particles alone, its energy balance, its time, dt against the critical step
/// and who sets it.
void printReport(std::ostream& out, const RunResult& result);

/// The run beside the authors' deposited curves.
void printComparison(std::ostream& out, const RunResult& result, const std::vector<ReferenceCurve>& curves);

/// The part that limits the step: "the contacts", "the bricks of the solid" or "the coupling".
std::string criticalSetter(const arlequin::CriticalStep& critical);

}  // namespace dovetail::wave
