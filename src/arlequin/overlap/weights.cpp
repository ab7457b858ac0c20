#include "dovetail/arlequin/weights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "dovetail/arlequin/cells.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/shape.hpp"
#include "dovetail/geometry/triangle.hpp"

namespace dovetail::arlequin {

double profile(WeightProfile shape, double s) {
  if (s <= 0.0) return 1.0;
  if (s >= 1.0) return 0.0;
  switch (shape) {
    case WeightProfile::halfCosine:
      return 0.5 * (1.0 + std::cos(std::numbers::pi * s));
    case WeightProfile::linear:
      return 1.0 - s;
    case WeightProfile::smooth:
      return 1.0 - s * s * s * (10.0 - s * (15.0 - 6.0 * s));
  }
  return 0.0;
}

double profileSlope(WeightProfile shape, double s) {
  if (s <= 0.0 || s >= 1.0) return 0.0;
  switch (shape) {
    case WeightProfile::halfCosine:
      return -0.5 * std::numbers::pi * std::sin(std::numbers::pi * s);
    case WeightProfile::linear:
      return -1.0;
    case WeightProfile::smooth:
      return -30.0 * s * s * (1.0 - s) * (1.0 - s);
  }
  return 0.0;
}

void validate(const WeightOptions& options) {
  if (!(options.floor >= 0.0 && options.floor < 0.5))
    throw InputError("the weight floor is " + formatNumber(options.floor), "weight floor",
                     "give a number from 0 to below 0.5; 1e-3 serves well");
}

std::vector<double> nodalWeights(std::span<const double> s, const WeightOptions& options) {
  validate(options);
  std::vector<double> weight(s.size());
  for (std::size_t n = 0; n < s.size(); ++n) {
    if (std::isnan(s[n]))
      throw InputError("s of node " + std::to_string(n) + " is not a number", "nodalWeights",
                       "give its place in the overlap, or beyondOverlap");
    weight[n] = s[n] > 1.0 ? 0.0 : options.floor + (1.0 - 2.0 * options.floor) * profile(options.profile, s[n]);
  }
  return weight;
}

void levelMidNodes(const fem::SolidMesh& mesh, std::span<double> weight) {
  for (int e = 0; e < static_cast<int>(mesh.elementCount()); ++e) {
    const Cell cell = cellOf(mesh, e);
    const std::span<const Vec3> place = fem::parentNodes(cell.shape);
    for (std::size_t a = cell.corner().size(); a < cell.node.size(); ++a) {
      const std::vector<double> vertexShape = vertexShapes(cell.shape, place[a]);
      double mean = 0.0;
      for (std::size_t c = 0; c < vertexShape.size(); ++c)
        mean += vertexShape[c] * weight[static_cast<std::size_t>(cell.node[c])];
      weight[static_cast<std::size_t>(cell.node[a])] = mean;
    }
  }
}

std::vector<Triangle> triangles(std::span<const Vec3> X, std::span<const fem::Face> faces) {
  std::vector<Triangle> result;
  for (const fem::Face& face : faces) {
    const auto corner = [&](std::size_t k) { return X[static_cast<std::size_t>(face.node[k])]; };
    result.push_back({corner(0), corner(1), corner(2)});
    if (cornersOf(face.shape) == 4) result.push_back({corner(0), corner(2), corner(3)});
  }
  return result;
}

namespace {

double distanceTo(const Vec3& point, std::span<const Triangle> border) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : border)
    nearest = std::min(nearest, squaredNorm(geometry::closestPointOnTriangle(point, t[0], t[1], t[2]).point - point));
  return std::sqrt(nearest);
}

}  // namespace

std::vector<double> distanceCoordinate(std::span<const Vec3> points, std::span<const Triangle> solidBorder,
                                       std::span<const Triangle> particleBorder) {
  if (solidBorder.empty() || particleBorder.empty())
    throw InputError(std::string("the border of the ") + (solidBorder.empty() ? "solid" : "particles") + " is empty",
                     "distanceCoordinate", "give at least one triangle");
  std::vector<double> s(points.size());
  for (std::size_t n = 0; n < points.size(); ++n) {
    const double solid = distanceTo(points[n], solidBorder), particles = distanceTo(points[n], particleBorder);
    if (!(solid + particles > 0.0))
      throw InputError("point " + std::to_string(n) + " lies on both borders", "distanceCoordinate",
                       "keep the borders apart: the overlap needs a width");
    s[n] = solid / (solid + particles);
  }
  return s;
}

namespace {

/// A side of both boxes; outwards is the direction of sign.
struct Side {
  int axis;
  double sign, inner, outer;  // m
  bool isOpen() const { return inner == outer; }
  double coordinate(const Vec3& x) const { return (x[axis] - inner) / (outer - inner); }
};

std::vector<Side> sidesOf(const geometry::Box& solidBorder, const geometry::Box& particleBorder) {
  std::vector<Side> sides;
  for (int axis = 0; axis < 3; ++axis) {
    sides.push_back({axis, -1.0, solidBorder.lower[axis], particleBorder.lower[axis]});
    sides.push_back({axis, 1.0, solidBorder.upper[axis], particleBorder.upper[axis]});
  }
  for (const Side& side : sides)
    if (!(side.sign * (side.outer - side.inner) >= 0.0))
      throw InputError(
          std::string("along ") + "xyz"[side.axis] + " the box of the solid reaches to " + formatNumber(side.inner) +
              " m and that of the particles to " + formatNumber(side.outer) + " m",
          "box of an overlap", "the box at which the particles end lies around that at which the solid does");
  if (std::ranges::all_of(sides, &Side::isOpen))
    throw InputError("the two boxes of an overlap coincide", "", "move them apart");
  return sides;
}

void requireWithin(std::span<const Vec3> points, const Side& side) {
  const double margin = 1e-9 * std::max(1.0, std::abs(side.inner));
  for (const Vec3& x : points)
    if (side.sign * (x[side.axis] - side.inner) > margin)
      throw InputError(std::string("both boxes of the overlap end at ") + "xyz"[side.axis] + " = " +
                           formatNumber(side.inner) + " m, and the solid goes on to " + formatNumber(x[side.axis]) +
                           " m",
                       "", "let both reach beyond the solid there, or move them apart");
}

}  // namespace

std::vector<double> boxCoordinate(std::span<const Vec3> points, const geometry::Box& solidBorder,
                                  const geometry::Box& particleBorder) {
  std::vector<Side> sides = sidesOf(solidBorder, particleBorder);
  for (const Side& side : sides)
    if (side.isOpen()) requireWithin(points, side);
  std::erase_if(sides, [](const Side& side) { return side.isOpen(); });
  std::vector<double> s;
  for (const Vec3& x : points) {
    s.push_back(-std::numeric_limits<double>::infinity());
    for (const Side& side : sides) s.back() = std::max(s.back(), side.coordinate(x));
  }
  return s;
}

}  // namespace dovetail::arlequin
