#include "dovetail/arlequin/gap_operator.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/mesh/shape.hpp"

namespace dovetail::arlequin {

namespace {

constexpr std::size_t grain = 256;
using Rows = std::vector<cg::ProjectionRow>;

/// A point of a quadrature in a brick: shape functions, place and weight (m³).
struct QuadraturePoint {
  std::array<double, 8> shape;
  Vec3 x;
  double weight;
};

double volumeFactor(std::span<const Vec3> X, const std::array<int, 8>& element, const Vec3& xi) {
  const std::array<Vec3, 8> gradient = fem::parentGradients(xi);
  std::array<Vec3, 3> J;  // column j = ∂X/∂ξ_j
  for (std::size_t a = 0; a < 8; ++a)
    for (int j = 0; j < 3; ++j)
      J[static_cast<std::size_t>(j)] += gradient[a][j] * X[static_cast<std::size_t>(element[a])];
  return dot(J[0], cross(J[1], J[2]));
}

/// Points of a brick cut into cells³ parts with 2×2×2 Gauss points each.
std::vector<QuadraturePoint> quadrature(std::span<const Vec3> X, const std::array<int, 8>& element, int cells) {
  const double gauss = 1.0 / std::sqrt(3.0), size = 1.0 / cells;
  std::vector<double> line;
  for (int c = 0; c < cells; ++c)
    for (const double side : {-gauss, gauss}) line.push_back(-1.0 + size * (2.0 * c + 1.0 + side));
  std::vector<QuadraturePoint> points;
  for (const double z : line)
    for (const double y : line)
      for (const double x : line) {
        QuadraturePoint point{fem::shapeValues({x, y, z}), {}, size * size * size};
        point.weight *= volumeFactor(X, element, {x, y, z});
        for (std::size_t a = 0; a < 8; ++a) point.x += point.shape[a] * X[static_cast<std::size_t>(element[a])];
        points.push_back(point);
      }
  return points;
}

/// Elements with a weight above 0, with or without particles.
std::vector<int> weightedElements(const Overlap& overlap, const Bricks& mesh) {
  std::vector<int> elements;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    if (std::any_of(mesh.elements[e].begin(), mesh.elements[e].end(),
                    [&](int n) { return overlap.nodalWeight[static_cast<std::size_t>(n)] > 0.0; }))
      elements.push_back(static_cast<int>(e));
  return elements;
}

/// Gap rows of the corners of the overlap's elements.
struct RowNumbers {
  std::vector<int> place;                  // of each element of the mesh among the overlap's, −1 elsewhere
  std::vector<std::array<int, 8>> corner;  // row of each corner of those elements

  const std::array<int, 8>& of(int element) const {
    return corner[static_cast<std::size_t>(place[static_cast<std::size_t>(element)])];
  }
};

/// One row per node, or one per element and corner.
RowNumbers numberRows(const std::vector<int>& elements, const Bricks& mesh, bool perElement, std::vector<int>& node) {
  RowNumbers rows{std::vector<int>(mesh.elements.size(), -1), {}};
  std::vector<int> ofNode(mesh.X.size(), -1);
  if (!perElement) {
    for (const int e : elements)
      for (const int n : mesh.elements[static_cast<std::size_t>(e)]) ofNode[n] = 0;
    for (std::size_t n = 0; n < ofNode.size(); ++n)
      if (ofNode[n] == 0) {
        ofNode[n] = static_cast<int>(node.size());
        node.push_back(static_cast<int>(n));
      }
  }
  for (const int e : elements) {
    rows.place[static_cast<std::size_t>(e)] = static_cast<int>(rows.corner.size());
    std::array<int, 8> corner;
    for (std::size_t a = 0; a < 8; ++a) {
      const int n = mesh.elements[static_cast<std::size_t>(e)][a];
      corner[a] = perElement ? static_cast<int>(node.size()) : ofNode[n];
      if (perElement) node.push_back(n);
    }
    rows.corner.push_back(corner);
  }
  return rows;
}

void addLocalRows(const Overlap& overlap, std::span<const double> mass, const RowNumbers& row, Rows& rows) {
  for (std::size_t k = 0; k < overlap.size(); ++k) {
    if (!(overlap.weight[k] > 0.0) || overlap.place[k].element < 0) continue;
    for (std::size_t a = 0; a < 8; ++a) {
      const double value = mass[static_cast<std::size_t>(overlap.particle[k])] * overlap.place[k].shape[a];
      if (value > 0.0)
        rows[static_cast<std::size_t>(row.of(overlap.place[k].element)[a])].emplace_back(static_cast<int>(k), value);
    }
  }
}

/// ∫W(x − x_α) ψ_i dx per row and particle over the overlap's elements, dense in the reach of the kernel.
std::vector<std::vector<double>> kernelIntegrals(const Overlap& overlap, const Bricks& mesh,
                                                 std::span<const Vec3> position, const dem::Particles& particles,
                                                 const ProjectionOptions& options, const RowNumbers& row,
                                                 std::size_t rows) {
  const cg::Kernel kernel{options.kernel, 3, options.width};
  std::vector<std::vector<double>> dense(rows, std::vector<double>(overlap.size(), 0.0));
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    if (row.place[e] < 0) continue;
    const auto& element = mesh.elements[e];
    const int fine = std::clamp(static_cast<int>(std::ceil(1.5 * elementSize(mesh, element) / options.width)), 1, 8);
    const int cells = options.kernelCells > 0 ? options.kernelCells : fine;
    const std::vector<QuadraturePoint> points = quadrature(position, element, cells);
    parallelFor(overlap.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        if (!(overlap.weight[k] > 0.0)) continue;
        const Vec3& x = particles.x[static_cast<std::size_t>(overlap.particle[k])];
        std::array<double, 8> sum{};
        for (const QuadraturePoint& point : points) {
          const double distance = norm(point.x - x);
          if (distance >= options.width) continue;
          const double value = point.weight * kernel(distance);
          for (std::size_t a = 0; a < 8; ++a) sum[a] += value * point.shape[a];
        }
        for (std::size_t a = 0; a < 8; ++a)
          dense[static_cast<std::size_t>(row.of(static_cast<int>(e))[a])][k] += sum[a];
      }
    });
  }
  return dense;
}

