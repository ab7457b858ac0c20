#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/cell_topology.hpp"

namespace dovetail::fem {

namespace {

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

}  // namespace

void validate(const SolidMesh& mesh) {
  if (mesh.X.empty() || mesh.elementCount() == 0)
    throw InputError("the mesh has no nodes or no elements", "mesh", "give at least one element");
  for (std::size_t node = 0; node < mesh.X.size(); ++node)
    if (!isFinite(mesh.X[node]))
      throw InputError("a position is not finite", "node " + std::to_string(node), "give three numbers");
  std::size_t number = 0;
  for (const CellGroup& group : mesh.groups) {
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
    }
  }
  requireSets(mesh);
}

}  // namespace dovetail::fem
