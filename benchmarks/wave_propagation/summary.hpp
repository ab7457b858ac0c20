// The figures of a run as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "run.hpp"

namespace dovetail::wave {

/// Writes figures, ledger, stages, settings and provenance. What is not known is null.
/// @throws InputError as io::writeFileAtomically
void writeSummary(const std::string& file, const RunResult& result);

/// The figures alone, by key.
nlohmann::ordered_json figuresAsJson(const RunFigures& figures);

}  // namespace dovetail::wave