/// What each particle's kernel amounts to within the overlap; 1 for all if the kernels are not normalised there.
std::vector<double> kernelSums(const std::vector<std::vector<double>>& dense, std::size_t particles, bool normalised) {
  std::vector<double> sum(particles, normalised ? 0.0 : 1.0);
  if (normalised)
    for (const std::vector<double>& row : dense)
      for (std::size_t k = 0; k < particles; ++k) sum[k] += row[k];
  return sum;
}

void addKernelRows(const Overlap& overlap, const Bricks& mesh, std::span<const Vec3> position,
                   const dem::Particles& particles, std::span<const double> mass, const ProjectionOptions& options,
                   const RowNumbers& row, Rows& rows) {
  const auto dense = kernelIntegrals(overlap, mesh, position, particles, options, row, rows.size());
  const std::vector<double> whole = kernelSums(dense, overlap.size(), options.normaliseKernels);
  Rows local(rows.size());
  addLocalRows(overlap, mass, row, local);
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t k = 0; k < overlap.size(); ++k)
      if (dense[r][k] > 0.0)
        rows[r].emplace_back(static_cast<int>(k),
                             mass[static_cast<std::size_t>(overlap.particle[k])] * dense[r][k] / whole[k]);
  // A kernel so narrow that it falls between the points of the quadrature is the local map.
  for (std::size_t k = 0; k < overlap.size(); ++k)
    if (whole[k] == 0.0)
      for (std::size_t r = 0; r < rows.size(); ++r)
        for (const auto& entry : local[r])
          if (entry.first == static_cast<int>(k)) rows[r].push_back(entry);
}

void normalise(Rows& rows) {
  for (cg::ProjectionRow& row : rows) {
    double sum = 0.0;
    for (const auto& entry : row) sum += entry.second;
    for (auto& entry : row) entry.second /= sum;
  }
}

/// Leaves out rows without a particle.
void dropEmptyRows(Rows& rows, std::vector<int>& node, RowNumbers& numbers) {
  std::vector<int> renumbered(rows.size(), -1);
  std::size_t kept = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (rows[r].empty()) continue;
    if (kept != r) {
      rows[kept] = std::move(rows[r]);
      node[kept] = node[r];
    }
    renumbered[r] = static_cast<int>(kept++);
  }
  rows.resize(kept);
  node.resize(kept);
  for (std::array<int, 8>& corner : numbers.corner)
    for (int& row : corner) row = renumbered[static_cast<std::size_t>(row)];
}

