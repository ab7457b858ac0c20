// How cells come to F.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/hierarchical/cell_field.hpp"

namespace dovetail::hierarchical {

void settle(rve::Cell& cell, const Eigen::Matrix3d& F, const RestingCells& settings) {
  rve::RestReport rest = rve::followPath(cell, F, settings.path).rest;
  if (rest.atRest && rest.unbalanced > settings.unbalanced) rest = rve::polish(cell, settings.unbalanced);
  if (!rest.atRest) {  // contacts began or ended to touch or slip, or the first rest was not enough
    rve::RestSettings further = settings.path.rest;
    further.unbalanced = settings.unbalanced;
    rest = rve::relax(cell, further);
  }
  if (!rest.atRest)
    throw NumericalError(
        "forces on grains are out of balance by " + formatNumber(rest.unbalanced) + " of the mean contact force",
        "cell of grains", "take a smaller step or more steps to rest; past the peak, go on by explicit dynamics");
  if (rve::balance(cell).contacts == 0)
    throw NumericalError("no grains touch", "cell of grains", "keep it under pressure: there is no cohesion");
}

void stepTo(rve::Cell& cell, const Eigen::Matrix3d& F, const MovingCells& settings) {
  if (!F.allFinite() || !(F.determinant() > 0.0))
    throw InputError("the determinant of F is " + formatNumber(F.determinant()), "cell of grains",
                     "give an F that is finite and turns nothing inside out");
  const Eigen::Matrix3d start = cell.state.F, way = F - start;
  const Eigen::Matrix3d G = rve::relativeDeformation(cell, F) - Eigen::Matrix3d::Identity();
  const int steps =
      static_cast<int>(std::max(1.0, std::ceil(0.5 * (G + G.transpose()).norm() / settings.strainPerStep)));
  for (int k = 1; k <= steps; ++k) {
    const Eigen::Matrix3d next = k == steps ? F : Eigen::Matrix3d(start + way * (double(k) / steps));
    rve::step(cell, settings.stepShare * cell.state.criticalStep, rve::relativeDeformation(cell, next),
              settings.damping);
  }
}

}  // namespace dovetail::hierarchical
