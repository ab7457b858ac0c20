#include "parent_coordinates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "cell_jacobian.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/shape.hpp"
#include "shapes.hpp"

namespace dovetail::fem::detail {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double parentTolerance = 1e-12;
constexpr double settled = 1e-9;  // the error after a step is the square of it
constexpr double farOff = 10.0;   // parent coordinates from which Newton's method does not come back
constexpr int largestIterations = 30;
constexpr int largestDepth = 45;  // parts of 2⁻⁴⁵ of the cell are round-off
constexpr int largestParts = 20000;

double largest(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

void include(geometry::Box& box, const Vec3& x) {
  for (int c = 0; c < 3; ++c) {
    box.lower[c] = std::min(box.lower[c], x[c]);
    box.upper[c] = std::max(box.upper[c], x[c]);
  }
}

/// A cube in the parent cell.
struct Part {
  Vec3 lower;
  double edge;
  int depth;
};

/// A cell with its first node as the origin, so that round-off is that of its size, not of its place.
class LocalCell {
public:
  LocalCell(ElementShape shape, std::span<const Vec3> nodes, const Vec3& point)
      : shape_(shape),
        count_(nodes.size()),
        simplex_(isTet(shape)),
        plane_(dimensionOf(shape) == 2),
        point_(point - nodes[0]) {
    double size = largest(point);
    for (std::size_t a = 0; a < count_; ++a) {
      node_[a] = nodes[a] - nodes[0];
      size = std::max(size, largest(nodes[a]));
    }
    roundOff_ = 64.0 * epsilon * size;
    if (plane_) point_.z = 0.0;
  }

  Vec3 centre() const { return simplex_ ? Vec3{0.25, 0.25, 0.25} : Vec3{}; }

  /// Newton's method.
  ParentGuess solve(Vec3 xi) {
    if (plane_) xi.z = 0.0;
    for (int iteration = 0; iteration < largestIterations; ++iteration) {
      const Jacobian J = evaluate(xi);
      const std::array<Vec3, 3> dual = {cross(J[1], J[2]), cross(J[2], J[0]), cross(J[0], J[1])};
      const double det = dot(J[0], dual[0]);
      const Vec3 gap = point_ - x_;
      const Vec3 step = Vec3{dot(gap, dual[0]), dot(gap, dual[1]), dot(gap, dual[2])} / det;
      xi += step;
      if (!isFinite(xi) || largest(xi) > farOff) break;
      if (largest(step) > settled) continue;
      const double slope = std::max({norm(dual[0]), norm(dual[1]), norm(dual[2])}) / std::abs(det);
      const bool inside = outsideOf(xi) <= parentTolerance + roundOff_ * slope;
      return {inside ? Verdict::inside : Verdict::outside, xi};
    }
    return {Verdict::unsettled, xi};
  }

  /// The whole cell, or the cube around the tetrahedron.
  Part whole() const { return simplex_ ? Part{{}, 1.0, 0} : Part{{-1, -1, -1}, 2.0, 0}; }

  /// Whether a solution may be in the part. Looks at y = J⁻¹(x − point), J that of the part's centre: as good as ξ less
  /// the solution in small parts.
  bool mayHold(const Part& part) {
    const double half = 0.5 * part.edge;
    const Jacobian J = evaluate(part.lower + Vec3{half, half, half});
    std::array<Vec3, 3> row = {cross(J[1], J[2]), cross(J[2], J[0]), cross(J[0], J[1])};
    const double det = dot(J[0], row[0]);
    for (Vec3& r : row) r = r / det;
    if (!isFinite(row[0]) || !isFinite(row[1]) || !isFinite(row[2])) row = {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double tolerance = parentTolerance + roundOff_ * std::max({norm(row[0]), norm(row[1]), norm(row[2])});
    const std::array<Vec3, 27> x = bezierPoints(part);
    std::array<double, 3> least, most;
    least.fill(INFINITY), most.fill(-INFINITY);
    double leastSum = INFINITY;  // of ξ + η + ζ where y = 0
    for (std::size_t k = 0; k < x.size(); ++k) {
      const Vec3 off = x[k] - point_, xi = place(part, static_cast<int>(k));
      double sum = xi.x + xi.y + xi.z;
      for (std::size_t c = 0; c < 3; ++c) {
        const double y = dot(row[c], off);
        least[c] = std::min(least[c], y), most[c] = std::max(most[c], y);
        sum -= y;
      }
      leastSum = std::min(leastSum, sum);
    }
    for (std::size_t c = 0; c < 3; ++c)
      if (least[c] > tolerance || most[c] < -tolerance) return false;
    return !simplex_ || leastSum <= 1.0 + 3.0 * tolerance;
  }

  geometry::Box boxOf(const Part& part) {
    const std::array<Vec3, 27> x = bezierPoints(part);
    geometry::Box box{x[0], x[0]};
    for (const Vec3& corner : x) include(box, corner);
    return box;
  }

  int partsPerCut() const { return plane_ ? 4 : 8; }

private:
  static Vec3 place(const Part& part, int k) {
    return part.lower + 0.5 * part.edge * Vec3{k % 3 + 0.0, k / 3 % 3 + 0.0, k / 9 + 0.0};
  }

  /// All shapes are of degree 2 at most in each parent coordinate: of the values at three places of a line the Bézier
  /// points are these values and, in the middle, 2 x(½) − ½ (x(0) + x(1)).
  std::array<Vec3, 27> bezierPoints(const Part& part) {
    std::array<Vec3, 27> x;
    for (int k = 0; k < 27; ++k) {
      evaluate(place(part, k));
      x[static_cast<std::size_t>(k)] = x_;
    }
    for (const std::size_t stride : {std::size_t{1}, std::size_t{3}, std::size_t{9}})
      for (std::size_t k = 0; k < 27; ++k)
        if (k / stride % 3 == 1) x[k] = 2.0 * x[k] - 0.5 * (x[k - stride] + x[k + stride]);
    return x;
  }

  /// How far ξ lies outside of the parent cell.
  double outsideOf(const Vec3& xi) const {
    return simplex_ ? std::max({-xi.x, -xi.y, -xi.z, xi.x + xi.y + xi.z - 1.0}) : largest(xi) - 1.0;
  }

  /// ∂x/∂ξ, and x_.
  Jacobian evaluate(const Vec3& xi) {
    shapeFunctions(shape_, xi, std::span(value_).first(count_), std::span(gradient_).first(count_));
    Jacobian J{};
    x_ = {};
    for (std::size_t a = 0; a < count_; ++a) {
      x_ += value_[a] * node_[a];
      for (std::size_t j = 0; j < 3; ++j) J[j] += gradient_[a][static_cast<int>(j)] * node_[a];
    }
    if (plane_) J[2] = {0.0, 0.0, 1.0};
    return J;
  }

  ElementShape shape_;
  std::size_t count_;
  bool simplex_, plane_;
  Vec3 point_;
  double roundOff_ = 0.0;  // m
  std::array<Vec3, maxCellNodes> node_;
  Vec3 x_;
  std::array<double, maxCellNodes> value_;
  std::array<Vec3, maxCellNodes> gradient_;
};

std::string text(const Vec3& x) { return formatNumber(x.x) + ", " + formatNumber(x.y) + ", " + formatNumber(x.z); }

}  // namespace

geometry::Box boxOf(ElementShape shape, std::span<const Vec3> nodes) {
  geometry::Box box{nodes[0], nodes[0]};
  for (const Vec3& x : nodes) include(box, x);
  const auto corners = static_cast<std::size_t>(cornersOf(shape));
  if (nodes.size() == corners) return box;
  if (isTet(shape)) {
    for (std::size_t e = 0; e < edgesOf(shape).size(); ++e) {
      const auto [a, b] = edgesOf(shape)[e];
      include(box, 2.0 * nodes[corners + e] -
                       0.5 * (nodes[static_cast<std::size_t>(a)] + nodes[static_cast<std::size_t>(b)]));
    }
    return box;
  }
  LocalCell cell(shape, nodes, nodes[0]);
  const geometry::Box local = cell.boxOf(cell.whole());
  include(box, nodes[0] + local.lower);
  include(box, nodes[0] + local.upper);
  return box;
}

ParentGuess guessParent(ElementShape shape, std::span<const Vec3> nodes, const Vec3& point) {
  LocalCell cell(shape, nodes, point);
  return cell.solve(cell.centre());
}

std::optional<Vec3> searchParent(ElementShape shape, std::span<const Vec3> nodes, const Vec3& point,
                                 const std::string& name) {
  LocalCell cell(shape, nodes, point);
  std::vector<Part> parts{cell.whole()};
  for (int visited = 0; !parts.empty(); ++visited) {
    const Part part = parts.back();
    parts.pop_back();
    if (!cell.mayHold(part)) continue;
    const double half = 0.5 * part.edge;
    const ParentGuess guess = cell.solve(part.lower + Vec3{half, half, half});
    if (guess.verdict == Verdict::inside) return guess.xi;
    if (part.depth == largestDepth) continue;
    if (visited > largestParts)
      throw NumericalError("it is undecidable whether the point " + text(point) + " m lies within", name,
                           "the element is flat or folded: take a finer mesh or a smaller step");
    for (int k = 0; k < cell.partsPerCut(); ++k)
      parts.push_back({part.lower + half * Vec3{k % 2 + 0.0, k / 2 % 2 + 0.0, k / 4 + 0.0}, half, part.depth + 1});
  }
  return std::nullopt;
}

}  // namespace dovetail::fem::detail
