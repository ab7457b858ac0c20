#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "closed_patches.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "half_edges.hpp"

namespace dovetail::geometry {

namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& c) const {
    std::uint64_t h = 0;
    for (const std::int64_t k : c) h = (h ^ static_cast<std::uint64_t>(k)) * 0x9E3779B97F4A7C15u, h ^= h >> 29;
    return static_cast<std::size_t>(h);
  }
};

/// Vertices that are kept, by cells a few tolerances wide.
class KeptVertices {
public:
  KeptVertices(std::span<const Vec3> x, double tolerance) : x_(x), tolerance_(tolerance) {
    double extent = 0.0;
    for (const Vec3& p : x) extent = std::max({extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    // Never so small that cell numbers lose their units.
    const double size = std::max(4.0 * tolerance, 1e-12 * extent);
    perCell_ = size > 0.0 ? 1.0 / size : 1.0;
  }

  /// The lowest kept vertex within the tolerance, or −1.
  int find(const Vec3& p) const {
    const Vec3 reach{tolerance_, tolerance_, tolerance_};
    const Cell low = cellOf(p - reach), high = cellOf(p + reach);
    int best = -1;
    for (Cell c{low[0], 0, 0}; c[0] <= high[0]; ++c[0])
      for (c[1] = low[1]; c[1] <= high[1]; ++c[1])
        for (c[2] = low[2]; c[2] <= high[2]; ++c[2]) {
          const auto cell = cells_.find(c);
          if (cell == cells_.end()) continue;
          for (const int v : cell->second)
            if ((best < 0 || v < best) && squaredNorm(x_[at(v)] - p) <= tolerance_ * tolerance_) best = v;
        }
    return best;
  }
  void keep(int v) { cells_[cellOf(x_[at(v)])].push_back(v); }

private:
  Cell cellOf(const Vec3& p) const {
    Cell c;
    for (int k = 0; k < 3; ++k) c[at(k)] = static_cast<std::int64_t>(std::floor(p[k] * perCell_));
    return c;
  }

  std::span<const Vec3> x_;
  double tolerance_, perCell_ = 1.0;
  std::unordered_map<Cell, std::vector<int>, CellHash> cells_;
};

/// Keeps the vertices with a number ≥ 0 in `kept`, and numbers them anew.
void compactVertices(TriangleMesh& mesh, const std::vector<char>& kept, std::vector<int>& target) {
  std::vector<int> number(mesh.x.size(), -1);
  std::size_t count = 0;
  for (std::size_t v = 0; v < mesh.x.size(); ++v)
    if (kept[v]) {
      number[v] = static_cast<int>(count);
      mesh.x[count++] = mesh.x[v];
    }
  mesh.x.resize(count);
  for (Facet& f : mesh.facets)
    for (int& v : f) v = number[at(target[at(v)])];
}

void dropFacets(TriangleMesh& mesh, SurfaceRepair& report) {
  std::vector<std::pair<Facet, std::size_t>> sorted;
  std::vector<char> dropped(mesh.facets.size(), 0);
  for (std::size_t i = 0; i < mesh.facets.size(); ++i) {
    Facet f = mesh.facets[i];
    if (repeatsVertex(f) || !(relativeHeight(mesh.x, f) > roundOffHeight)) {
      dropped[i] = 1;
      ++report.degenerateFacets;
      continue;
    }
    std::sort(f.begin(), f.end());
    sorted.emplace_back(f, i);
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t k = 1; k < sorted.size(); ++k)
    if (sorted[k].first == sorted[k - 1].first) {
      dropped[sorted[k].second] = 1;
      ++report.duplicateFacets;
    }
  std::size_t count = 0;
  for (std::size_t i = 0; i < mesh.facets.size(); ++i)
    if (!dropped[i]) mesh.facets[count++] = mesh.facets[i];
  mesh.facets.resize(count);
}

void orientFacets(TriangleMesh& mesh, SurfaceRepair& report, ClosedPatches whole) {
  const Patches patches = findPatches(mesh.facets);
  std::vector<std::vector<int>> closed;
  std::vector<char> turn(mesh.facets.size(), 0);
  for (std::size_t p = 0; p < patches.facets.size(); ++p) {
    const auto& patch = patches.facets[p];
    if (!patches.oriented[p]) {
      ++report.unorientablePatches;
      continue;
    }
    const auto others = std::count_if(patch.begin(), patch.end(), [&](int f) { return patches.turned[at(f)] != 0; });
    const bool keepFirst = 2 * static_cast<std::size_t>(others) <= patch.size();
    for (const int f : patch) turn[at(f)] = (patches.turned[at(f)] != 0) == keepFirst;
    if (patches.closed[p]) closed.push_back(patch);
  }
  std::vector<Facet> facets = mesh.facets;
  const auto turnAll = [&] {
    for (std::size_t i = 0; i < facets.size(); ++i) {
      facets[i] = mesh.facets[i];
      if (turn[i]) std::swap(facets[i][1], facets[i][2]);
    }
  };
  turnAll();
  if (whole == ClosedPatches::turn) {
    for (const int p : wrongSideOut(mesh.x, facets, closed)) {
      ++report.turnedPatches;
      for (const int f : closed[at(p)]) turn[at(f)] = !turn[at(f)];
    }
    turnAll();
  }
  report.turnedFacets = static_cast<int>(std::count(turn.begin(), turn.end(), 1));
  mesh.facets = std::move(facets);
}

}  // namespace

int weldVertices(TriangleMesh& mesh, double tolerance) {
  requireNonNegative(tolerance, "tolerance of the welding");
  checkVertices(mesh.x);
  checkIndices(mesh.facets, static_cast<int>(mesh.x.size()));
  const std::size_t before = mesh.x.size();
  std::vector<int> target(before);
  std::vector<char> kept(before, 0);
  {
    KeptVertices index(mesh.x, tolerance);
    for (std::size_t v = 0; v < before; ++v) {
      target[v] = index.find(mesh.x[v]);
      if (target[v] >= 0) continue;
      target[v] = static_cast<int>(v);
      kept[v] = 1;
      index.keep(static_cast<int>(v));
    }
  }
  compactVertices(mesh, kept, target);
  return static_cast<int>(before - mesh.x.size());
}

SurfaceRepair repairSurface(TriangleMesh& mesh, double tolerance, ClosedPatches closed) {
  SurfaceRepair report;
  report.weldedVertices = weldVertices(mesh, tolerance);
  dropFacets(mesh, report);
  orientFacets(mesh, report, closed);
  std::vector<char> used(mesh.x.size(), 0);
  for (const Facet& f : mesh.facets)
    for (const int v : f) used[at(v)] = 1;
  std::vector<int> same(mesh.x.size());
  for (std::size_t v = 0; v < same.size(); ++v) same[v] = static_cast<int>(v);
  report.unusedVertices = static_cast<int>(std::count(used.begin(), used.end(), 0));
  compactVertices(mesh, used, same);
  return report;
}

}  // namespace dovetail::geometry
