#include "dovetail/cg/surface_quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "linear_correction.hpp"
#include "sparse_sum.hpp"

namespace dovetail::cg {

namespace {

void requireMatching(const SurfacePoints& points) {
  const std::size_t n = points.X.size();
  if (points.weight.size() != n || points.patch.size() != n || static_cast<std::size_t>(points.shape.rows()) != n)
    throw InputError("the arrays of " + std::to_string(n) + " quadrature points differ in length", "surface quadrature",
                     "give one weight, patch and row of shape functions per point");
  requireValid(points.shape);
  for (std::size_t q = 0; q < n; ++q) {
    if (!isFinite(points.X[q]))
      throw InputError("the position is not finite", "quadrature point " + std::to_string(q), "repair the mesh");
    requirePositive(points.weight[q], "weight of quadrature point " + std::to_string(q));
  }
}

/// Shape functions of the bilinear quadrilateral and their derivatives at (ξ, η) in [−1, 1]².
struct Bilinear {
  std::array<double, 4> value, dXi, dEta;
  Bilinear(double xi, double eta)
      : value{0.25 * (1 - xi) * (1 - eta), 0.25 * (1 + xi) * (1 - eta), 0.25 * (1 + xi) * (1 + eta),
              0.25 * (1 - xi) * (1 + eta)},
        dXi{-0.25 * (1 - eta), 0.25 * (1 - eta), 0.25 * (1 + eta), -0.25 * (1 + eta)},
        dEta{-0.25 * (1 - xi), -0.25 * (1 + xi), 0.25 * (1 + xi), 0.25 * (1 - xi)} {}
};

}  // namespace

SurfacePoints gaussPointsOnQuads(std::span<const Vec3> X, std::span<const std::array<int, 4>> quads,
                                 std::span<const int> patchOfQuad) {
  if (quads.size() != patchOfQuad.size())
    throw InputError("there are " + std::to_string(quads.size()) + " faces and " + std::to_string(patchOfQuad.size()) +
                         " patch numbers",
                     "surface quadrature", "give one patch per face");
  const double g = 1.0 / std::sqrt(3.0);
  SurfacePoints points;
  std::vector<ProjectionRow> rows;
  for (std::size_t f = 0; f < quads.size(); ++f) {
    for (int node : quads[f])
      if (node < 0 || node >= static_cast<int>(X.size()))
        throw InputError("node " + std::to_string(node) + " does not exist", "face " + std::to_string(f),
                         "use node numbers from 0 to " + std::to_string(X.size() - 1));
    for (const auto& [xi, eta] : {std::pair{-g, -g}, std::pair{g, -g}, std::pair{g, g}, std::pair{-g, g}}) {
      const Bilinear shape(xi, eta);
      Vec3 position, tangent1, tangent2;
      ProjectionRow row;
      for (int k = 0; k < 4; ++k) {
        position += shape.value[k] * X[quads[f][k]];
        tangent1 += shape.dXi[k] * X[quads[f][k]];
        tangent2 += shape.dEta[k] * X[quads[f][k]];
        row.emplace_back(quads[f][k], shape.value[k]);
      }
      points.X.push_back(position);
      points.weight.push_back(norm(cross(tangent1, tangent2)));
      points.patch.push_back(patchOfQuad[f]);
      rows.push_back(std::move(row));
    }
  }
  points.shape = fromRows(static_cast<int>(X.size()), rows);
  return points;
}

struct SurfaceKernelQuadrature::Scratch {
  std::vector<int> hit;           ///< points within the width
  std::vector<double> hitWeight;  ///< w_q W of each
  SparseSum nodeSum;
};

SurfaceKernelQuadrature::SurfaceKernelQuadrature(const SurfaceKernel& kernel, SurfacePoints points)
    : kernel_(kernel), points_(std::move(points)) {
  requireRowwise(kernel);
  requireMatching(points_);
  scratch_ = std::make_unique<Scratch>();
  scratch_->nodeSum = SparseSum(static_cast<std::size_t>(points_.shape.columns));
}
SurfaceKernelQuadrature::~SurfaceKernelQuadrature() = default;
SurfaceKernelQuadrature::SurfaceKernelQuadrature(SurfaceKernelQuadrature&&) noexcept = default;
SurfaceKernelQuadrature& SurfaceKernelQuadrature::operator=(SurfaceKernelQuadrature&&) noexcept = default;

bool SurfaceKernelQuadrature::row(const Vec3& centre, int patch, std::span<const int> localColumn,
                                  std::span<const double> localWeight, std::vector<int>& column,
                                  std::vector<double>& weight) {
  Scratch& s = *scratch_;
  const double width = kernel_.kernel.width;
  const bool corrected = kernel_.correction == KernelCorrection::linear;
  s.hit.clear();
  s.hitWeight.clear();
  PointMoments moments;
  for (int q = 0; q < static_cast<int>(points_.X.size()); ++q) {
    const Vec3 d = points_.X[q] - centre;
    const double distance2 = squaredNorm(d);
    if (points_.patch[q] != patch || !(distance2 < width * width)) continue;
    s.hit.push_back(q);
    s.hitWeight.push_back(points_.weight[q] * profile(kernel_.kernel.shape, std::sqrt(distance2) / width));
    if (corrected) moments.add(s.hitWeight.back(), d);
  }
  const LinearFactor factor = corrected && moments.sum > 0.0 ? linearFactor(moments) : LinearFactor{};
  for (std::size_t h = 0; h < s.hit.size(); ++h) {
    const int q = s.hit[h];
    const double w = corrected ? s.hitWeight[h] * factor.at(points_.X[q] - centre) : s.hitWeight[h];
    for (int k = points_.shape.offsets[q]; k < points_.shape.offsets[q + 1]; ++k)
      s.nodeSum.add(points_.shape.column[k], w * points_.shape.weight[k]);
  }
  if (s.nodeSum.appendNormalised(column, weight)) return true;
  column.insert(column.end(), localColumn.begin(), localColumn.end());
  weight.insert(weight.end(), localWeight.begin(), localWeight.end());
  return false;
}

}  // namespace dovetail::cg
