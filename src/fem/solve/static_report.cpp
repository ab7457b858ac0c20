#include <iomanip>
#include <ostream>

#include "dovetail/core/finite.hpp"
#include "dovetail/fem/solve/statics.hpp"

namespace dovetail::fem {

std::ostream& operator<<(std::ostream& out, const StaticReport& report) {
  const auto row = [&](const char* what, const std::string& value) {
    out << "  " << std::left << std::setw(24) << what << value << '\n';
  };
  const auto joules = [&](const char* what, double value) { row(what, formatNumber(value) + " J"); };
  row("time reached", report.steps.empty() ? "none" : formatNumber(report.steps.back().t) + " s");
  row("steps", std::to_string(report.steps.size()) + ", " + std::to_string(report.cuts) + " cut");
  row("iterations", std::to_string(report.iterations));
  row("factorisations",
      std::to_string(report.factorisations) + " by " + report.solver +
          (report.linearIterations > 0 ? ", " + std::to_string(report.linearIterations) + " iterations" : ""));
  joules("stored before", report.storedBefore);
  joules("stored after", report.storedAfter);
  joules("work of loads", report.loadWork);
  joules("work of supports", report.supportWork);
  joules("dissipated", report.dissipated);
  if (report.motions > 0) {
    row("moved to rest",
        std::to_string(report.motions) + " steps, " + std::to_string(report.motionIterations) + " iterations");
    joules("damped", report.damped);
    joules("kinetic, largest", report.largestKinetic);
  }
  joules("residual", report.energyResidual());
  row("assembly", formatNumber(report.assemblySeconds) + " s");
  row("linear solver", formatNumber(report.solverSeconds) + " s");
  row("in all", formatNumber(report.seconds) + " s");
  return out;
}

}  // namespace dovetail::fem
