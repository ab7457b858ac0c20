#include "dovetail/cg/surface_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "dovetail/core/error.hpp"
#include "facet_integral.hpp"
#include "linear_correction.hpp"
#include "sparse_sum.hpp"

namespace dovetail::cg {

namespace {

using Facet = std::array<int, 3>;

/// Supports below this share of the facet collapse onto the centre: there, positions differ by round-off only.
constexpr double collapsedSupport = 1e-12;

struct Surface {
  std::span<const Vec3> vertices;
  std::span<const Facet> facets;
  std::span<const int> patchOfFacet;
  const Projection* localMap;
};

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

double longestEdge(const Surface& surface, int facet) {
  const auto [a, b, c] = surface.facets[facet];
  const auto& x = surface.vertices;
  return std::max({norm(x[b] - x[a]), norm(x[c] - x[b]), norm(x[a] - x[c])});
}

struct Ball {
  Vec3 centre;
  double radius;
};
Ball boundingBall(const Surface& surface, int facet) {
  const auto [a, b, c] = surface.facets[facet];
  const auto& x = surface.vertices;
  const Vec3 centre = (1.0 / 3.0) * (x[a] + x[b] + x[c]);
  return {centre,
          std::sqrt(std::max({squaredNorm(x[a] - centre), squaredNorm(x[b] - centre), squaredNorm(x[c] - centre)}))};
}

bool meets(const Ball& ball, const Vec3& centre, double width) {
  // A little more than exact, so that round-off drops no facet; the integrator drops the rest.
  const double reach = (1.0 + 1e-9) * (ball.radius + width);
  return squaredNorm(ball.centre - centre) <= reach * reach;
}

Vec3 centrePoint(const Surface& surface, int facet, const std::array<double, 3>& barycentric) {
  const Facet& v = surface.facets[facet];
  return barycentric[0] * surface.vertices[v[0]] + barycentric[1] * surface.vertices[v[1]] +
         barycentric[2] * surface.vertices[v[2]];
}

bool isLocal(const SurfaceKernel& kernel, const Surface& surface, int facet) {
  return kernel.kernel.width <= collapsedSupport * longestEdge(surface, facet);
}

/// Turns the facets near a centre into one row.
class RowBuilder {
public:
  RowBuilder(const SurfaceKernel& kernel, const Surface& surface)
      : kernel_(kernel),
        surface_(surface),
        integrator_(kernel.kernel),
        vertexSum_(surface.vertices.size()),
        nodeSum_(static_cast<std::size_t>(surface.localMap->columns)) {}

  void append(int facet, const std::array<double, 3>& barycentric, std::span<const int> candidates,
              std::vector<int>& column, std::vector<double>& weight) {
    integrate(facet, barycentric, candidates);
    if (kernel_.correction == KernelCorrection::linear)
      sumCorrected();
    else
      sumPlain();
    for (int v : vertexSum_.items())
      for (int k = surface_.localMap->offsets[v]; k < surface_.localMap->offsets[v + 1]; ++k)
        nodeSum_.add(surface_.localMap->column[k], vertexSum_[v] * surface_.localMap->weight[k]);
    vertexSum_.clear();
    if (!nodeSum_.appendNormalised(column, weight))
      localRow(*surface_.localMap, surface_.facets[facet], barycentric, column, weight);
  }

private:
  struct Part {
    int facet;
    std::array<Vec3, 3> corner;  ///< relative to the centre, m
    FacetIntegral integral;
  };

  void integrate(int facet, const std::array<double, 3>& barycentric, std::span<const int> candidates) {
    const auto& x = surface_.vertices;
    // Offsets are taken from a corner of the facet, so that tiny supports far from the origin keep their digits.
    const Vec3& origin = x[surface_.facets[facet][0]];
    const Vec3 centre = barycentric[1] * (x[surface_.facets[facet][1]] - origin) +
                        barycentric[2] * (x[surface_.facets[facet][2]] - origin);
    parts_.clear();
    for (int f : candidates) {
      Part part{f, {}, {}};
      for (int k = 0; k < 3; ++k) part.corner[k] = (x[surface_.facets[f][k]] - origin) - centre;
      part.integral = integrator_.integrate(part.corner);
      if (part.integral.w > 0.0) parts_.push_back(part);
    }
  }

  void sumPlain() {
    for (const Part& part : parts_) {
      const auto first = part.integral.first();
      for (int k = 0; k < 3; ++k) vertexSum_.add(surface_.facets[part.facet][k], first[k]);
    }
  }

