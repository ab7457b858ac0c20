#include "dovetail/fem/elements/solid.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "solid_base.hpp"

namespace dovetail::fem {

namespace {

/// Numbers of the elements asked for, ascending.
std::vector<int> chosenElements(const SolidMesh& mesh, const std::string& set) {
  if (!set.empty()) {
    const std::vector<int>& chosen = elementSet(mesh, set);
    if (chosen.empty())
      throw InputError("the element set \"" + set + "\" is empty", "makeSolid", "name a set with elements");
    return chosen;
  }
  std::vector<int> all(mesh.elementCount());
  for (std::size_t e = 0; e < all.size(); ++e) all[e] = static_cast<int>(e);
  return all;
}

void fillBatches(detail::SolidCells& cells) {
  const std::size_t n = cells.nodes;
  cells.batchNode.resize(cells.batches() * n);
  for (std::size_t b = 0; b < cells.batches(); ++b)
    for (std::size_t lane = 0; lane < detail::laneCount; ++lane) {
      const std::size_t e = detail::laneCount * b + std::min(lane, cells.inUse(b) - 1);
      for (std::size_t a = 0; a < n; ++a) cells.batchNode[b * n + a][lane] = cells.node[n * e + a];
    }
}

/// @throws InputError if the elements are of several shapes
detail::SolidCells cellsOf(const SolidMesh& mesh, const std::string& set) {
  detail::SolidCells cells{};
  cells.X = mesh.X;
  const std::vector<int> chosen = chosenElements(mesh, set);
  std::size_t next = 0;
  int first = 0;
  for (const CellGroup& group : mesh.groups) {
    const int last = first + static_cast<int>(group.size());
    for (; next < chosen.size() && chosen[next] < last; ++next) {
      if (!cells.number.empty() && cells.shape != group.shape)
        throw InputError(
            std::string("the elements are of several shapes, ") + name(cells.shape) + " and " + name(group.shape),
            "makeSolid", "make one solid per shape, each from an element set");
      cells.shape = group.shape;
      cells.nodes = static_cast<std::size_t>(nodesOf(group.shape));
      const auto start = group.node.begin() + static_cast<std::ptrdiff_t>(cells.nodes) * (chosen[next] - first);
      cells.node.insert(cells.node.end(), start, start + static_cast<std::ptrdiff_t>(cells.nodes));
      cells.number.push_back(chosen[next]);
    }
    first = last;
  }
  fillBatches(cells);
  return cells;
}

}  // namespace

const char* name(Formulation formulation) {
  constexpr std::array names = {"standard", "mean dilatation", "enhanced", "assumed stress", "reduced"};
  return names[static_cast<std::size_t>(formulation)];
}

std::shared_ptr<Solid> makeSolid(const SolidMesh& mesh, std::shared_ptr<const PointMaterial> material,
                                 const SolidOptions& options) {
  if (material == nullptr) throw InputError("there is no material", "makeSolid", "give one, for instance neoHookean()");
  validate(mesh);
  detail::SolidCells cells = cellsOf(mesh, options.elementSet);
  if (options.formulation != Formulation::standard && options.formulation != Formulation::meanDilatation &&
      cells.shape != CellShape::hex8)
    throw InputError(
        std::string("the formulation \"") + name(options.formulation) + "\" is for hex8, not for " + name(cells.shape),
        "makeSolid", "use Formulation::standard, or a mesh of hex8");
  switch (options.formulation) {
    case Formulation::meanDilatation:
      return detail::makeMeanDilatationSolid(std::move(cells), std::move(material), options);
    case Formulation::enhanced:
      return detail::makeEnhancedSolid(std::move(cells), std::move(material), options);
    case Formulation::assumedStress:
      return detail::makeAssumedStressSolid(std::move(cells), std::move(material), options);
    case Formulation::reduced:
      requireNonNegative(options.hourglassShare, "hourglassShare");
      return detail::makeReducedSolid(std::move(cells), std::move(material), options);
    default:
      return detail::makeStandardSolid(std::move(cells), std::move(material), options);
  }
}

}  // namespace dovetail::fem