/// Volumes and ∫ψ_iψ_j of the rows.
void addVolumes(const std::vector<int>& elements, const Bricks& mesh, const RowNumbers& row, GapOperator& gap) {
  gap.volume.assign(gap.rows(), 0.0);
  Rows products(gap.rows());
  for (const int e : elements) {
    const auto& element = mesh.elements[static_cast<std::size_t>(e)];
    const std::array<int, 8>& corner = row.of(e);
    for (const QuadraturePoint& point : quadrature(mesh.X, element, 1))
      for (std::size_t a = 0; a < 8; ++a) {
        if (corner[a] < 0) continue;
        gap.volume[corner[a]] += point.weight * point.shape[a];
        for (std::size_t b = 0; b < 8; ++b)
          if (corner[b] >= 0)
            products[corner[a]].emplace_back(corner[b], point.weight * point.shape[a] * point.shape[b]);
      }
  }
  gap.volumeProducts = cg::fromRows(static_cast<int>(gap.rows()), products);
}

/// Bᵀ by the nodes that it touches.
void addNodesBack(GapOperator& gap) {
  const cg::Projection all = cg::transposed(gap.nodes);
  Rows rows;
  for (int n = 0; n < all.rows(); ++n) {
    if (all.rowColumns(n).empty()) continue;
    gap.coupledNode.push_back(n);
    rows.emplace_back();
    for (int k = all.offsets[n]; k < all.offsets[n + 1]; ++k) rows.back().emplace_back(all.column[k], all.weight[k]);
  }
  gap.nodesBack = cg::fromRows(all.columns, rows);
}

}  // namespace

double elementSize(const Bricks& mesh, const std::array<int, 8>& element) {
  double volume = 0.0;
  for (const QuadraturePoint& point : quadrature(mesh.X, element, 1)) volume += point.weight;
  return std::cbrt(volume);
}

GapOperator makeGapOperator(const Overlap& overlap, const Bricks& mesh, const dem::Particles& particles,
                            std::span<const double> mass, GapForm form, const ProjectionOptions& options,
                            std::span<const Vec3> position) {
  requireNonNegative(options.width, "coarse-graining width");
  GapOperator gap;
  const std::vector<int> elements =
      options.reachOut && options.width > 0.0 ? weightedElements(overlap, mesh) : overlap.elements;
  RowNumbers row = numberRows(elements, mesh, options.perElement, gap.node);
  Rows rows(gap.node.size());
  if (options.width == 0.0)
    addLocalRows(overlap, mass, row, rows);
  else
    addKernelRows(overlap, mesh, position.empty() ? std::span<const Vec3>(mesh.X) : position, particles, mass, options,
                  row, rows);
  dropEmptyRows(rows, gap.node, row);
  normalise(rows);
  gap.particles = cg::fromRows(static_cast<int>(overlap.size()), rows);
  gap.particlesBack = cg::transposed(gap.particles);
  if (form == GapForm::atParticles) {
    gap.nodes = cg::product(gap.particles, interpolationAtParticles(overlap, mesh.elements, mesh.X.size()));
  } else {
    Rows unit;
    for (const int n : gap.node) unit.push_back({{n, 1.0}});
    gap.nodes = cg::fromRows(static_cast<int>(mesh.X.size()), unit);
  }
  addNodesBack(gap);
  addVolumes(elements, mesh, row, gap);
  return gap;
}

void gapOf(const GapOperator& gap, const Overlap& overlap, std::span<const Vec3> particles, std::span<const Vec3> nodes,
           std::span<Vec3> out) {
  parallelFor(gap.rows(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      Vec3 sum;
      for (int k = gap.particles.offsets[r]; k < gap.particles.offsets[r + 1]; ++k)
        sum += gap.particles.weight[k] * particles[overlap.particle[gap.particles.column[k]]];
      for (int k = gap.nodes.offsets[r]; k < gap.nodes.offsets[r + 1]; ++k)
        sum -= gap.nodes.weight[k] * nodes[gap.nodes.column[k]];
      out[r] = sum;
    }
  });
}

void pullParticles(const GapOperator& gap, const Overlap& overlap, std::span<const Vec3> lambda,
                   std::span<Vec3> particleForce) {
  parallelFor(overlap.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      particleForce[overlap.particle[k]] -= cg::applyRow(gap.particlesBack, static_cast<int>(k), lambda);
  });
}

void pullNodes(const GapOperator& gap, std::span<const Vec3> lambda, std::span<Vec3> nodeForce) {
  for (std::size_t n = 0; n < gap.coupledNode.size(); ++n)
    nodeForce[gap.coupledNode[n]] += cg::applyRow(gap.nodesBack, static_cast<int>(n), lambda);
}

}  // namespace dovetail::arlequin
