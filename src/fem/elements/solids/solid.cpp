#include "dovetail/fem/elements/solid.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/model/model.hpp"
#include "solid_base.hpp"

namespace dovetail::fem {

namespace {

/// Numbers of the elements asked for, ascending.
std::vector<int> chosenElements(const SolidMesh& mesh, const std::string& set) {
  if (!set.empty()) {
    const std::vector<int>& chosen = elementSet(mesh, set);
    if (chosen.empty())
      throw InputError("the element set \"" + set + "\" is empty", "elements", "name a set with elements");
    return chosen;
  }
  std::vector<int> all(mesh.elementCount());
  for (std::size_t e = 0; e < all.size(); ++e) all[e] = static_cast<int>(e);
  return all;
}

void fillBatches(std::span<const int> node, detail::SolidCells& cells) {
  const std::size_t n = cells.nodes;
  cells.batchNode.resize(cells.batches() * n);
  for (std::size_t b = 0; b < cells.batches(); ++b)
    for (std::size_t lane = 0; lane < detail::laneCount; ++lane) {
      const std::size_t e = detail::laneCount * b + std::min(lane, cells.inUse(b) - 1);
      for (std::size_t a = 0; a < n; ++a) cells.batchNode[b * n + a][lane] = node[n * e + a];
    }
}

void requireFraction(std::span<const double> fraction, std::size_t nodes) {
  if (fraction.empty()) return;
  if (fraction.size() != nodes)
    throw InputError(
        "there are " + std::to_string(fraction.size()) + " fractions for " + std::to_string(nodes) + " nodes",
        "elements", "give one per node, or none");
  for (std::size_t n = 0; n < nodes; ++n)
    if (!(fraction[n] >= 0.0 && fraction[n] <= 1.0))
      throw InputError("the fraction of node " + std::to_string(n) + " is " + formatNumber(fraction[n]), "elements",
                       "give numbers from 0 to 1");
}

/// @throws InputError if the elements are of several shapes
detail::SolidCells cellsOf(const SolidMesh& mesh, const std::string& set, std::span<const double> fraction) {
  detail::SolidCells cells{};
  cells.X = mesh.X;
  cells.thickness = mesh.thickness;
  cells.fraction.assign(fraction.begin(), fraction.end());
  std::vector<int> node;
  const std::vector<int> chosen = chosenElements(mesh, set);
  std::size_t next = 0;
  int first = 0;
  for (const ElementGroup& group : mesh.groups) {
    const int last = first + static_cast<int>(group.size());
    for (; next < chosen.size() && chosen[next] < last; ++next) {
      if (!cells.number.empty() && cells.shape != group.shape)
        throw InputError(
            std::string("the elements are of several shapes, ") + name(cells.shape) + " and " + name(group.shape),
            "elements", "make one solid of each shape");
      cells.shape = group.shape;
      cells.nodes = static_cast<std::size_t>(nodesOf(group.shape));
      const auto start = group.node.begin() + static_cast<std::ptrdiff_t>(cells.nodes) * (chosen[next] - first);
      const std::span<const int> own(start, cells.nodes);
      if (!fraction.empty() &&
          std::ranges::all_of(own, [&](int n) { return fraction[static_cast<std::size_t>(n)] == 0.0; }))
        continue;
      node.insert(node.end(), own.begin(), own.end());
      cells.number.push_back(chosen[next]);
    }
    first = last;
  }
  if (cells.number.empty())
    throw InputError("every element has the fraction 0", "elements",
                     "leave the solid out, or give some nodes a fraction");
  fillBatches(node, cells);
  return cells;
}

/// The formulations that ask their points once for a state.
bool asksOnce(Formulation formulation) {
  return formulation == Formulation::standard || formulation == Formulation::meanDilatation ||
         formulation == Formulation::reduced;
}

std::shared_ptr<Solid> makeSolidOf(const SolidMesh& mesh, std::unique_ptr<detail::SolidPoints> points,
                                   const SolidOptions& options) {
  validate(mesh);
  requireFraction(options.fraction, mesh.X.size());
  detail::SolidCells cells = cellsOf(mesh, options.elementSet, options.fraction);
  const bool anyShape =
      options.formulation == Formulation::standard || options.formulation == Formulation::meanDilatation;
  const bool reducedPlane = options.formulation == Formulation::reduced && cells.shape == ElementShape::quad8;
  if (!anyShape && !reducedPlane && cells.shape != ElementShape::hex8)
    throw InputError(std::string("the formulation \"") + name(options.formulation) + "\" is for hex8" +
                         (options.formulation == Formulation::reduced ? " and quad8" : "") + ", not for " +
                         name(cells.shape),
                     "elements", "take the standard formulation, or a mesh of hex8");
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

}  // namespace

const char* name(Formulation formulation) {
  constexpr std::array names = {"standard", "mean dilatation", "enhanced", "assumed stress", "reduced"};
  return names[static_cast<std::size_t>(formulation)];
}

std::shared_ptr<Solid> makeSolid(const SolidMesh& mesh, std::shared_ptr<const PointMaterial> material,
                                 const SolidOptions& options) {
  return makeSolidOf(mesh, detail::pointsOf(std::move(material)), options);
}

std::shared_ptr<Solid> makeSolid(const SolidMesh& mesh, std::shared_ptr<PointField> field,
                                 const SolidOptions& options) {
  if (!asksOnce(options.formulation))
    throw InputError(std::string("the formulation \"") + name(options.formulation) +
                         "\" evaluates points repeatedly, or needs a law, not a field",
                     "elements", "take the formulation standard, mean dilatation or reduced");
  return makeSolidOf(mesh, detail::pointsOf(std::move(field)), options);
}

}  // namespace dovetail::fem
