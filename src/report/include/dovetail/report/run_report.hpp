// The report of a run.
#pragma once

#include <filesystem>

#include "dovetail/report/page.hpp"
#include "dovetail/report/run_record.hpp"

namespace dovetail::report {

/// Figures of energies, residual, momenta, forces and time per stage; tables of the energy balance, of errors where the
/// run has a reference, of residuals, times, the critical step and what sets it; warnings, provenance, the scene.
/// @param photo  of the run, first on the page; without bytes there is none
Page pageOf(const RunRecord& record, const Photo& photo = {});

/// Writes the report into the folder of the run, as writePage.
/// @return the HTML file. @throws InputError as readRunFolder, or if a name is taken by a file that is not from a run
std::filesystem::path writeRunReport(const std::filesystem::path& folder, const Photo& photo = {});

}  // namespace dovetail::report
