#include "report.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "common/text.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/provenance.hpp"

namespace dovetail::wave {

using benchmark::format;

namespace {

void printChanged(std::ostream& out, const Settings& s) {
  out << "  changed    ";
  const auto standard = describe(Settings{});
  bool any = false;
  for (const auto& row : describe(s)) {
    if (std::find(standard.begin(), standard.end(), row) != standard.end()) continue;
    out << (any ? ", " : "") << row.first << ' ' << row.second;
    any = true;
  }
  out << (any ? "" : "nothing: all settings as they come") << '\n';
}

std::string signalText(const Settings& s) {
  if (s.signal == Signal::impulse)
    return format("impulse of %g m/s on the first layer", s.amplitude * Case{}.velocity * s.particlesPerEdge);
  return format("raised cosine, %d of %.4g elements (omega = %.4g rad/ms), up to %g m/s", s.cycles, s.pulseElements,
                1e-3 * angularFrequency(s), 2.0 * s.amplitude * Case{}.cosineVelocity);
}

void printCase(std::ostream& out, const RunResult& result) {
  const Settings& s = result.settings;
  const RunFigures& f = result.figures;
  const auto build = io::buildInfo();
  out << "A pulse goes from particles into an elastic solid\n"
      << "  " << build.version << " (" << build.commit.substr(0, 12) << "), " << build.compiler << ", "
      << io::processorName() << '\n'
      << format("  bar        %g x %g x %g m, %d^3 particles per element\n", barLength(s), Case{}.side, Case{}.side,
                s.particlesPerEdge);
  if (s.fullDem)
    out << format("  models     %zu particles alone\n", f.particles);
  else
    out << format("  models     %zu particles over %g m, %zu bricks over %g m\n", f.particles, s.demLength, f.elements,
                  solidElements(s) * Case{}.elementSize)
        << format("  overlap    %g m: %zu particles, %zu rows of the coupling\n", s.overlap, f.overlapParticles,
                  f.coupledNodes);
  out << "  signal     " << signalText(s) << '\n';
  printChanged(out, s);
}

void printErrors(std::ostream& out, const RunFigures& f) {
  if (!f.compared) return;
  out << "Beside particles alone, at the end\n"
      << format("  waveform error, solid past the overlap     %.3e of the wave there\n", f.waveformErrorFem)
      << format("  waveform error, particles before it        %.3e of the whole wave\n", f.waveformErrorDem)
      << format("  reflected energy                           %.3e of the input\n", f.reflectedShare)
      << format("  run time over that of particles alone      %.3g\n", f.speedRatio);
}

void printEnergy(std::ostream& out, const RunResult& result) {
  const RunFigures& f = result.figures;
  out << "Energy\n"
      << format("  put in                                     %.6g J\n", f.energyInput)
      << format("  left at the end                            %.6g J\n", f.energyFinal)
      << format("  lost, not absorbed on purpose              %.3e of the input\n", f.lostShare);
  if (!result.settings.fullDem)
    out << format("  lost (-) or made (+) by the coupling       %.3e\n", f.couplingWorkShare);
  if (result.settings.absorber > 0.0)
    out << format("  absorbed                                   %.3e\n", f.absorbedShare);
  if (std::isfinite(f.paperDissipatedShare))
    out << format("  dissipated as the authors count it         %.4f\n", f.paperDissipatedShare);
  out << format("  ledger residual, largest                   %.3e, every booked channel counted\n", f.ledgerResidual)
      << "Balance\n"
      << format("  momentum residual                          %.3e of the largest momentum\n", f.momentumResidual)
      << format("  mass residual                              %.3e of the bar's mass\n", f.massResidual);
  if (!result.settings.fullDem)
    out << format("  speeds of the models in the overlap differ %.3e (rms) of the speed there\n", f.overlapMismatch)
        << format("  largest gap                                %.3e m\n", f.gapMax);
  out << "Ledger at the end\n" << result.ledger;
}

void printTime(std::ostream& out, const RunResult& result) {
  const RunFigures& f = result.figures;
  const double steps = static_cast<double>(f.steps);
  out << "Time\n"
      << format("  %.0f steps in %.3f s, %.2f us per step\n", steps, f.wallSeconds, 1e6 * f.wallSeconds / steps)
      << format("  dt %.4e s = %.4g t_c, %.1f %% of the critical step %.4e s\n", f.dt,
                f.dt / contactTime(result.settings), 100.0 * f.dt / f.critical.together, f.critical.together)
      << format("  critical step: contacts %.4e s", f.critical.particles);
  if (!result.settings.fullDem)
    out << format(", solid %.4e s, with the coupling %.4e s", f.critical.solid, f.critical.together);
  out << "; set by " << criticalSetter(f.critical) << '\n';
  if (!result.profile.rows().empty()) out << result.profile;
}

}  // namespace

std::string criticalSetter(const arlequin::CriticalStep& c) {
  const double apart = std::min(c.particles, c.solid);
  if (c.together < 0.98 * apart) return "the coupling";
  return c.particles <= c.solid ? "the contacts" : "the bricks of the solid";
}

void printReport(std::ostream& out, const RunResult& result) {
  printCase(out, result);
  printErrors(out, result.figures);
  printEnergy(out, result);
  printTime(out, result);
  if (!result.figures.failure.empty())
    out << "The run broke down: " << result.figures.failure << '\n';
  else if (!result.figures.stable)
    out << format("Not stable: kinetic + elastic energy reached %.3g times what was put in\n",
                  result.figures.largestExcess);
}

void printComparison(std::ostream& out, const RunResult& result, const std::vector<ReferenceCurve>& curves) {
  const auto name = [](int n, const std::optional<double>& width) {
    return format("n = %d, %s", n, width ? ("c = " + formatNumber(*width)).c_str() : "particles alone");
  };
  const auto row = [&](const std::string& who, double share, double difference) {
    out << format("  %-34s %19.4f", who.c_str(), std::abs(share) < 5e-5 ? 0.0 : share);
    out << (std::isfinite(difference) ? format(" %24.3e\n", difference) : std::string("\n"));
  };
  out << "Beside the authors' deposited curves (impulse)\n"
      << "  run                                 share dissipated  largest |E - E_ours| / E_0\n";
  for (const ReferenceCurve& curve : curves)
    row("authors, " + name(curve.particlesPerEdge, curve.cgWidth),
        dissipatedShare(curve.energy, curve.particlesPerEdge),
        fits(curve, result.settings) ? largestDifference(curve, result.energy) : std::nan(""));
  const Settings& s = result.settings;
  row("this run, " + name(s.particlesPerEdge, s.fullDem ? std::nullopt : std::optional<double>(s.cgWidth)),
      result.figures.paperDissipatedShare, std::nan(""));
}

}  // namespace dovetail::wave
