#include <algorithm>
#include <ostream>

#include "dovetail/core/finite.hpp"
#include "dovetail/report/text.hpp"
#include "model.hpp"
#include "run.hpp"

namespace dovetail::cantilever {

using report::format, report::Json;

namespace {

/// Time-mean errors in m, printed in mm.
benchmark::Lines errorLines(const RunFigures& f) {
  const auto mm = [](const char* key, double metres, const std::string& label) {
    return benchmark::Line{key, report::numberOrNull(metres), label, "%.3f mm", 1e3};
  };
  const std::string locked = format("  with EI x %.4f (locked brick)", f.lockingFactor);
  const bool locks = f.lockingFactor != 1.0;
  return {{"", nullptr,
           "Error: time mean until leaving of the root of the summed squares of dx and dz of both particles;\n"
           "  static formula: Euler-Bernoulli; moving-mass beam: Timoshenko"},
          mm("time_mean_error_m", f.errorStatic, "static formula, arm from the clamp"),
          mm("time_mean_error_vertical_m", f.errorStaticVertical, "  dz alone"),
          mm("time_mean_error_authors_arm_m", f.errorStaticAuthors, "static formula, arm from the start (authors)"),
          mm("time_mean_error_dynamic_m", f.errorDynamic, "moving-mass beam, at the particle's own y"),
          mm("time_mean_error_dynamic_same_time_m", f.errorDynamicSameTime, "moving-mass beam, at the same time"),
          mm("time_mean_error_dynamic_locked_m", f.errorDynamicLocked, locks ? locked + ", own y" : ""),
          mm("time_mean_error_dynamic_locked_same_time_m", f.errorDynamicLockedSameTime,
             locks ? locked + ", same time" : ""),
          {"locking_factor", f.lockingFactor},
          {"leave_time_dynamic_reference_s", f.referenceLeaveTime, "moving-mass beam: particle 1 leaves at", "%.4f s"}};
}

double joulesOf(const EnergyLedger& ledger, const std::string& beginning) {
  double sum = 0.0;
  for (const auto& channel : ledger.channels())
    if (channel.name.starts_with(beginning)) sum += channel.joules;
  return sum;
}

}  // namespace

benchmark::Lines linesOf(const RunResult& result) {
  const RunFigures& f = result.figures;
  const auto counts = result.settings.elements();
  benchmark::Lines lines{
      {"", format("%d x %d x %d ", counts[0], counts[1], counts[2]) + result.settings.element, "beam"},
      {"left", f.left},
      {"leave_time_s", f.left ? Json(f.leaveTime) : Json(nullptr), "particle 1 leaves at", "%.4f s"},
      {"lateral_drift_m", f.lateralDrift, "lateral drift", "%.3g m"},
      {"no_contact_fraction", f.noContactFraction, "without contact", "%.3g %% of the time", 100.0}};
  const auto add = [&](const benchmark::Lines& more) { lines.insert(lines.end(), more.begin(), more.end()); };
  add(errorLines(f));
  add({{"", nullptr, "Energy, until leaving"},
       {"energy_initial_J", f.energyInitial, "total at the start", "%.6f J"},
       {"energy_min_J", f.energyMin, "  least", "%.6f J"},
       {"energy_max_J", f.energyMax, "  largest", "%.6f J"},
       {"energy_drift_relative", f.energyDrift, "drift", "%.3e of the start"},
       {"ledger_residual_relative", f.ledgerResidual, "ledger residual",
        "%.3e of the start, every booked channel counted"},
       {"force_residual_relative", f.forceResidual, "force residual", "%.3e of the contact force"},
       {"moment_residual_relative", f.momentResidual, "moment residual", "%.3e of the contact force x 12 m"},
       {"made_by_coupling_J", -joulesOf(result.ledger, "coupling")},
       {"dashpots_J", joulesOf(result.ledger, "dashpots")}});
  add(benchmark::timeLines(f, contactTime(), f.criticalDt));
  add({{"dt_critical_s", f.criticalDt, "critical step", "%.4e s"},
       {"dt_critical_set_by", f.criticalSetter, "set by"},
       {"", publishedSecondsPerStep, "a step of the authors' code", "about %.0f us", 1e6}});
  return lines;
}

void printReport(std::ostream& out, const RunResult& result) {
  Settings asItComes;
  asItComes.dtCapped = true;  // as nothing was asked for
  benchmark::printReport(out, "Two particles slide over an elastic cantilever", describe(result.settings),
                         describe(asItComes), linesOf(result), result.figures, result);
}

void printComparison(std::ostream& out, const RunResult& result, const std::vector<ReferenceCurve>& curves) {
  const RunFigures& f = result.figures;
  out << "Beside the authors' deposited curves (until leaving)\n"
      << "  run               leaves (s)  largest E (J)  error, true arm (mm)  authors' arm (mm)  no contact\n";
  const auto row = [&](const std::string& name, double leave, double energy, double error, double authors,
                       double fraction) {
    out << format("  %-16s %11.3f %14.4f %21.3f %18.3f %9.1f %%\n", name.c_str(), leave, energy, 1e3 * error,
                  1e3 * authors, 100.0 * fraction);
  };
  for (const ReferenceCurve& curve : curves) {
    const CurveFigures c = figuresOf(curve);
    row("authors, " + formatNumber(curve.cgWidth) + " d", c.leaveTime, c.largestEnergy, c.errorTrueArm,
        c.errorAuthorsArm, c.noContactFraction);
  }
  row("this run, " + formatNumber(result.settings.cgWidth) + " d", f.leaveTime, f.energyMax, f.errorStatic,
      f.errorStaticAuthors, f.noContactFraction);
}

}  // namespace dovetail::cantilever
