// One coupled run and its figures.
#pragma once

#include <string>
#include <vector>

#include "common/outputs.hpp"
#include "common/report.hpp"
#include "reference/error_norms.hpp"
#include "reference_curves.hpp"
#include "settings.hpp"

namespace dovetail::cantilever {

using benchmark::Frame, benchmark::Observer;

/// The authors' code needs about 26 ms per step of this case (DEM and implicit FEM), about 4 h for its run of 549 869
/// steps to 50 s; measured with their public code on one core.
inline constexpr double publishedSecondsPerStep = 0.026;

struct RunFigures : benchmark::RunFigures {
  bool left = false;  ///< particle 1 has passed the free end
  double criticalDt = 0.0;
  std::string criticalSetter;

  double leaveTime = 0.0;                                        ///< s, 0 if not left
  double energyInitial = 0.0, energyMin = 0.0, energyMax = 0.0;  ///< J, until leaving
  double energyDrift = 0.0, ledgerResidual = 0.0;                ///< relative to the initial energy
  double lateralDrift = 0.0;                                     ///< m
  double momentResidual = 0.0;  ///< |moments of particle and nodal loads together| / (Σ|f| × beam length)
  double forceResidual = 0.0;   ///< |particle and nodal loads together| / Σ|f|
  double noContactFraction = 0.0;

  double errorStatic = 0.0, errorStaticAuthors = 0.0;  ///< m, true arm and the authors' arm
  double errorStaticVertical = 0.0;                    ///< m, true arm, Δz alone: what lateral drift does not touch
  // Against the moving-mass beam: at the particle's own y, as the static formula, or at the same time.
  double errorDynamic = 0.0, errorDynamicSameTime = 0.0;              ///< m, exact EI
  double errorDynamicLocked = 0.0, errorDynamicLockedSameTime = 0.0;  ///< m, EI × locking factor
  double lockingFactor = 1.0;
  double referenceLeaveTime = 0.0;  ///< s, moving-mass beam with the exact EI
};

struct RunResult : benchmark::RunData {
  Settings settings;
  RunFigures figures;
  std::vector<PairSample> samples;  ///< trajectory until the end
};

/// Builds the model and chooses the step. @throws InputError for impossible settings
benchmark::PreparedRun<RunResult> prepareRun(const Settings& settings);

/// Prepares and runs.
RunResult run(const Settings& settings, const Observer& observer = {});

/// Whether the run is set beside the moving-mass beam: not if it was told to end before a particle left, because the
/// beam is computed until leaving.
bool comparesWithBeam(const RunResult& result);

/// Fills in the errors against the static and dynamic references. The dynamic ones are computed once per case; NaN
/// where they were not compared, where there is no reference (a contact too stiff for it), or where the run went where
/// the reference never was.
void compare(RunResult& result);

/// The moving-mass beam for the settings' contact stiffness and the given bending factor; kept after the first call.
const DynamicReference& dynamicReference(const Settings& settings, double bendingFactor);

/// All figures, as reports and summaries have them.
benchmark::Lines linesOf(const RunResult& result);
/// What was computed, its errors, its energy balance, its time, dt against the critical step and who sets it.
void printReport(std::ostream& out, const RunResult& result);
/// The run beside the authors' deposited curves.
void printComparison(std::ostream& out, const RunResult& result, const std::vector<ReferenceCurve>& curves);

}  // namespace dovetail::cantilever
