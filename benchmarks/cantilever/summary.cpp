#include "summary.hpp"

#include "common/json.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"

namespace dovetail::cantilever {

using benchmark::Json;

Json figuresAsJson(const RunFigures& f) {
  Json json;
  json["finished"] = f.finished;
  json["stable"] = f.stable;
  json["left"] = f.left;
  json["failure"] = f.failure;
  json["steps"] = f.steps;
  json["end_time_s"] = f.endTime;
  json["wall_seconds"] = f.wallSeconds;
  json["seconds_per_step"] = f.steps > 0 ? f.wallSeconds / static_cast<double>(f.steps) : 0.0;
  json["dt_s"] = f.dt;
  json["dt_critical_s"] = f.criticalDt;
  json["dt_critical_set_by"] = f.criticalSetter;
  json["leave_time_s"] = f.left ? Json(f.leaveTime) : Json(nullptr);
  json["energy_initial_J"] = f.energyInitial;
  json["energy_min_J"] = f.energyMin;
  json["energy_max_J"] = f.energyMax;
  json["energy_drift_relative"] = f.energyDrift;
  json["ledger_residual_relative"] = f.ledgerResidual;
  json["largest_energy_over_available"] = f.largestExcess;
  json["lateral_drift_m"] = f.lateralDrift;
  json["force_residual_relative"] = f.forceResidual;
  json["moment_residual_relative"] = f.momentResidual;
  json["time_mean_error_m"] = f.errorStatic;
  json["time_mean_error_vertical_m"] = f.errorStaticVertical;
  json["time_mean_error_authors_arm_m"] = f.errorStaticAuthors;
  json["time_mean_error_dynamic_m"] = f.errorDynamic;
  json["time_mean_error_dynamic_same_time_m"] = f.errorDynamicSameTime;
  json["time_mean_error_dynamic_locked_m"] = f.errorDynamicLocked;
  json["time_mean_error_dynamic_locked_same_time_m"] = f.errorDynamicLockedSameTime;
  json["locking_factor"] = f.lockingFactor;
  json["leave_time_dynamic_reference_s"] = f.referenceLeaveTime;
  json["no_contact_share"] = f.noContactShare;
  return json;
}

void writeSummary(const std::string& file, const RunResult& result) {
  Json json = figuresAsJson(result.figures);
  json["ledger"] = benchmark::ledgerAsJson(result.ledger);
  if (!result.profile.rows().empty()) json["profile"] = benchmark::profileAsJson(result.profile);
  json["settings"] = benchmark::objectOf(describe(result.settings));
  json["case"] = benchmark::objectOf(describeCase());
  json["provenance"] = benchmark::objectOf(io::provenance());
  io::writeFileAtomically(file, json.dump(2) + "\n");
}

}  // namespace dovetail::cantilever
