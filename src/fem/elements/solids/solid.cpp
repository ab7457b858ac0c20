#include "dovetail/fem/elements/solid.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/team.hpp"
#include "dovetail/fem/model/model.hpp"
#include "solid_base.hpp"
#include "solid_on_ranks.hpp"

namespace dovetail::fem {

namespace {

/// The formulations that ask their points once for a state.
bool asksOnce(Formulation formulation) {
  return formulation == Formulation::standard || formulation == Formulation::meanDilatation ||
         formulation == Formulation::reduced;
}

std::shared_ptr<Solid> makeSolidOf(detail::SolidCells cells, std::unique_ptr<detail::SolidPoints> points,
                                   const SolidOptions& options) {
  const bool reducedPlane = options.formulation == Formulation::reduced && cells.shape == ElementShape::quad8;
  switch (options.formulation) {
    case Formulation::meanDilatation:
      return detail::makeMeanDilatationSolid(std::move(cells), std::move(points), options);
    case Formulation::enhanced:
      return detail::makeEnhancedSolid(std::move(cells), std::move(points), options);
    case Formulation::assumedStress:
      return detail::makeAssumedStressSolid(std::move(cells), std::move(points), options);
    case Formulation::reduced:
      if (reducedPlane) return detail::makeStandardSolid(std::move(cells), std::move(points), options);
      requireNonNegative(options.hourglassFraction, "hourglassFraction");
      return detail::makeReducedSolid(std::move(cells), std::move(points), options);
    default:
      return detail::makeStandardSolid(std::move(cells), std::move(points), options);
  }
}

/// @throws InputError as makeSolid()
detail::SolidCells cellsFor(const SolidMesh& mesh, const SolidOptions& options) {
  validate(mesh);
  detail::requireFraction(options.fraction, mesh.X.size());
  detail::SolidCells cells = detail::cellsOf(mesh, options.elementSet, options.fraction);
  const bool anyShape =
      options.formulation == Formulation::standard || options.formulation == Formulation::meanDilatation;
  const bool reducedPlane = options.formulation == Formulation::reduced && cells.shape == ElementShape::quad8;
  if (!anyShape && !reducedPlane && cells.shape != ElementShape::hex8)
    throw InputError(std::string("the formulation \"") + name(options.formulation) + "\" is for hex8" +
                         (options.formulation == Formulation::reduced ? " and quad8" : "") + ", not for " +
                         name(cells.shape),
                     "elements", "take the standard formulation, or a mesh of hex8");
  return cells;
}

}  // namespace

const char* name(Formulation formulation) {
  constexpr std::array names = {"standard", "mean dilatation", "enhanced", "assumed stress", "reduced"};
  return names[static_cast<std::size_t>(formulation)];
}

std::shared_ptr<Solid> makeSolid(const SolidMesh& mesh, std::shared_ptr<const PointMaterial> material,
                                 const SolidOptions& options) {
  detail::SolidCells cells = cellsFor(mesh, options);
  if (!options.onRanks || team().size() == 1)
    return makeSolidOf(std::move(cells), detail::pointsOf(std::move(material)), options);
  const std::optional<std::vector<std::vector<int>>> numbers = detail::keepShare(cells);
  std::shared_ptr<Solid> own = makeSolidOf(std::move(cells), detail::pointsOf(std::move(material)), options);
  return numbers ? detail::solidOnRanks(own, *numbers) : own;
}

std::shared_ptr<Solid> makeSolid(const SolidMesh& mesh, std::shared_ptr<PointField> field,
                                 const SolidOptions& options) {
  if (!asksOnce(options.formulation))
    throw InputError(std::string("the formulation \"") + name(options.formulation) +
                         "\" evaluates points repeatedly, or needs a law, not a field",
                     "elements", "take the formulation standard, mean dilatation or reduced");
  return makeSolidOf(cellsFor(mesh, options), detail::pointsOf(std::move(field)), options);
}

}  // namespace dovetail::fem
