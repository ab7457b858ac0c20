// What of each particle's kernel lies under each vertex shape function.
#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/core/parallel.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"
#include "gap/gap_rows.hpp"

namespace dovetail::arlequin {

namespace {

/// Of one particle in one element, per corner.
struct Fraction {
  int particle;
  std::array<double, 8> value;
};

geometry::Box boxOf(std::span<const CellPoint> points) {
  constexpr double far = std::numeric_limits<double>::max();
  geometry::Box box{{far, far, far}, {-far, -far, -far}};
  for (const CellPoint& point : points)
    for (int c = 0; c < 3; ++c) {
      box.lower[c] = std::min(box.lower[c], point.x[c]);
      box.upper[c] = std::max(box.upper[c], point.x[c]);
    }
  return box;
}

std::vector<Fraction> weightsOf(const Overlap& overlap, std::span<const CellPoint> points, const cg::Kernel& kernel,
                                const geometry::HierarchicalGrid& reach) {
  const double peak = kernel.peak();
  std::vector<Fraction> weights;
  for (const int k : reach.query(boxOf(points))) {
    const auto at = static_cast<std::size_t>(k);
    if (!(overlap.weight[at] > 0.0)) continue;
    Fraction weight{k, {}};
    bool reached = false;
    for (const CellPoint& point : points) {
      const double distance = norm(point.x - overlap.x[at]);
      if (distance >= kernel.width) continue;
      reached = true;
      const double value = point.weight * (peak * cg::profile(kernel.shape, distance / kernel.width));
      for (std::size_t a = 0; a < 8; ++a) weight.value[a] += value * point.vertexShape[a];
    }
    if (reached) weights.push_back(weight);
  }
  return weights;
}

/// Adds up what several elements have for one particle, in their order.
void gather(cg::ProjectionRow& row) {
  std::ranges::stable_sort(row, {}, [](const auto& entry) { return entry.first; });
  std::size_t last = 0;
  for (std::size_t k = 1; k < row.size(); ++k)
    if (row[k].first == row[last].first)
      row[last].second += row[k].second;
    else
      row[++last] = row[k];
  if (!row.empty()) row.resize(last + 1);
}

}  // namespace

Rows kernelIntegrals(const Overlap& overlap, const fem::SolidMesh& mesh, std::span<const Vec3> position,
                     const ProjectionOptions& options, const RowNumbers& row, std::size_t rows) {
  const cg::Kernel kernel{options.kernel, 3, options.width};
  geometry::HierarchicalGrid reach;
  reach.build(overlap.x, std::vector<double>(overlap.size(), options.width));
  std::vector<int> elements;
  for (std::size_t e = 0; e < row.place.size(); ++e)
    if (row.place[e] >= 0) elements.push_back(static_cast<int>(e));
  std::vector<std::vector<Fraction>> weights(elements.size());
  parallelFor(elements.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const double parts = std::ceil(1.5 * elementSize(mesh, elements[e]) / options.width);
      const int fine = static_cast<int>(std::clamp(parts, 1.0, 8.0));
      const auto points = cellPoints(mesh, position, elements[e], options.kernelCells > 0 ? options.kernelCells : fine);
      weights[e] = weightsOf(overlap, points, kernel, reach);
    }
  });
  Rows integrals(rows);
  for (std::size_t e = 0; e < elements.size(); ++e)
    for (const Fraction& weight : weights[e])
      for (std::size_t a = 0; a < 8; ++a)
        if (const int r = row.of(elements[e])[a]; r >= 0)
          integrals[static_cast<std::size_t>(r)].emplace_back(weight.particle, weight.value[a]);
  for (cg::ProjectionRow& each : integrals) gather(each);
  return integrals;
}

}  // namespace dovetail::arlequin
