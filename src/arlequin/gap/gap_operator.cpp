#include "dovetail/arlequin/gap_operator.hpp"

#include <algorithm>
#include <array>

#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "gap_rows.hpp"

namespace dovetail::arlequin {

namespace {

constexpr std::size_t chunkSize = 256;
/// Elements with a weight above 0, with or without particles.
std::vector<int> weightedElements(const Overlap& overlap, const fem::SolidMesh& mesh) {
  std::vector<int> elements;
  for (int e = 0; e < static_cast<int>(mesh.elementCount()); ++e)
    if (std::ranges::any_of(cellOf(mesh, e).corner(),
                            [&](int n) { return overlap.nodalWeight[static_cast<std::size_t>(n)] > 0.0; }))
      elements.push_back(e);
  return elements;
}

/// One row per node, or one per element and corner.
RowNumbers numberRows(const std::vector<int>& elements, const fem::SolidMesh& mesh, bool perElement,
                      std::vector<int>& node) {
  RowNumbers rows{std::vector<int>(mesh.elementCount(), -1), {}};
  std::vector<int> ofNode(mesh.X.size(), -1);
  if (!perElement) {
    for (const int e : elements)
      for (const int n : cellOf(mesh, e).corner()) ofNode[n] = 0;
    for (std::size_t n = 0; n < ofNode.size(); ++n)
      if (ofNode[n] == 0) {
        ofNode[n] = static_cast<int>(node.size());
        node.push_back(static_cast<int>(n));
      }
  }
  for (const int e : elements) {
    rows.place[static_cast<std::size_t>(e)] = static_cast<int>(rows.corner.size());
    std::array<int, 8>& corner = rows.corner.emplace_back();
    corner.fill(-1);
    const std::span<const int> nodes = cellOf(mesh, e).corner();
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      corner[a] = perElement ? static_cast<int>(node.size()) : ofNode[nodes[a]];
      if (perElement) node.push_back(nodes[a]);
    }
  }
  return rows;
}

void addLocalRow(const Overlap& overlap, std::size_t k, const fem::SolidMesh& mesh, double mass, const RowNumbers& row,
                 Rows& rows) {
  const fem::CellPlace& place = overlap.place[k];
  if (!(overlap.weight[k] > 0.0) || place.element < 0 || row.place[place.element] < 0) return;
  const std::vector<double> vertexShape = vertexShapes(cellOf(mesh, place.element).shape, place.xi);
  for (std::size_t a = 0; a < vertexShape.size(); ++a)
    if (const double value = mass * vertexShape[a]; value > 0.0)
      rows[static_cast<std::size_t>(row.of(place.element)[a])].emplace_back(static_cast<int>(k), value);
}

void addLocalRows(const Overlap& overlap, const fem::SolidMesh& mesh, std::span<const double> mass,
                  const RowNumbers& row, Rows& rows) {
  for (std::size_t k = 0; k < overlap.size(); ++k)
    addLocalRow(overlap, k, mesh, mass[static_cast<std::size_t>(overlap.particle[k])], row, rows);
}

void addKernelRows(const Overlap& overlap, const fem::SolidMesh& mesh, std::span<const Vec3> position,
                   std::span<const double> mass, const ProjectionOptions& options, const RowNumbers& row, Rows& rows) {
  const Rows integrals = kernelIntegrals(overlap, mesh, position, options, row, rows.size());
  // What each particle's kernel amounts to within the overlap.
  std::vector<double> whole(overlap.size(), 0.0);
  for (const cg::ProjectionRow& each : integrals)
    for (const auto& [k, value] : each) whole[static_cast<std::size_t>(k)] += value;
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (const auto& [k, value] : integrals[r]) {
      const auto at = static_cast<std::size_t>(k);
      if (value > 0.0)
        rows[r].emplace_back(k, mass[static_cast<std::size_t>(overlap.particle[at])] * value /
                                    (options.normaliseKernels ? whole[at] : 1.0));
    }
  // A kernel so narrow that it falls between the points of the quadrature is the local map.
  for (std::size_t k = 0; k < overlap.size(); ++k)
    if (whole[k] == 0.0) addLocalRow(overlap, k, mesh, mass[static_cast<std::size_t>(overlap.particle[k])], row, rows);
}

double sumOf(const cg::ProjectionRow& row) {
  double sum = 0.0;
  for (const auto& entry : row) sum += entry.second;
  return sum;
}

void normalise(Rows& rows) {
  for (cg::ProjectionRow& row : rows) {
    const double sum = sumOf(row);
    for (auto& entry : row) entry.second /= sum;
  }
}

/// Leaves out rows without a particle, and those that hang on next to nothing.
void dropEmptyRows(Rows& rows, std::vector<int>& node, RowNumbers& numbers) {
  constexpr double nothing = 1e-3;  // of the mean
  double mean = 0.0;
  for (const cg::ProjectionRow& row : rows) mean += sumOf(row) / static_cast<double>(rows.size());
  std::vector<int> renumbered(rows.size(), -1);
  std::size_t kept = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (rows[r].empty() || sumOf(rows[r]) < nothing * mean) continue;
    if (kept != r) {
      rows[kept] = std::move(rows[r]);
      node[kept] = node[r];
    }
    renumbered[r] = static_cast<int>(kept++);
  }
  rows.resize(kept);
  node.resize(kept);
  for (std::array<int, 8>& corner : numbers.corner)
    for (int& row : corner)
      if (row >= 0) row = renumbered[static_cast<std::size_t>(row)];
}

