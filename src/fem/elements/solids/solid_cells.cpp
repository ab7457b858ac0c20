#include "solid_cells.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "elements/bricks/brick_cache.hpp"
#include "elements/lanes/small_tensors.hpp"
#include "mesh/cell_jacobian.hpp"

namespace dovetail::fem::detail {

namespace {

/// The fraction at a point from the nodes' values; exact where they are all the same.
template <class NodeOf>
double fractionAt(const SolidCells& cells, const double* value, NodeOf&& nodeOf) {
  if (cells.fraction.empty()) return 1.0;
  const double first = cells.fraction[nodeOf(std::size_t{0})];
  double fraction = first;
  for (std::size_t a = 1; a < cells.nodes; ++a) fraction += value[a] * (cells.fraction[nodeOf(a)] - first);
  return fraction;
}

/// Calls visit(ψ, ρ-free weight) at the points of the rule for masses.
template <class Visit>
void visitMassPoints(const SolidCells& cells, std::size_t element, Visit&& visit) {
  const std::size_t n = cells.nodes;
  const CellRule& rule = massRule(cells.shape);
  std::array<int, maxCellNodes> nodes;
  for (std::size_t a = 0; a < n; ++a) nodes[a] = cells.nodeOf(element, a);
  for (std::size_t q = 0; q < rule.point.size(); ++q) {
    const double* const value = &rule.value[n * q];
    const Jacobian J = jacobianAt(cells.X, std::span(nodes).first(n), std::span(rule.gradient).subspan(n * q, n),
                                  depthOf(cells.shape, cells.thickness));
    visit(value, rule.weight[q] * determinant(J) *
                     fractionAt(cells, value, [&](std::size_t a) { return static_cast<std::size_t>(nodes[a]); }));
  }
}

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

void fillBatches(std::span<const int> node, SolidCells& cells) {
  const std::size_t n = cells.nodes;
  cells.batchNode.resize(cells.batches() * n);
  for (std::size_t b = 0; b < cells.batches(); ++b)
    for (std::size_t lane = 0; lane < laneCount; ++lane) {
      const std::size_t e = laneCount * b + std::min(lane, cells.inUse(b) - 1);
      for (std::size_t a = 0; a < n; ++a) cells.batchNode[b * n + a][lane] = node[n * e + a];
    }
}

}  // namespace

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

SolidCells cellsOf(const SolidMesh& mesh, const std::string& set, std::span<const double> fraction) {
  SolidCells cells{};
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

void keep(SolidCells& cells, std::span<const int> elements) {
  std::vector<int> node, number;
  for (const int e : elements) {
    for (std::size_t a = 0; a < cells.nodes; ++a) node.push_back(cells.nodeOf(static_cast<std::size_t>(e), a));
    number.push_back(cells.number[static_cast<std::size_t>(e)]);
  }
  cells.number = std::move(number);
  fillBatches(node, cells);
}

std::vector<PointGeometry> geometryAt(const SolidCells& cells, const CellRule& rule) {
  const std::size_t n = cells.nodes, q = rule.point.size();
  std::vector<PointGeometry> geometry(cells.batches() * q);
  for (std::size_t b = 0; b < cells.batches(); ++b)
    for (std::size_t p = 0; p < q; ++p) {
      std::array<Lane, 9> J{};
      J[8] += depthOf(cells.shape, cells.thickness).z;
      for (std::size_t a = 0; a < n; ++a) {
        const auto& node = cells.batchNode[n * b + a];
        for (std::size_t i = 0; i < 3; ++i) {
          Lane x;
          for (std::size_t lane = 0; lane < laneCount; ++lane)
            x[lane] = cells.X[static_cast<std::size_t>(node[lane])][static_cast<int>(i)];
          for (std::size_t j = 0; j < 3; ++j) J[3 * i + j] += x * rule.gradient[n * p + a][static_cast<int>(j)];
        }
      }
      PointGeometry& point = geometry[b * q + p];
      point.weight = rule.weight[p] * inverseOf(J.data(), point.map.data());
      for (std::size_t lane = 0; lane < laneCount; ++lane)
        point.weight[static_cast<int>(lane)] *=
            lane < cells.inUse(b)
                ? fractionAt(cells, &rule.value[n * p],
                             [&](std::size_t a) { return static_cast<std::size_t>(cells.batchNode[n * b + a][lane]); })
                : 0.0;
    }
  return geometry;
}

std::vector<double> consistentMass(const SolidCells& cells, std::size_t element, double density) {
  const std::size_t n = cells.nodes;
  std::vector<double> mass(n * n, 0.0);
  if (cells.shape == ElementShape::hex8) {
    const std::array<int, 8> nodes = brickNodes(cells, element);
    const std::array<double, 64> products =
        shapeProducts(cornersOf(nodes, cells.X), cornerValues(nodes, cells.fraction));
    for (std::size_t k = 0; k < 64; ++k) mass[k] = density * products[k];
    return mass;
  }
  visitMassPoints(cells, element, [&](const double* value, double volume) {
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b) mass[n * a + b] += density * volume * value[a] * value[b];
  });
  return mass;
}

std::vector<double> rowSumsOfMass(const SolidCells& cells, std::size_t element, double density) {
  const std::size_t n = cells.nodes;
  std::vector<double> sums(n, 0.0);
  if (cells.shape == ElementShape::hex8) {
    const std::array<int, 8> nodes = brickNodes(cells, element);
    const std::array<double, 8> volumes = nodalVolumes(cornersOf(nodes, cells.X), cornerValues(nodes, cells.fraction));
    for (std::size_t a = 0; a < n; ++a) sums[a] = density * volumes[a];
    return sums;
  }
  visitMassPoints(cells, element, [&](const double* value, double volume) {
    for (std::size_t a = 0; a < n; ++a) sums[a] += density * volume * value[a];
  });
  return sums;
}

std::vector<double> lumpedMass(const SolidCells& cells, std::size_t element, double density) {
  if (cells.shape != ElementShape::hex20 && cells.shape != ElementShape::tet10 && cells.shape != ElementShape::quad8)
    return rowSumsOfMass(cells, element, density);
  std::vector<double> diagonal(cells.nodes, 0.0);
  double volume = 0.0, sum = 0.0;
  visitMassPoints(cells, element, [&](const double* value, double part) {
    volume += part;
    for (std::size_t a = 0; a < cells.nodes; ++a) diagonal[a] += part * value[a] * value[a];
  });
  for (const double value : diagonal) sum += value;
  for (double& value : diagonal) value *= density * (volume / sum);
  return diagonal;
}

}  // namespace dovetail::fem::detail
