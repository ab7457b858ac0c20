// The figures of a run as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "run.hpp"

namespace dovetail::cantilever {

/// Writes the summary's keys, settings and provenance. @throws InputError as io::writeFileAtomically
void writeSummary(const std::string& file, const RunResult& result);

/// The figures alone, by key.
nlohmann::ordered_json figuresAsJson(const RunFigures& figures);

}  // namespace dovetail::cantilever
