// What a run prints.
#pragma once

#include <iosfwd>
#include <vector>

#include "reference_curves.hpp"
#include "run.hpp"

namespace dovetail::cantilever {

/// What was computed, its errors, its energy balance, its time, dt against the critical step and who sets it.
void printReport(std::ostream& out, const RunResult& result);

/// The run beside the authors' deposited curves.
void printComparison(std::ostream& out, const RunResult& result, const std::vector<ReferenceCurve>& curves);

}  // namespace dovetail::cantilever