/// Volumes and ∫ψ_iψ_j of the rows.
void addVolumes(const std::vector<int>& elements, const fem::SolidMesh& mesh, const RowNumbers& row, GapOperator& gap) {
  gap.volume.assign(gap.rows(), 0.0);
  Rows products(gap.rows());
  for (const int e : elements) {
    const std::array<int, 8>& corner = row.of(e);
    std::array<std::array<double, 8>, 8> product{};
    for (const CellPoint& point : cellPoints(mesh, mesh.X, e, 1))
      for (std::size_t a = 0; a < 8; ++a) {
        if (corner[a] >= 0) gap.volume[corner[a]] += point.weight * point.vertexShape[a];
        for (std::size_t b = 0; b < 8; ++b) product[a][b] += point.weight * point.vertexShape[a] * point.vertexShape[b];
      }
    for (std::size_t a = 0; a < 8; ++a)
      for (std::size_t b = 0; b < 8; ++b)
        if (corner[a] >= 0 && corner[b] >= 0) products[corner[a]].emplace_back(corner[b], product[a][b]);
  }
  gap.volumeProducts = cg::fromRows(static_cast<int>(gap.rows()), products);
}

/// Bᵀ by the nodes that it touches.
void addNodesBack(GapOperator& gap) {
  gap.nodesBack = cg::transposed(gap.nodes);
  std::vector<int>& offsets = gap.nodesBack.offsets;
  for (std::size_t n = 0; n + 1 < offsets.size(); ++n)
    if (offsets[n + 1] > offsets[n]) {
      offsets[gap.coupledNode.size()] = offsets[n];
      gap.coupledNode.push_back(static_cast<int>(n));
    }
  const int end = offsets.back();
  offsets.resize(gap.coupledNode.size() + 1);
  offsets.back() = end;
}

}  // namespace

