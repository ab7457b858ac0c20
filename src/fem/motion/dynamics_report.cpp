#include <iomanip>
#include <ostream>

#include "dovetail/core/finite.hpp"
#include "dovetail/fem/motion/dynamics.hpp"

namespace dovetail::fem {

std::ostream& operator<<(std::ostream& out, const DynamicsReport& report) {
  const auto row = [&](const char* what, const std::string& value) {
    out << "  " << std::left << std::setw(24) << what << value << '\n';
  };
  row("scheme", report.scheme);
  row("mass", report.massFraction == 0.0   ? "lumped"
              : report.massFraction == 1.0 ? "consistent"
                                           : "consistent by " + formatNumber(report.massFraction));
  row("time reached", formatNumber(report.t) + " s");
  row("step", formatNumber(report.dt) + " s");
  if (report.stepRange.shortest > 0.0) {
    const StepRange& range = report.stepRange;
    row("longest step", formatNumber(range.longest) + " s");
    row("shortest step",
        formatNumber(range.shortest) + " s, element " + std::to_string(range.element) + " of \"" + range.solid + "\"");
  }
  if (report.criticalStep > 0.0) row("over the critical step", formatNumber(report.dt / report.criticalStep));
  row("steps", std::to_string(report.steps));
  if (report.iterations > 0) {
    row("cut steps", std::to_string(report.cuts));
    row("iterations", std::to_string(report.iterations));
    row("factorisations", std::to_string(report.factorisations) + " by " + report.solver);
    row("residual / tolerance", formatNumber(report.largestResidual));
  }
  for (const std::string& term : report.atMeanState) row("energy not kept by", term);
  return out << report.ledger << report.profile;
}

}  // namespace dovetail::fem
