#include <algorithm>
#include <cmath>
#include <ostream>

#include "dovetail/core/finite.hpp"
#include "dovetail/report/text.hpp"
#include "reference_curves.hpp"

namespace dovetail::wave {

using benchmark::Line, benchmark::Lines, report::format, report::Json;

namespace {

/// The part that limits the step.
std::string criticalSetter(const arlequin::CriticalStep& c) {
  if (c.together < 0.98 * std::min(c.particles, c.solid)) return "the coupling";
  return c.particles <= c.solid ? "the contacts" : "the bricks of the solid";
}

std::string signalText(const Settings& s) {
  if (s.impulse())
    return format("impulse of %g m/s on the first layer", s.amplitude * Case{}.velocity * s.particlesPerEdge);
  return format("raised cosine, %d of %.4g elements (omega = %.4g rad/ms), up to %g m/s", s.cycles, s.pulseElements,
                1e-3 * angularFrequency(s), 2.0 * s.amplitude * Case{}.cosineVelocity);
}

/// What is printed of particles alone has no label.
Lines caseLines(const Settings& s, const RunFigures& f) {
  const bool coupled = !s.fullDem;
  return {
      {"",
       format("%g x %g x %g m, %d^3 particles per element", barLength(s), Case{}.side, Case{}.side, s.particlesPerEdge),
       "bar"},
      {"particles", f.particles, coupled ? "particles" : "particles, alone", "%.0f"},
      {"elements", f.elements, coupled ? "bricks" : "", "%.0f"},
      {"overlap_particles", f.overlapParticles, coupled ? "particles in the overlap" : "", "%.0f"},
      {"coupling_rows", f.coupledNodes, coupled ? "rows of the coupling" : "", "%.0f"},
      {"penalty_used_Pa_m2", f.penalty, f.penalty > 0.0 ? "penalty" : "", "%.4g Pa/m2"},
      {"", signalText(s), "signal"}};
}

Lines comparisonLines(const RunFigures& f) {
  const auto compared = [&](double value) { return f.compared ? report::numberOrNull(value) : Json(nullptr); };
  return {{"", nullptr, f.compared ? "Beside particles alone, at the end" : ""},
          {"waveform_error_fem", compared(f.waveformErrorFem), "waveform error, solid past the overlap",
           "%.3e of the wave there"},
          {"waveform_error_dem", compared(f.waveformErrorDem), "waveform error, particles before it",
           "%.3e of the whole wave"},
          {"reflected_energy_fraction", compared(f.reflectedFraction), "reflected energy", "%.3e of the input"},
          {"speed_ratio_to_full_dem", compared(f.speedRatio), "run time over that of particles alone", "%.3g"}};
}

Lines balanceLines(const Settings& s, const RunFigures& f) {
  const bool coupled = !s.fullDem;
  return {
      {"", nullptr, "Energy"},
      {"energy_input_J", f.energyInput, "put in", "%.6g J"},
      {"energy_final_J", f.energyFinal, "left at the end", "%.6g J"},
      {"energy_lost_fraction", f.lostFraction, "lost, not absorbed on purpose", "%.3e of the input"},
      {"coupling_work_fraction", f.couplingWorkFraction, coupled ? "lost (-) or made (+) by the coupling" : ""},
      {"energy_absorbed_fraction", f.absorbedFraction, s.absorber > 0.0 ? "absorbed" : ""},
      {"paper_dissipated_fraction", report::numberOrNull(f.paperDissipatedFraction),
       "dissipated as the authors count it", "%.4f"},
      {"ledger_residual_relative", f.ledgerResidual, "ledger residual, largest", "%.3e, every booked channel counted"},
      {"", nullptr, "Balance"},
      {"momentum_residual_relative", f.momentumResidual, "momentum residual", "%.3e of the largest momentum"},
      {"mass_residual_relative", f.massResidual, "mass residual", "%.3e of the bar's mass"},
      {"overlap_mismatch", f.overlapMismatch, coupled ? "speeds of the models in the overlap differ" : "",
       "%.3e (rms) of the speed there"},
      {"gap_max_m", f.gapMax, coupled ? "largest gap" : "", "%.3e m"}};
}

/// The authors' figure for the run's n and width, if it is one of theirs.
Json publishedFraction(const Settings& s) {
  if (s.scheme != "paper" || !s.impulse()) return nullptr;
  for (const PublishedRun& run : publishedRuns)
    if (run.particlesPerEdge == s.particlesPerEdge && run.cgWidth == s.cgWidth) return run.dissipatedFraction;
  return nullptr;
}

}  // namespace

Lines linesOf(const RunResult& result) {
  const RunFigures& f = result.figures;
  const arlequin::CriticalStep& c = f.critical;
  Lines lines = caseLines(result.settings, f);
  for (const Lines& more : {comparisonLines(f), balanceLines(result.settings, f),
                            benchmark::timeLines(f, contactTime(result.settings), c.together)})
    lines.insert(lines.end(), more.begin(), more.end());
  const Json steps{{"particles", report::numberOrNull(c.particles)},
                   {"solid", report::numberOrNull(c.solid)},
                   {"together", report::numberOrNull(c.together)}};
  lines.insert(lines.end(), {Line{"", c.particles, "critical step of the contacts", "%.4e s"},
                             Line{"", report::numberOrNull(c.solid), "  of the solid", "%.4e s"},
                             Line{"", c.together, "  of both, with the coupling", "%.4e s"},
                             Line{"critical_step_s", steps}, Line{"critical_step_set_by", criticalSetter(c), "set by"},
                             Line{"published_dissipated_fraction", publishedFraction(result.settings)}});
  return lines;
}

void printReport(std::ostream& out, const RunResult& result) {
  benchmark::printReport(out, "A pulse goes from particles into an elastic solid", describe(result.settings),
                         describe(Settings{}), linesOf(result), result.figures, result);
}

void printComparison(std::ostream& out, const RunResult& result, const std::vector<ReferenceCurve>& curves) {
  const auto name = [](int n, const std::optional<double>& width) {
    return format("n = %d, %s", n, width ? ("c = " + formatNumber(*width)).c_str() : "particles alone");
  };
  const auto row = [&](const std::string& who, double fraction, double difference) {
    out << format("  %-34s %19.4f", who.c_str(), std::abs(fraction) < 5e-5 ? 0.0 : fraction);
    out << (std::isfinite(difference) ? format(" %24.3e\n", difference) : std::string("\n"));
  };
  out << "Beside the authors' deposited curves (impulse)\n"
      << "  run                                 fraction dissipated  largest |E - E_ours| / E_0\n";
  for (const ReferenceCurve& curve : curves)
    row("authors, " + name(curve.particlesPerEdge, curve.cgWidth),
        dissipatedFraction(curve.energy, curve.particlesPerEdge),
        fits(curve, result.settings) ? largestDifference(curve, result.energy) : std::nan(""));
  const Settings& s = result.settings;
  row("this run, " + name(s.particlesPerEdge, s.fullDem ? std::nullopt : std::optional<double>(s.cgWidth)),
      result.figures.paperDissipatedFraction, std::nan(""));
}

}  // namespace dovetail::wave
