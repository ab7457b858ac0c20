#include "dovetail/fem/mesh/mesh_quality.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <ostream>

#include "cell_jacobian.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "shapes.hpp"

namespace dovetail::fem {

namespace {

double product(const Vec3& a, const Vec3& b, const Vec3& c) { return norm(a) * norm(b) * norm(c); }

double scaledDeterminant(ElementShape shape, const detail::Jacobian& J) {
  const auto& [a, b, c] = J;
  const bool brick = !detail::isTet(shape);
  const double lengths =
      brick
          ? product(a, b, c)
          : std::max({product(a, b, c), product(a, b - a, c - a), product(b, b - a, c - b), product(c, c - a, c - b)});
  if (!(lengths > 0.0)) return 0.0;
  return (brick ? 1.0 : std::sqrt(2.0)) * detail::determinant(J) / lengths;
}

struct Element {
  ElementShape shape;
  std::span<const int> nodes;
  std::span<const Vec3> X;
  Vec3 depth;
  const Vec3& corner(int a) const { return X[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])]; }
};

double leastScaledJacobian(const Element& element) {
  const std::vector<Vec3>& gradients = detail::nodalGradients(element.shape);
  double least = 1.0;
  for (std::size_t b = 0; b < element.nodes.size(); ++b) {
    const auto gradient = std::span(gradients).subspan(b * element.nodes.size(), element.nodes.size());
    least = std::min(
        least, scaledDeterminant(element.shape, detail::jacobianAt(element.X, element.nodes, gradient, element.depth)));
  }
  return least;
}

double inscribedRadius(const Element& tet) {
  const Vec3 &p = tet.corner(0), a = tet.corner(1) - p, b = tet.corner(2) - p, c = tet.corner(3) - p;
  const double twiceArea = norm(cross(a, b)) + norm(cross(b, c)) + norm(cross(c, a)) + norm(cross(b - a, c - a));
  return std::abs(dot(a, cross(b, c))) / twiceArea;
}

double aspect(const Element& element) {
  double longest = 0.0, shortest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : edgesOf(element.shape)) {
    const double length = norm(element.corner(a) - element.corner(b));
    longest = std::max(longest, length);
    shortest = std::min(shortest, length);
  }
  if (!detail::isTet(element.shape)) return longest / shortest;
  return longest / inscribedRadius(element) / (2.0 * std::sqrt(6.0));
}

double volume(const Element& element) {
  const detail::CellRule& rule = detail::massRule(element.shape);
  const std::size_t n = element.nodes.size();
  double sum = 0.0;
  for (std::size_t q = 0; q < rule.weight.size(); ++q)
    sum += rule.weight[q] * detail::determinant(detail::jacobianAt(
                                element.X, element.nodes, std::span(rule.gradient).subspan(n * q, n), element.depth));
  return sum;
}

void add(ShapeQuality& all, const ElementQuality& one) {
  const bool first = all.elements++ == 0;
  all.volume += one.volume;
  all.worstJacobian = first ? one.scaledJacobian : std::min(all.worstJacobian, one.scaledJacobian);
  all.worstAspect = first ? one.aspect : std::max(all.worstAspect, one.aspect);
  all.meanJacobian += one.scaledJacobian;
  all.meanAspect += one.aspect;
  const double tenth = std::ceil(10.0 * one.scaledJacobian - 1e-12);
  ++all.histogram[static_cast<std::size_t>(std::clamp(tenth, 0.0, 10.0))];
}

}  // namespace

MeshQuality measureQuality(const SolidMesh& mesh, std::size_t worst) {
  MeshQuality quality;
  std::array<ShapeQuality, allCellShapes.size()> shapes{};
  for (const ElementGroup& group : mesh.groups) {
    const auto n = static_cast<std::size_t>(nodesOf(group.shape));
    ShapeQuality& all = shapes[static_cast<std::size_t>(group.shape)];
    all.shape = group.shape;
    for (std::size_t e = 0; e < group.size(); ++e) {
      const Element element{group.shape, std::span(group.node).subspan(n * e, n), mesh.X,
                            detail::depthOf(group.shape, mesh.thickness)};
      for (const int node : element.nodes)
        if (node < 0 || static_cast<std::size_t>(node) >= mesh.X.size())
          throw InputError("node " + std::to_string(node) + " does not exist",
                           "element " + std::to_string(quality.element.size()),
                           "use 0 to " + std::to_string(static_cast<long>(mesh.X.size()) - 1));
      add(all,
          quality.element.emplace_back(ElementQuality{leastScaledJacobian(element), aspect(element), volume(element)}));
    }
  }
  for (ShapeQuality& all : shapes) {
    if (all.elements == 0) continue;
    all.meanJacobian /= static_cast<double>(all.elements);
    all.meanAspect /= static_cast<double>(all.elements);
    quality.shapes.push_back(all);
  }
  quality.worst.resize(quality.element.size());
  std::iota(quality.worst.begin(), quality.worst.end(), 0);
  const auto jacobian = [&](int e) { return quality.element[static_cast<std::size_t>(e)].scaledJacobian; };
  std::stable_sort(quality.worst.begin(), quality.worst.end(), [&](int a, int b) { return jacobian(a) < jacobian(b); });
  quality.worst.resize(std::min(worst, quality.worst.size()));
  return quality;
}

void print(std::ostream& out, const MeshQuality& quality) {
  const auto precision = out.precision(4);
  out << "shape  elements   volume, m3   scaled Jacobian: least  mean   aspect: largest  mean\n";
  for (const ShapeQuality& s : quality.shapes) {
    out << std::left << std::setw(6) << name(s.shape) << std::right << std::setw(9) << s.elements << std::setw(13)
        << s.volume << std::setw(24) << s.worstJacobian << std::setw(7) << s.meanJacobian << std::setw(17)
        << s.worstAspect << std::setw(7) << s.meanAspect << "\n  scaled Jacobian, <= 0 and tenths to 1:";
    for (const std::size_t count : s.histogram) out << ' ' << count;
    out << '\n';
  }
  out << "worst elements (scaled Jacobian):";
  for (const int e : quality.worst)
    out << ' ' << e << " (" << quality.element[static_cast<std::size_t>(e)].scaledJacobian << ')';
  out << '\n';
  out.precision(precision);
}

}  // namespace dovetail::fem
