// How far the runs of a study lie from their reference.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study_cases.hpp"

namespace dovetail::program {

/// Adds to each row whose reference is there "error" and, beside a curve, "covered"; of several columns also the parts,
/// "error_<column>". A row that cannot be compared says why.
/// @param runs  of the plan, in the order of the rows
/// @return "scatter" where the reference is repeated and all repeats are there: the root of the mean square of the
///         distances of its curves from their mean
report::Json addErrors(const StudySettings& settings, const std::vector<StudyRun>& runs,
                       std::vector<report::Json>& rows);

/// Draws the reference and the first runs beside it, a file for each column of the error.
void drawCurves(const StudySettings& settings);
/// Names of these files.
std::vector<std::string> curveFiles(const StudySettings& settings);

/// The column of a reference file, or its two columns of other names. @throws InputError
report::Curve curveOfFile(const std::filesystem::path& file, const Against& against, const std::string& column);

}  // namespace dovetail::program
