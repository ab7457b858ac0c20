#include "summary.hpp"

#include "common/json.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "report.hpp"

namespace dovetail::wave {

using benchmark::Json;
using benchmark::numberOrNull;

namespace {

void addShares(Json& json, const RunFigures& f) {
  json["energy_input_J"] = numberOrNull(f.energyInput);
  json["energy_final_J"] = numberOrNull(f.energyFinal);
  json["energy_lost_share"] = numberOrNull(f.lostShare);
  json["energy_absorbed_share"] = numberOrNull(f.absorbedShare);
  json["coupling_work_share"] = numberOrNull(f.couplingWorkShare);
  json["ledger_residual_relative"] = numberOrNull(f.ledgerResidual);
  json["momentum_residual_relative"] = numberOrNull(f.momentumResidual);
  json["mass_residual_relative"] = numberOrNull(f.massResidual);
  json["largest_energy_over_available"] = numberOrNull(f.largestExcess);
  json["paper_dissipated_share"] = numberOrNull(f.paperDissipatedShare);
  json["overlap_mismatch"] = numberOrNull(f.overlapMismatch);
  json["gap_max_m"] = numberOrNull(f.gapMax);
}

void addComparison(Json& json, const RunFigures& f) {
  const auto compared = [&](double value) { return f.compared ? numberOrNull(value) : Json(nullptr); };
  json["waveform_error_fem"] = compared(f.waveformErrorFem);
  json["waveform_error_dem"] = compared(f.waveformErrorDem);
  json["reflected_energy_share"] = compared(f.reflectedShare);
  json["speed_ratio_to_full_dem"] = compared(f.speedRatio);
}

}  // namespace

Json figuresAsJson(const RunFigures& f) {
  Json json;
  json["finished"] = f.finished;
  json["stable"] = f.stable;
  json["failure"] = f.failure;
  json["steps"] = f.steps;
  json["end_time_s"] = f.endTime;
  json["wall_seconds"] = f.wallSeconds;
  json["seconds_per_step"] = f.steps > 0 ? f.wallSeconds / static_cast<double>(f.steps) : 0.0;
  json["particles"] = f.particles;
  json["overlap_particles"] = f.overlapParticles;
  json["elements"] = f.elements;
  json["coupling_rows"] = f.coupledNodes;
  json["dt_s"] = f.dt;
  json["critical_step_s"] = {{"particles", numberOrNull(f.critical.particles)},
                             {"solid", numberOrNull(f.critical.solid)},
                             {"together", numberOrNull(f.critical.together)}};
  json["critical_step_set_by"] = criticalSetter(f.critical);
  json["penalty_used_Pa_m2"] = numberOrNull(f.penalty);
  addShares(json, f);
  addComparison(json, f);
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

}  // namespace dovetail::wave
