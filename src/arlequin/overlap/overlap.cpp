#include "dovetail/arlequin/overlap.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "overlap_locator.hpp"

namespace dovetail::arlequin {

namespace {

bool anyWeight(const Cell& cell, std::span<const double> weight) {
  return std::ranges::any_of(cell.corner(), [&](int n) { return weight[static_cast<std::size_t>(n)] > 0.0; });
}

/// Around the nodes of elements with a weight above 0.
geometry::Box boxOfWeights(const fem::SolidMesh& mesh, std::span<const Vec3> position, std::span<const double> weight) {
  constexpr double far = std::numeric_limits<double>::max();
  geometry::Box box{{far, far, far}, {-far, -far, -far}};
  for (int e = 0; e < static_cast<int>(mesh.elementCount()); ++e) {
    const Cell cell = cellOf(mesh, e);
    if (!anyWeight(cell, weight)) continue;
    for (const int n : cell.node)
      for (int c = 0; c < 3; ++c) {
        const double x = position[static_cast<std::size_t>(n)][c];
        box.lower[c] = std::min(box.lower[c], x);
        box.upper[c] = std::max(box.upper[c], x);
      }
  }
  return box;
}

bool contains(const geometry::Box& box, const Vec3& x) {
  for (int c = 0; c < 3; ++c)
    if (x[c] < box.lower[c] || x[c] > box.upper[c]) return false;
  return true;
}

void requireOverlap(const Overlap& overlap, const fem::SolidMesh& mesh) {
  bool anyElement = false;
  for (int e = 0; e < static_cast<int>(mesh.elementCount()); ++e)
    anyElement = anyElement || anyWeight(cellOf(mesh, e), overlap.nodalWeight);
  if (!anyElement)
    throw InputError("the overlap has no elements: no node has a weight above 0", "overlap",
                     "let the mesh reach into the particles");
  if (overlap.elements.empty())
    throw InputError("the overlap has no particles", "overlap", "let the particles reach into the mesh");
}

}  // namespace

double weightAt(const fem::SolidMesh& mesh, const fem::CellPlace& place, std::span<const double> nodal) {
  const Cell cell = cellOf(mesh, place.element);
  const std::vector<double> vertexShape = vertexShapes(cell.shape, place.xi);
  const std::span<const int> corner = cell.corner();
  const double first = nodal[static_cast<std::size_t>(corner[0])];
  double weight = first;  // exact where the nodes agree
  for (std::size_t a = 1; a < corner.size(); ++a)
    weight += vertexShape[a] * (nodal[static_cast<std::size_t>(corner[a])] - first);
  return std::clamp(weight, 0.0, 1.0);
}

Overlap locateOverlap(const dem::Particles& particles, const fem::SolidMesh& mesh, const fem::Nodes& nodes,
                      std::span<const double> nodalWeight, double reach, const geometry::Periodicity& space) {
  if (nodalWeight.size() != nodes.X.size())
    throw InputError(
        "there are " + std::to_string(nodalWeight.size()) + " weights for " + std::to_string(nodes.X.size()) + " nodes",
        "overlap", "give one per node");
  for (std::size_t n = 0; n < nodalWeight.size(); ++n)
    if (!(nodalWeight[n] >= 0.0 && nodalWeight[n] <= 1.0))
      throw InputError("the weight of node " + std::to_string(n) + " is " + formatNumber(nodalWeight[n]), "overlap",
                       "give weights from 0 to 1, such as those of nodalWeights");
  requireSpatialCells(mesh);
  requireFinite(particles.x, "particle", "position", "search for the overlap");
  const std::vector<Vec3> position = positionsOf(nodes.X, nodes.u);
  const OverlapLocator locator(mesh, position, nodalWeight, space);
  Overlap overlap;
  overlap.nodalWeight.assign(nodalWeight.begin(), nodalWeight.end());
  const geometry::Box box = boxOfWeights(mesh, position, nodalWeight), reached = geometry::expanded(box, reach);
  std::vector<FoundParticle> found(particles.size());
  parallelFor(particles.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) found[i] = locator.find(particles.x[i], particles.radius[i]);
  });
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const bool hosted = found[i].place.element >= 0;
    if (!hosted && contains(box, particles.x[i])) overlap.stray.push_back(static_cast<int>(i));
    if (!hosted && (reach == 0.0 || !contains(reached, particles.x[i]))) continue;
    if (hosted && found[i].weight > 0.0) overlap.elements.push_back(found[i].place.element);
    addMember(overlap, static_cast<int>(i), std::move(found[i].place), found[i].x, found[i].weight);
  }
  sortUnique(overlap.elements);
  requireOverlap(overlap, mesh);
  return overlap;
}

void requireWidth(const Overlap& overlap, const fem::SolidMesh& mesh) {
  const std::vector<double>& w = overlap.nodalWeight;
  double least = 1.0, most = 0.0;  // of the weights above 0
  for (const double weight : w)
    if (weight > 0.0) least = std::min(least, weight), most = std::max(most, weight);
  double bottom = 1.0, top = 0.0, narrowest = 1.0;
  for (const int e : overlap.elements) {
    double lower = 1.0, upper = 0.0;
    for (const int n : cellOf(mesh, e).corner())
      lower = std::min(lower, w[static_cast<std::size_t>(n)]), upper = std::max(upper, w[static_cast<std::size_t>(n)]);
    if (lower == 0.0 && upper <= least && upper < 0.5 * most) continue;  // beyond the particles' border
    bottom = std::min(bottom, lower), top = std::max(top, upper);
    narrowest = std::min(narrowest, upper - lower);
  }
  constexpr double roundOff = 1e-9;
  if (top - bottom > roundOff && narrowest > (top - bottom) * (1.0 - roundOff))
    throw InputError("the particles reach over less than an element of the overlap", "overlap",
                     "fill the overlap with particles before it is made, widen it, or refine the mesh there");
}

std::vector<double> solidWeights(std::span<const double> nodalWeight) {
  std::vector<double> solid(nodalWeight.size());
  for (std::size_t n = 0; n < solid.size(); ++n) solid[n] = 1.0 - nodalWeight[n];
  return solid;
}

cg::Projection interpolationAtParticles(const Overlap& overlap, const fem::SolidMesh& mesh) {
  std::vector<cg::ProjectionRow> rows(overlap.size());
  parallelFor(rows.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const fem::CellPlace& place = overlap.place[k];
      if (place.element < 0)
        throw InputError("particle " + std::to_string(overlap.particle[k]) + " is outside of the mesh",
                         "interpolationAtParticles", "locate the overlap without a reach");
      const Cell cell = cellOf(mesh, place.element);
      rows[k].reserve(cell.node.size());
      for (std::size_t a = 0; a < cell.node.size(); ++a) rows[k].emplace_back(cell.node[a], place.shape[a]);
      std::ranges::sort(rows[k], {}, [](const auto& entry) { return entry.first; });
    }
  });
  return cg::fromRows(static_cast<int>(mesh.X.size()), rows);
}

}  // namespace dovetail::arlequin
