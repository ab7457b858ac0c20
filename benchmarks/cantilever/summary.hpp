// The figures of a run as JSON.
#pragma once

#include <string>

#include "run.hpp"

namespace dovetail::cantilever {

/// Writes the summary's keys, settings and provenance. @throws InputError as io::writeFileAtomically
void writeSummary(const std::string& file, const RunResult& result);

}  // namespace dovetail::cantilever
