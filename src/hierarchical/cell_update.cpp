// How cells come to F.
#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/hierarchical/cell_field.hpp"
#include "dovetail/rve/deformation_path.hpp"

namespace dovetail::hierarchical {

namespace {

constexpr const char* where = "cell of grains";

void validate(const QuasiStaticCells& settings) {
  requirePositive(settings.unbalanced, "unbalanced fraction of forces");
  if (settings.path.rest.steps < 1)
    throw InputError("cells get no steps to come to rest", where, "give path.rest.steps, or DynamicCells");
}

void validate(const DynamicCells& settings) {
  requirePositive(settings.strainPerStep, "strain of a step");
  requireFraction(settings.damping, "damping", where, true);
  requireFraction(settings.stepFraction, "the fraction of the critical step", where);
}

/// @throws NumericalError if there are more than a run could want
int stepsFor(double strain, const DynamicCells& settings) {
  const double steps = std::max(1.0, std::ceil(strain / settings.strainPerStep * (1.0 - 1e-12)));
  if (!(steps <= 1e6))
    throw NumericalError("F is a strain of " + formatNumber(strain) + " away, which takes " + formatNumber(steps) +
                             " steps of the grains",
                         where, "take shorter steps of the solid, or a larger strainPerStep");
  return static_cast<int>(steps);
}

}  // namespace

void relax(rve::Rve& cell, const Eigen::Matrix3d& F, const QuasiStaticCells& settings) {
  validate(settings);
  RestReport rest = rve::followPath(cell, F, settings.path).rest;
  if (rest.atRest && rest.residual > settings.unbalanced) rest = rve::polish(cell, settings.unbalanced);
  if (!rest.atRest) {  // contacts began or ended to touch or slip, or the first rest was not enough
    rest = rve::relax(cell, {settings.unbalanced, settings.path.rest.steps});
  }
  if (!rest.atRest)
    throw NumericalError(
        "forces on grains are out of balance by " + formatNumber(rest.residual) + " of the mean contact force", where,
        "take a smaller step or more steps to rest; past the peak, go on by explicit dynamics");
  if (rve::balance(cell).contacts == 0)
    throw NumericalError("no grains touch", where, "keep it under pressure: there is no cohesion");
}

void stepTo(rve::Rve& cell, const Eigen::Matrix3d& F, const DynamicCells& settings) {
  validate(settings);
  const rve::DeformationPath path(cell, F);
  const int steps = stepsFor(path.strain(), settings);
  for (int k = 1; k <= steps; ++k)
    rve::step(cell, settings.stepFraction * cell.state.criticalStep,
              rve::relativeDeformation(cell, path.at(double(k) / steps)), settings.damping);
}

}  // namespace dovetail::hierarchical
