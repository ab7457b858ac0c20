#include "dovetail/cg/surface_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "dovetail/core/error.hpp"
#include "surface_kernel_row.hpp"

namespace dovetail::cg {

namespace {

void requireMatching(const Surface& surface) {
  if (surface.patchOfFacet.size() != surface.facets.size())
    throw InputError("there are " + std::to_string(surface.facets.size()) + " facets and " +
                         std::to_string(surface.patchOfFacet.size()) + " patch numbers",
                     "surface kernel", "give one patch per facet");
  if (static_cast<std::size_t>(surface.localMap->rows()) != surface.vertices.size())
    throw InputError("there are " + std::to_string(surface.vertices.size()) + " vertices and " +
                         std::to_string(surface.localMap->rows()) + " rows in the local map",
                     "surface kernel", "give one row per vertex");
}

void requireCentre(const Surface& surface, int facet, const std::array<double, 3>& barycentric) {
  if (facet < 0 || facet >= static_cast<int>(surface.facets.size()))
    throw InputError("facet " + std::to_string(facet) + " does not exist", "surface kernel",
                     "use facets from 0 to " + std::to_string(surface.facets.size() - 1));
  if (!std::isfinite(barycentric[0] + barycentric[1] + barycentric[2]))
    throw InputError("the barycentric weights are not finite", "surface kernel, facet " + std::to_string(facet),
                     "give three finite weights that sum to one");
}

}  // namespace

void requireRowwise(const SurfaceKernel& kernel) {
  requireValid(kernel.kernel, true);
  if (kernel.correction == KernelCorrection::symmetric)
    throw InputError("the symmetric correction needs the whole surface at once", "surface kernel",
                     "take symmetricKernelMap, or no or linear correction");
}

void localRow(const Projection& localMap, const Facet& vertex, const std::array<double, 3>& barycentric,
              std::vector<int>& column, std::vector<double>& weight) {
  const std::size_t begin = column.size();
  for (int k = 0; k < 3; ++k)
    for (int m = localMap.offsets[vertex[k]]; m < localMap.offsets[vertex[k] + 1]; ++m) {
      const auto at =
          std::lower_bound(column.begin() + static_cast<std::ptrdiff_t>(begin), column.end(), localMap.column[m]);
      const auto place = weight.begin() + (at - column.begin());
      const double fraction = barycentric[k] * localMap.weight[m];
      if (at != column.end() && *at == localMap.column[m]) {
        *place += fraction;
      } else {
        weight.insert(place, fraction);
        column.insert(at, localMap.column[m]);
      }
    }
}

void surfaceKernelRow(const SurfaceKernel& kernel, std::span<const Vec3> vertices, std::span<const Facet> facets,
                      std::span<const int> patchOfFacet, const Projection& localMap, int facet,
                      std::array<double, 3> barycentric, std::vector<int>& column, std::vector<double>& weight) {
  const Surface surface{vertices, facets, patchOfFacet, &localMap};
  requireRowwise(kernel);
  requireMatching(surface);
  requireCentre(surface, facet, barycentric);
  if (isLocal(kernel, surface, facet)) return localRow(localMap, facets[facet], barycentric, column, weight);
  const Vec3 centre = centrePoint(surface, facet, barycentric);
  std::vector<int> candidates;
  for (int f = 0; f < static_cast<int>(facets.size()); ++f)
    if (patchOfFacet[f] == patchOfFacet[facet] && meets(boundingBall(surface, f), centre, kernel.kernel.width))
      candidates.push_back(f);
  RowBuilder builder(kernel, surface);
  builder.add(facet, barycentric, {}, candidates);
  builder.append(facet, barycentric, column, weight);
}

struct SurfaceKernelRows::Cache {
  Cache(const SurfaceKernel& kernelIn, const Surface& surfaceIn)
      : kernel(kernelIn), surface(surfaceIn), builder(kernelIn, surfaceIn) {}

