// The file in which a calibration keeps what experiments gave.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "dovetail/calibration/experiments.hpp"

namespace dovetail::calibration {

inline constexpr const char* evaluationFileName = "evaluations.json";

/// By the names under which they were kept; none if there is no file.
/// @throws InputError if the file cannot be read as one
std::map<std::string, Outcome> readEvaluations(const std::filesystem::path& folder);
void writeEvaluations(const std::filesystem::path& folder, const std::map<std::string, Outcome>& known);

/// All that a probe is asked for.
std::string textOfProbe(const Experiment& experiment);
/// Version and commit: another build may give other digits.
std::string buildName();

}  // namespace dovetail::calibration