GapOperator makeGapOperator(const Overlap& overlap, const fem::SolidMesh& mesh, std::span<const double> mass,
                            GapForm form, const ProjectionOptions& options, std::span<const Vec3> position,
                            RowVolumes volumes) {
  requireNonNegative(options.width, "coarse-graining width");
  GapOperator gap;
  const std::vector<int> elements =
      options.reachOut && options.width > 0.0 ? weightedElements(overlap, mesh) : overlap.elements;
  RowNumbers row = numberRows(elements, mesh, options.perElement, gap.node);
  Rows rows(gap.node.size());
  if (options.width == 0.0)
    addLocalRows(overlap, mesh, mass, row, rows);
  else
    addKernelRows(overlap, mesh, position.empty() ? std::span<const Vec3>(mesh.X) : position, mass, options, row, rows);
  dropEmptyRows(rows, gap.node, row);
  for (const int n : gap.node) gap.X.push_back(mesh.X[static_cast<std::size_t>(n)]);
  normalise(rows);
  gap.particles = cg::fromRows(static_cast<int>(overlap.size()), rows);
  gap.particlesBack = cg::transposed(gap.particles);
  if (form == GapForm::atParticles) {
    gap.nodes = cg::product(gap.particles, interpolationAtParticles(overlap, mesh));
  } else {
    Rows unit;
    for (const int n : gap.node) unit.push_back({{n, 1.0}});
    gap.nodes = cg::fromRows(static_cast<int>(mesh.X.size()), unit);
  }
  addNodesBack(gap);
  if (volumes == RowVolumes::integrated) addVolumes(elements, mesh, row, gap);
  return gap;
}

std::vector<double> sumsAtRows(const GapOperator& gap, const Overlap& overlap, const fem::SolidMesh& mesh,
                               std::span<const double> value) {
  std::vector<int> rowOf(mesh.X.size(), -1);
  for (std::size_t r = 0; r < gap.rows(); ++r) rowOf[static_cast<std::size_t>(gap.node[r])] = static_cast<int>(r);
  std::vector<double> sum(gap.rows(), 0.0);
  for (std::size_t k = 0; k < overlap.size(); ++k) {
    if (overlap.place[k].element < 0) continue;
    const Cell cell = cellOf(mesh, overlap.place[k].element);
    const std::vector<double> vertexShape = vertexShapes(cell.shape, overlap.place[k].xi);
    for (std::size_t a = 0; a < vertexShape.size(); ++a)
      if (const int row = rowOf[static_cast<std::size_t>(cell.corner()[a])]; row >= 0)
        sum[row] += value[k] * vertexShape[a];
  }
  return sum;
}

void gapOfMembers(const GapOperator& gap, std::span<const Vec3> members, std::span<const Vec3> nodes,
                  std::span<Vec3> out) {
  parallelFor(gap.rows(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      Vec3 sum;
      for (int k = gap.particles.offsets[r]; k < gap.particles.offsets[r + 1]; ++k)
        sum += gap.particles.weight[k] * members[gap.particles.column[k]];
      for (int k = gap.nodes.offsets[r]; k < gap.nodes.offsets[r + 1]; ++k)
        sum -= gap.nodes.weight[k] * nodes[gap.nodes.column[k]];
      out[r] = sum;
    }
  });
}

void gapOf(const GapOperator& gap, const Overlap& overlap, std::span<const Vec3> particles, std::span<const Vec3> nodes,
           std::span<Vec3> out) {
  std::vector<Vec3> members(overlap.size());
  parallelFor(members.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) members[k] = particles[overlap.particle[k]];
  });
  gapOfMembers(gap, members, nodes, out);
}

void pullParticles(const GapOperator& gap, const Overlap& overlap, std::span<const Vec3> lambda,
                   std::span<Vec3> particleForce) {
  parallelFor(overlap.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      particleForce[overlap.particle[k]] -= cg::applyRow(gap.particlesBack, static_cast<int>(k), lambda);
  });
}

void pullNodes(const GapOperator& gap, std::span<const Vec3> lambda, std::span<Vec3> nodeForce) {
  parallelFor(gap.coupledNode.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      nodeForce[gap.coupledNode[n]] += cg::applyRow(gap.nodesBack, static_cast<int>(n), lambda);
  });
}

}  // namespace dovetail::arlequin
