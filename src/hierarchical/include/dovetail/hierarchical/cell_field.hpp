// Cells of grains at the quadrature points of a solid (FEM × DEM). Nothing in it regularises a solid that softens.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dovetail/fem/laws/point_field.hpp"
#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/rve.hpp"

namespace dovetail::hierarchical {

/// ∂P/∂F of cells for Newton's method (rve/operators.hpp).
enum class Operator {
  elasticTangent,     ///< converges fast while little slips; about an answer's price of discs, of spheres 3 to 10 as
                      ///< compress() leaves them, and tens where sheared packings must be factorised
  frictionalTangent,  ///< the same for continued loading
  voigtTangent,       ///< stiffer, without solving: more iterations, each cheaper
  elasticProbe,       ///< a check of `elasticTangent`, many times its price
  numericalTangent,   ///< of the answers themselves: five more paths of discs, ten of spheres
  averagedTangent  ///< numericalTangent until the point softens, then the mean of those that it had at accepted steps
};

/// Statics: every answer is a path from the committed cell to F, then rest: by FIRE to path.rest.tolerance, from there
/// to `unbalanced`, if that is less, by Newton's method.
struct QuasiStaticCells {
  rve::PathOptions path{.rest = {.tolerance = 1e-6}};
  double unbalanced = 1e-6;  ///< at rest when Balance::unbalanced is no more than this, > 0
  Operator tangent = Operator::elasticTangent;
};

/// Explicit dynamics: cells are stepped along and never wait for rest, in place where the step is accepted for certain.
/// Their clock is their own: of a contact law without rates, only how far they are from rest depends on it.
struct DynamicCells {
  double strainPerStep = 3e-5;  ///< at most, of a step of the grains; > 0
  double damping = 0.1;         ///< as in rve::step, in [0, 1)
  double stepFraction = 0.8;    ///< of the cell's critical step, in (0, 1)
};

/// Number of the sample that a point begins as.
using Deal = std::function<std::size_t(const fem::PointPlace&)>;
/// element + point, of points without elements their number: neighbours differ.
std::size_t inTurn(const fem::PointPlace& place);

/// Points of a solid that own a cell each. Disc cells answer for F in the plane (plane strain: quad4, quad8), sphere
/// cells for any F. Without `deal`, a point begins as cell inTurn() modulo their number. The density is
/// the mean of the cells'. Each point is one task, longest first and serial inside: digits do not depend on the number
/// of threads. The tangent is not symmetric. A point that has no answer says why: the step is cut.
/// @param samples  cells of the same shape and springs, at rest and under pressure at F = 1
/// @throws InputError for no cells, one that is not of that kind, or a setting that is not valid
std::shared_ptr<fem::PointField> cellField(std::vector<rve::Rve> samples, const QuasiStaticCells& settings = {},
                                           Deal deal = {});

/// The same for explicit dynamics. The tangent, from which stable steps follow, is voigtTangent: an upper bound.
std::shared_ptr<fem::PointField> cellField(std::vector<rve::Rve> samples, const DynamicCells& settings, Deal deal = {});

/// Of the material that cells are, mean, kg/m³: the density of their field.
double meanDensity(const std::vector<rve::Rve>& samples);

/// Shows the cell of a point of such a field, in the order of open(), as it was committed last, while `visit` runs.
/// @return whether there is one: other fields have none
bool visitCell(const fem::PointField& field, std::size_t point, const std::function<void(const rve::Rve&)>& visit);

/// Whether a point of a field has a cell.
bool hasCell(const fem::PointField& field, std::size_t point);

/// In how many copies the cell of a point is, 0 where there is no cell. A committed cell whose faces have come near is
/// repeated (rve::repeat), as long as there are no more than mostCopies.
inline constexpr int mostCopies = 64;
int copiesAt(const fem::PointField& field, std::size_t point);

/// From the present deformation to F and to rest there, as points do in statics.
/// @throws InputError as rve::followPath, or if a setting is not valid; NumericalError if the cell does not come to
/// rest, or no grains touch there
void relax(rve::Rve& cell, const Eigen::Matrix3d& F, const QuasiStaticCells& settings);

/// From the present deformation to F along an rve::DeformationPath, in as many steps as strainPerStep requires, at
/// least one.
/// @throws InputError for F with det F ≤ 0 or, for discs, out of the plane, or if a setting is not valid;
///   NumericalError as rve::step, or if a million steps are not enough
void stepTo(rve::Rve& cell, const Eigen::Matrix3d& F, const DynamicCells& settings);

/// Why a cell is too small to be representative, empty if it is not: fewer than 100 grains, or thinner than 6 mean
/// diameters. Names of fields of such cells say so.
std::string whySmall(const rve::Rve& cell);

}  // namespace dovetail::hierarchical
