#include "report.hpp"

#include <algorithm>
#include <ostream>

#include "common/text.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/provenance.hpp"
#include "model.hpp"
#include "published.hpp"

namespace dovetail::cantilever {

using benchmark::format;

namespace {

void printCase(std::ostream& out, const RunResult& result) {
  const Settings& s = result.settings;
  const auto counts = elementCounts(s);
  const auto build = io::buildInfo();
  out << "Two particles slide over an elastic cantilever\n"
      << "  " << build.version << " (" << build.commit.substr(0, 12) << "), " << build.compiler << ", "
      << io::processorName() << '\n'
      << "  beam       " << counts[0] << " x " << counts[1] << " x " << counts[2] << ' ' << s.element << '\n'
      << "  changed    ";
  Settings asItComes;
  asItComes.dtCapped = true;
  const auto standard = describe(asItComes);
  bool any = false;
  for (const auto& row : describe(s))
    if (std::find(standard.begin(), standard.end(), row) == standard.end()) {
      out << (any ? ", " : "") << row.first << ' ' << row.second;
      any = true;
    }
  out << (any ? "" : "nothing: all settings as they come") << '\n';
}

void printErrors(std::ostream& out, const RunFigures& f, bool besideBeam) {
  const auto line = [&](const char* what, double metres) { out << format("  %-66s %9.3f mm\n", what, 1e3 * metres); };
  out << "Error: time mean until leaving of the root of the summed squares of dx and dz of both particles\n";
  line("static Euler-Bernoulli, arm from the clamp", f.errorStatic);
  line("  dz alone", f.errorStaticVertical);
  line("static Euler-Bernoulli, arm from the start point (as the authors)", f.errorStaticAuthors);
  if (!besideBeam) {
    out << "  moving-mass Timoshenko beam: not compared, the run ends before leaving\n";
    return;
  }
  line("moving-mass Timoshenko beam, at the particle's own y", f.errorDynamic);
  line("moving-mass Timoshenko beam, at the same time", f.errorDynamicSameTime);
  if (f.lockingFactor == 1.0) return;
  line(format("  the same with EI x %.4f (locked brick), own y", f.lockingFactor).c_str(), f.errorDynamicLocked);
  line(format("  the same with EI x %.4f (locked brick), same time", f.lockingFactor).c_str(),
       f.errorDynamicLockedSameTime);
}

void printMotion(std::ostream& out, const RunFigures& f) {
  if (f.left)
    out << format("  particle 1 leaves at   %.4f s (moving-mass beam %.4f s)\n", f.leaveTime, f.referenceLeaveTime);
  else
    out << format("  not left by            %.4f s\n", f.endTime);
  out << format("  lateral drift          %.3g m\n", f.lateralDrift)
      << format("  without contact        %.3g %% of the time\n", 100.0 * f.noContactShare);
}

void printEnergy(std::ostream& out, const RunResult& result) {
  const RunFigures& f = result.figures;
  out << "Energy, until leaving\n"
      << format("  total at the start     %.6f J, least %.6f, largest %.6f\n", f.energyInitial, f.energyMin,
                f.energyMax)
      << format("  drift                  %.3e of the start\n", f.energyDrift)
      << format("  ledger residual        %.3e of the start, every booked channel counted\n", f.ledgerResidual)
      << format("  force, moment residual %.3e, %.3e of the contact force (x 12 m)\n", f.forceResidual,
                f.momentResidual)
      << "Ledger at the end\n"
      << result.ledger;
}

void printTime(std::ostream& out, const RunResult& result) {
  const RunFigures& f = result.figures;
  const double steps = static_cast<double>(f.steps);
  out << "Time\n"
      << format("  %.0f steps in %.3f s, %.2f us per step", steps, f.wallSeconds, 1e6 * f.wallSeconds / steps)
      << format(" (authors' code: about %.0f us)\n", 1e6 * publishedSecondsPerStep)
      << format("  dt %.4e s = %.4f t_c, %.1f %% of the critical step %.4e s\n", f.dt, f.dt / contactTime(Case{}),
                100.0 * f.dt / f.criticalDt, f.criticalDt)
      << "  the critical step is set by " << f.criticalSetter << '\n'
      << result.profile;
}

}  // namespace

void printReport(std::ostream& out, const RunResult& result) {
  printCase(out, result);
  printMotion(out, result.figures);
  printErrors(out, result.figures, comparesWithBeam(result));
  printEnergy(out, result);
  printTime(out, result);
  if (!result.figures.failure.empty())
    out << "The run broke down: " << result.figures.failure << '\n';
  else if (!result.figures.stable)
    out << format("Not stable: kinetic + elastic energy reached %.3g times what was available\n",
                  result.figures.largestExcess);
}

void printComparison(std::ostream& out, const RunResult& result, const std::vector<ReferenceCurve>& curves) {
  const RunFigures& f = result.figures;
  out << "Beside the authors' deposited curves (until leaving)\n"
      << "  run               leaves (s)  largest E (J)  error, true arm (mm)  authors' arm (mm)  no contact\n";
  const auto row = [&](const std::string& name, double leave, double energy, double error, double authors,
                       double share) {
    out << format("  %-16s %11.3f %14.4f %21.3f %18.3f %9.1f %%\n", name.c_str(), leave, energy, 1e3 * error,
                  1e3 * authors, 100.0 * share);
  };
  for (const ReferenceCurve& curve : curves) {
    const CurveFigures c = figuresOf(curve);
    row("authors, " + formatNumber(curve.cgWidth) + " d", c.leaveTime, c.largestEnergy, c.errorTrueArm,
        c.errorAuthorsArm, c.noContactShare);
  }
  row("this run, " + formatNumber(result.settings.cgWidth) + " d", f.leaveTime, f.energyMax, f.errorStatic,
      f.errorStaticAuthors, f.noContactShare);
}

}  // namespace dovetail::cantilever
