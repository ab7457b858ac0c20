// One row of kernel weights from the facets near its centre.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "dovetail/cg/surface_kernel.hpp"
#include "facet_integral.hpp"
#include "linear_correction.hpp"
#include "sparse_sum.hpp"

namespace dovetail::cg {

using Facet = std::array<int, 3>;

/// Supports below this fraction of the facet collapse onto the centre: there, positions differ by round-off only.
inline constexpr double collapsedSupport = 1e-12;

/// What a kernel lives on.
struct Surface {
  std::span<const Vec3> vertices;
  std::span<const Facet> facets;
  std::span<const int> patchOfFacet;
  const Projection* localMap;
};

inline double longestEdge(const Surface& surface, int facet) {
  const auto [a, b, c] = surface.facets[facet];
  const auto& x = surface.vertices;
  return std::max({norm(x[b] - x[a]), norm(x[c] - x[b]), norm(x[a] - x[c])});
}

struct Ball {
  Vec3 centre;
  double radius;
};
inline Ball boundingBall(const Surface& surface, int facet) {
  const auto [a, b, c] = surface.facets[facet];
  const auto& x = surface.vertices;
  const Vec3 centre = (1.0 / 3.0) * (x[a] + x[b] + x[c]);
  return {centre,
          std::sqrt(std::max({squaredNorm(x[a] - centre), squaredNorm(x[b] - centre), squaredNorm(x[c] - centre)}))};
}

inline bool meets(const Ball& ball, const Vec3& centre, double width) {
  // A little more than exact, so that round-off drops no facet; the integrator drops the rest.
  const double reach = (1.0 + 1e-9) * (ball.radius + width);
  return squaredNorm(ball.centre - centre) <= reach * reach;
}

inline Vec3 centrePoint(const Surface& surface, int facet, const std::array<double, 3>& barycentric) {
  const Facet& v = surface.facets[facet];
  return barycentric[0] * surface.vertices[v[0]] + barycentric[1] * surface.vertices[v[1]] +
         barycentric[2] * surface.vertices[v[2]];
}

inline bool isLocal(const SurfaceKernel& kernel, const Surface& surface, int facet) {
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

  /// Adds the kernel around a point of a facet, moved by `offset` (m).
  void add(int facet, const std::array<double, 3>& barycentric, const Vec3& offset, std::span<const int> candidates) {
    integrate(facet, barycentric, offset, candidates);
    if (kernel_.correction == KernelCorrection::linear)
      sumCorrected();
    else
      sumPlain();
  }

  /// Appends the row of what was added, which must be around images of the given point.
  void append(int facet, const std::array<double, 3>& barycentric, std::vector<int>& column,
              std::vector<double>& weight) {
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

  void integrate(int facet, const std::array<double, 3>& barycentric, const Vec3& offset,
                 std::span<const int> candidates) {
    const auto& x = surface_.vertices;
    // Offsets are taken from a corner of the facet, so that tiny supports far from the origin keep their digits.
    const Vec3& origin = x[surface_.facets[facet][0]];
    const Vec3 centre = barycentric[1] * (x[surface_.facets[facet][1]] - origin) +
                        barycentric[2] * (x[surface_.facets[facet][2]] - origin) + offset;
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

}  // namespace dovetail::cg