  SurfaceKernel kernel;
  Surface surface;
  RowBuilder builder;
  int axis = 0;                 ///< in which the surface extends farthest
  double largestRadius = 0.0;   ///< of the balls, m
  std::vector<Ball> balls;      ///< per facet
  std::vector<int> order;       ///< facets by patch, then by place along the axis
  std::vector<int> candidates;  ///< scratch

  void sortFacets();
  void findCandidates(int facet, const Vec3& centre);
};

void SurfaceKernelRows::Cache::sortFacets() {
  Vec3 lower, upper;
  for (std::size_t v = 0; v < surface.vertices.size(); ++v)
    for (int c = 0; c < 3; ++c) {
      const double x = surface.vertices[v][c];
      lower[c] = v == 0 ? x : std::min(lower[c], x);
      upper[c] = v == 0 ? x : std::max(upper[c], x);
    }
  for (int c = 1; c < 3; ++c)
    if (upper[c] - lower[c] > upper[axis] - lower[axis]) axis = c;
  for (int f = 0; f < static_cast<int>(surface.facets.size()); ++f) {
    balls.push_back(boundingBall(surface, f));
    largestRadius = std::max(largestRadius, balls.back().radius);
  }
  order.resize(surface.facets.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    if (surface.patchOfFacet[a] != surface.patchOfFacet[b]) return surface.patchOfFacet[a] < surface.patchOfFacet[b];
    if (balls[a].centre[axis] != balls[b].centre[axis]) return balls[a].centre[axis] < balls[b].centre[axis];
    return a < b;
  });
}

void SurfaceKernelRows::Cache::findCandidates(int facet, const Vec3& centre) {
  const double width = kernel.kernel.width;
  const double reach = (1.0 + 1e-8) * (width + largestRadius);
  const int patch = surface.patchOfFacet[facet];
  const auto before = [&](int f, double place) {
    return surface.patchOfFacet[f] != patch ? surface.patchOfFacet[f] < patch : balls[f].centre[axis] < place;
  };
  candidates.clear();
  for (auto at = std::lower_bound(order.begin(), order.end(), centre[axis] - reach, before);
       at != order.end() && surface.patchOfFacet[*at] == patch && balls[*at].centre[axis] <= centre[axis] + reach; ++at)
    if (meets(balls[*at], centre, width)) candidates.push_back(*at);
  std::sort(candidates.begin(), candidates.end());
}

SurfaceKernelRows::SurfaceKernelRows(const SurfaceKernel& kernel, std::span<const Vec3> vertices,
                                     std::span<const Facet> facets, std::span<const int> patchOfFacet,
                                     const Projection& localMap) {
  const Surface surface{vertices, facets, patchOfFacet, &localMap};
  requireRowwise(kernel);
  requireMatching(surface);
  cache_ = std::make_unique<Cache>(kernel, surface);
  cache_->sortFacets();
}
SurfaceKernelRows::~SurfaceKernelRows() = default;
SurfaceKernelRows::SurfaceKernelRows(SurfaceKernelRows&&) noexcept = default;
SurfaceKernelRows& SurfaceKernelRows::operator=(SurfaceKernelRows&&) noexcept = default;

void SurfaceKernelRows::row(int facet, const std::array<double, 3>& barycentric, std::vector<int>& column,
                            std::vector<double>& weight) {
  const Vec3 itself;
  row(facet, barycentric, {&itself, 1}, column, weight);
}

void SurfaceKernelRows::row(int facet, const std::array<double, 3>& barycentric, std::span<const Vec3> images,
                            std::vector<int>& column, std::vector<double>& weight) {
  Cache& cache = *cache_;
  requireCentre(cache.surface, facet, barycentric);
  if (isLocal(cache.kernel, cache.surface, facet))
    return localRow(*cache.surface.localMap, cache.surface.facets[facet], barycentric, column, weight);
  const Vec3 centre = centrePoint(cache.surface, facet, barycentric);
  for (const Vec3& offset : images) {
    cache.findCandidates(facet, centre + offset);
    cache.builder.add(facet, barycentric, offset, cache.candidates);
  }
  cache.builder.append(facet, barycentric, column, weight);
}

}  // namespace dovetail::cg