  void sumCorrected() {
    PointMoments moments;
    for (const Part& part : parts_) addMoments(part, moments);
    const LinearFactor factor = moments.sum > 0.0 ? linearFactor(moments) : LinearFactor{};
    for (const Part& part : parts_) {
      const auto second = part.integral.second();
      std::array<double, 3> at{};
      for (int l = 0; l < 3; ++l) at[l] = factor.at(part.corner[l]);
      for (int k = 0; k < 3; ++k)
        vertexSum_.add(surface_.facets[part.facet][k],
                       second[k][0] * at[0] + second[k][1] * at[1] + second[k][2] * at[2]);
    }
  }

  static void addMoments(const Part& part, PointMoments& moments) {
    Eigen::Matrix3d d;
    for (int k = 0; k < 3; ++k) d.col(k) << part.corner[k].x, part.corner[k].y, part.corner[k].z;
    const auto first = part.integral.first();
    const auto second = part.integral.second();
    Eigen::Matrix3d s;
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) s(k, l) = second[k][l];
    moments.sum += part.integral.w;
    moments.first += d * Eigen::Vector3d(first[0], first[1], first[2]);
    moments.second += d * s * d.transpose();
  }

  SurfaceKernel kernel_;
  Surface surface_;
  FacetIntegrator integrator_;
  SparseSum vertexSum_, nodeSum_;
  std::vector<Part> parts_;
};

}  // namespace

void localRow(const Projection& localMap, const Facet& vertex, const std::array<double, 3>& barycentric,
              std::vector<int>& column, std::vector<double>& weight) {
  const std::size_t begin = column.size();
  for (int k = 0; k < 3; ++k)
    for (int m = localMap.offsets[vertex[k]]; m < localMap.offsets[vertex[k] + 1]; ++m) {
      const auto at =
          std::lower_bound(column.begin() + static_cast<std::ptrdiff_t>(begin), column.end(), localMap.column[m]);
      const auto place = weight.begin() + (at - column.begin());
      const double share = barycentric[k] * localMap.weight[m];
      if (at != column.end() && *at == localMap.column[m]) {
        *place += share;
      } else {
        weight.insert(place, share);
        column.insert(at, localMap.column[m]);
      }
    }
}

void surfaceKernelRow(const SurfaceKernel& kernel, std::span<const Vec3> vertices, std::span<const Facet> facets,
                      std::span<const int> patchOfFacet, const Projection& localMap, int facet,
                      std::array<double, 3> barycentric, std::vector<int>& column, std::vector<double>& weight) {
  const Surface surface{vertices, facets, patchOfFacet, &localMap};
  requireValid(kernel.kernel, true);
  requireMatching(surface);
  requireCentre(surface, facet, barycentric);
  if (isLocal(kernel, surface, facet)) return localRow(localMap, facets[facet], barycentric, column, weight);
  const Vec3 centre = centrePoint(surface, facet, barycentric);
  std::vector<int> candidates;
  for (int f = 0; f < static_cast<int>(facets.size()); ++f)
    if (patchOfFacet[f] == patchOfFacet[facet] && meets(boundingBall(surface, f), centre, kernel.kernel.width))
      candidates.push_back(f);
  RowBuilder(kernel, surface).append(facet, barycentric, candidates, column, weight);
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
  requireValid(kernel.kernel, true);
  requireMatching(surface);
  cache_ = std::make_unique<Cache>(kernel, surface);
  cache_->sortFacets();
}
SurfaceKernelRows::~SurfaceKernelRows() = default;
SurfaceKernelRows::SurfaceKernelRows(SurfaceKernelRows&&) noexcept = default;
SurfaceKernelRows& SurfaceKernelRows::operator=(SurfaceKernelRows&&) noexcept = default;

void SurfaceKernelRows::row(int facet, const std::array<double, 3>& barycentric, std::vector<int>& column,
                            std::vector<double>& weight) {
  Cache& cache = *cache_;
  requireCentre(cache.surface, facet, barycentric);
  if (isLocal(cache.kernel, cache.surface, facet))
    return localRow(*cache.surface.localMap, cache.surface.facets[facet], barycentric, column, weight);
  cache.findCandidates(facet, centrePoint(cache.surface, facet, barycentric));
  cache.builder.append(facet, barycentric, cache.candidates, column, weight);
}

}  // namespace dovetail::cg
