#include <algorithm>
#include <cmath>
#include <limits>

#include "cell_jacobian.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "shapes.hpp"

namespace dovetail::fem {

namespace detail {

const std::vector<Vec3>& nodalGradients(ElementShape shape) {
  static const auto all = [] {
    std::array<std::vector<Vec3>, allCellShapes.size()> gradients;
    for (std::size_t s = 0; s < gradients.size(); ++s) {
      const auto each = static_cast<ElementShape>(s);
      const auto n = static_cast<std::size_t>(nodesOf(each));
      gradients[s].resize(n * n);
      std::vector<double> value(n);
      for (std::size_t b = 0; b < n; ++b)
        shapeFunctions(each, parentNodes(each)[b], value, std::span(gradients[s]).subspan(n * b, n));
    }
    return gradients;
  }();
  return all[static_cast<std::size_t>(shape)];
}

std::string listed(const char* item, std::span<const int> numbers) {
  constexpr std::size_t most = 10;
  if (numbers.size() == 1) return std::string(item) + " " + std::to_string(numbers[0]);
  std::string text = std::string(item) + "s ";
  for (std::size_t k = 0; k < std::min(most, numbers.size()); ++k)
    text += (k == 0 ? "" : ", ") + std::to_string(numbers[k]);
  return numbers.size() > most ? text + " and " + std::to_string(numbers.size() - most) + " more" : text;
}

}  // namespace detail

namespace {

/// Least det ∂X/∂ξ at the nodes and quadrature points.
double leastDeterminant(ElementShape shape, std::span<const int> nodes, const SolidMesh& mesh) {
  const Vec3 depth = detail::depthOf(shape, mesh.thickness);
  const std::size_t n = nodes.size();
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<Vec3>* gradients : {&detail::nodalGradients(shape), &detail::forceRule(shape).gradient})
    for (std::size_t at = 0; at < gradients->size(); at += n) {
      const double det =
          detail::determinant(detail::jacobianAt(mesh.X, nodes, std::span(*gradients).subspan(at, n), depth));
      if (!std::isfinite(det)) return std::numeric_limits<double>::quiet_NaN();
      least = std::min(least, det);
    }
  return least;
}

void requireNodes(std::span<const int> nodes, std::size_t count, const std::string& where) {
  for (const int node : nodes)
    if (node < 0 || static_cast<std::size_t>(node) >= count)
      throw InputError("node " + std::to_string(node) + " does not exist", where,
                       "use 0 to " + std::to_string(count - 1));
}

void requireAscending(std::span<const int> numbers, const std::string& where) {
  const auto at = std::adjacent_find(numbers.begin(), numbers.end(), [](int a, int b) { return a >= b; });
  if (at != numbers.end())
    throw InputError(std::to_string(at[1]) + " follows " + std::to_string(at[0]), where,
                     "sort the numbers and name each once");
}

void requireDistinctNodes(std::span<const int> nodes, const std::string& where) {
  std::array<int, 27> sorted{};
  const auto end = std::copy(nodes.begin(), nodes.end(), sorted.begin());
  std::sort(sorted.begin(), end);
  const auto twice = std::adjacent_find(sorted.begin(), end);
  if (twice != end)
    throw InputError("node " + std::to_string(*twice) + " occurs twice in it", where, "give each of its nodes once");
}

void requireSets(const SolidMesh& mesh) {
  const std::size_t elements = mesh.elementCount();
  for (const auto& [set, nodes] : mesh.nodeSets) {
    requireNodes(nodes, mesh.X.size(), "node set \"" + set + "\"");
    requireAscending(nodes, "node set \"" + set + "\"");
  }
  for (const auto& [set, faces] : mesh.faceSets)
    for (const Face& face : faces)
      requireNodes(std::span(face.node).first(static_cast<std::size_t>(nodesOf(face.shape))), mesh.X.size(),
                   "face set \"" + set + "\"");
  for (const auto& [set, numbers] : mesh.elementSets) {
    for (const int e : numbers)
      if (e < 0 || static_cast<std::size_t>(e) >= elements)
        throw InputError("element " + std::to_string(e) + " does not exist", "element set \"" + set + "\"",
                         "use 0 to " + std::to_string(elements - 1));
    requireAscending(numbers, "element set \"" + set + "\"");
  }
}

void requireOneDimension(const SolidMesh& mesh) {
  const int dimension = dimensionOf(mesh);
  for (const ElementGroup& group : mesh.groups)
    if (dimensionOf(group.shape) != dimension)
      throw InputError(std::string("the mesh has ") + name(mesh.groups[0].shape) + " and " + name(group.shape) +
                           " elements, of plane strain and of three dimensions",
                       "mesh", "make two meshes and two models");
  if (dimension == 3 && mesh.thickness != 1.0)
    throw InputError("the thickness is " + formatNumber(mesh.thickness) + " m", "mesh of three dimensions",
                     "leave it at 1: it is for quad4 and quad8");
  if (dimension == 3) return;
  requirePositive(mesh.thickness, "thickness of the mesh");
  if (const int node = nodeOffPlane(mesh.X); node >= 0)
    throw InputError("it lies at z = " + formatNumber(mesh.X[static_cast<std::size_t>(node)].z) + " m, node 0 at " +
                         formatNumber(mesh.X[0].z) + " m",
                     "node " + std::to_string(node), "let all nodes of plane strain lie in one plane z = const");
}

}  // namespace

void validate(const SolidMesh& mesh) {
  if (mesh.X.empty() || mesh.elementCount() == 0)
    throw InputError("the mesh has no nodes or no elements", "mesh", "give at least one element");
  for (std::size_t node = 0; node < mesh.X.size(); ++node)
    if (!isFinite(mesh.X[node]))
      throw InputError("a position is not finite", "node " + std::to_string(node), "give three numbers");
  requireOneDimension(mesh);
  std::size_t number = 0;
  std::vector<int> bad;
  double worst = std::numeric_limits<double>::infinity();
  for (const ElementGroup& group : mesh.groups) {
    const auto perElement = static_cast<std::size_t>(nodesOf(group.shape));
    if (group.node.size() % perElement != 0)
      throw InputError(std::to_string(group.node.size()) + " node numbers are no whole number of elements",
                       std::string("group of ") + name(group.shape),
                       "give " + std::to_string(perElement) + " per element");
    for (std::size_t e = 0; e < group.size(); ++e, ++number) {
      const std::string where = "element " + std::to_string(number);
      const auto nodes = std::span(group.node).subspan(perElement * e, perElement);
      requireNodes(nodes, mesh.X.size(), where);
      requireDistinctNodes(nodes, where);
      const double least = leastDeterminant(group.shape, nodes, mesh);
      if (!(least > 0.0)) bad.push_back(static_cast<int>(number));
      worst = std::min(worst, least);
    }
  }
  if (!bad.empty())
    throw InputError("flat, inverted or too distorted (least det dX/dxi = " + formatNumber(worst) + " m3)",
                     detail::listed("element", bad), "order the nodes as in solid_mesh.hpp and move them apart");
  requireSets(mesh);
}

}  // namespace dovetail::fem
