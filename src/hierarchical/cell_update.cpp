// How cells come to F.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/hierarchical/cell_field.hpp"

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
  const double steps = std::max(1.0, std::ceil(strain / settings.strainPerStep));
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
  if (!F.allFinite() || !(F.determinant() > 0.0))
    throw InputError("the determinant of F is " + formatNumber(F.determinant()), where,
                     "give an F that is finite and turns nothing inside out");
  const Eigen::Matrix3d start = cell.state.F, way = F - start;
  const Eigen::Matrix3d G = rve::relativeDeformation(cell, F) - Eigen::Matrix3d::Identity();
  const int steps = stepsFor(0.5 * (G + G.transpose()).norm(), settings);
  for (int k = 1; k <= steps; ++k) {
    const Eigen::Matrix3d next = k == steps ? F : Eigen::Matrix3d(start + way * (double(k) / steps));
    rve::step(cell, settings.stepFraction * cell.state.criticalStep, rve::relativeDeformation(cell, next),
              settings.damping);
  }
}

}  // namespace dovetail::hierarchical
