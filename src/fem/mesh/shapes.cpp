#include "shapes.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/fem/mesh/cell_topology.hpp"
#include "lines.hpp"

namespace dovetail::fem {

namespace {

constexpr std::array<std::array<int, 3>, 8> brickSign = {
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};

}  // namespace

std::array<double, 8> shapeValues(const Vec3& xi) {
  std::array<double, 8> value{};
  for (std::size_t a = 0; a < 8; ++a)
    value[a] = 0.125 * (1.0 + brickSign[a][0] * xi.x) * (1.0 + brickSign[a][1] * xi.y) * (1.0 + brickSign[a][2] * xi.z);
  return value;
}

std::array<Vec3, 8> parentGradients(const Vec3& xi) {
  std::array<Vec3, 8> gradient{};
  for (std::size_t a = 0; a < 8; ++a) {
    const auto [sx, sy, sz] = brickSign[a];
    const double x = 1.0 + sx * xi.x, y = 1.0 + sy * xi.y, z = 1.0 + sz * xi.z;
    gradient[a] = {0.125 * sx * y * z, 0.125 * x * sy * z, 0.125 * x * y * sz};
  }
  return gradient;
}

namespace detail {

namespace {

std::vector<Vec3> brickNodes(int count) {
  std::vector<Vec3> nodes = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                             {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  if (count >= 20)
    for (const auto& [a, b] : edgesOf(ElementShape::hex20))
      nodes.push_back(0.5 * (nodes[static_cast<std::size_t>(a)] + nodes[static_cast<std::size_t>(b)]));
  if (count == 27)
    for (const Vec3& X : {Vec3{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}, {0, 0, 0}})
      nodes.push_back(X);
  return nodes;
}

std::vector<Vec3> tetNodes(int count) {
  std::vector<Vec3> nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (count == 10)
    for (const auto& [a, b] : edgesOf(ElementShape::tet10))
      nodes.push_back(0.5 * (nodes[static_cast<std::size_t>(a)] + nodes[static_cast<std::size_t>(b)]));
  return nodes;
}

void tensorProduct(const Vec3& node, const Vec3& xi, bool second, double& value, Vec3& gradient) {
  const auto [a, da] = lagrange(node.x, xi.x, second);
  const auto [b, db] = lagrange(node.y, xi.y, second);
  const auto [c, dc] = lagrange(node.z, xi.z, second);
  value = a * b * c;
  gradient = {da * b * c, a * db * c, a * b * dc};
}

/// Serendipity functions of one coordinate at a time: 1 + x x_a, or 1 − x² across a mid-edge node.
void serendipity(const Vec3& node, const Vec3& xi, double& value, Vec3& gradient) {
  std::array<double, 3> f{}, df{};
  bool corner = true;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool across = node[i] == 0.0;
    corner = corner && !across;
    f[k] = across ? 1.0 - xi[i] * xi[i] : 1.0 + node[i] * xi[i];
    df[k] = across ? -2.0 * xi[i] : node[i];
  }
  const double scale = corner ? 0.125 : 0.25, product = scale * f[0] * f[1] * f[2];
  const double sum = corner ? dot(node, xi) - 2.0 : 1.0;
  value = product * sum;
  gradient = scale * sum * Vec3{df[0] * f[1] * f[2], f[0] * df[1] * f[2], f[0] * f[1] * df[2]};
  if (corner) gradient += product * node;
}

void tetFunctions(bool second, const Vec3& xi, std::span<double> value, std::span<Vec3> gradient) {
  const std::array<double, 4> l = {1.0 - xi.x - xi.y - xi.z, xi.x, xi.y, xi.z};
  constexpr std::array<Vec3, 4> dl = {Vec3{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t a = 0; a < 4; ++a) {
    value[a] = second ? l[a] * (2.0 * l[a] - 1.0) : l[a];
    gradient[a] = second ? (4.0 * l[a] - 1.0) * dl[a] : dl[a];
  }
  if (!second) return;
  const auto edges = edgesOf(ElementShape::tet10);
  for (std::size_t e = 0; e < 6; ++e) {
    const auto a = static_cast<std::size_t>(edges[e][0]), b = static_cast<std::size_t>(edges[e][1]);
    value[4 + e] = 4.0 * l[a] * l[b];
    gradient[4 + e] = 4.0 * l[a] * dl[b] + 4.0 * l[b] * dl[a];
  }
}

/// The lower face of a brick.
std::vector<Vec3> planeNodes(int count) {
  std::vector<Vec3> nodes = brickNodes(20);
  nodes.erase(nodes.begin() + 12, nodes.end());
  nodes.erase(nodes.begin() + 4, nodes.begin() + 8);
  for (Vec3& node : nodes) node.z = 0.0;
  nodes.resize(static_cast<std::size_t>(count));
  return nodes;
}

void planeFunctions(ElementShape shape, const Vec3& xi, std::span<double> value, std::span<Vec3> gradient) {
  const auto n = static_cast<std::size_t>(nodesOf(shape));
  std::array<double, 8> byXi{}, byEta{};
  faceFunctions(shape == ElementShape::quad4 ? FaceShape::quad4 : FaceShape::quad8, xi.x, xi.y, value.first(n), byXi,
                byEta);
  for (std::size_t a = 0; a < n; ++a) gradient[a] = {byXi[a], byEta[a], 0.0};
}

template <std::size_t count>
void planePoints(const std::array<Point1, count>& line, CellRule& rule) {
  for (const Point1& y : line)
    for (const Point1& x : line) {
      rule.point.push_back({x.at, y.at, 0.0});
      rule.weight.push_back(x.weight * y.weight);
    }
}

template <std::size_t count>
void brickPoints(const std::array<Point1, count>& line, CellRule& rule) {
  for (const Point1& z : line)
    for (const Point1& y : line)
      for (const Point1& x : line) {
        rule.point.push_back({x.at, y.at, z.at});
        rule.weight.push_back(x.weight * y.weight * z.weight);
      }
}

/// The points with one barycentric coordinate `special` and three equal ones.
void addTetOrbit4(double special, double weight, CellRule& rule) {
  const double other = (1.0 - special) / 3.0;
  rule.point.push_back({other, other, other});
  rule.point.push_back({special, other, other});
  rule.point.push_back({other, special, other});
  rule.point.push_back({other, other, special});
  rule.weight.insert(rule.weight.end(), 4, weight);
}

/// The points with two barycentric coordinates a and two ½ − a.
void addTetOrbit6(double a, double weight, CellRule& rule) {
  const double b = 0.5 - a;
  for (const Vec3& xi : {Vec3{a, a, b}, {a, b, a}, {b, a, a}, {b, b, a}, {b, a, b}, {a, b, b}})
    rule.point.push_back(xi);
  rule.weight.insert(rule.weight.end(), 6, weight);
}

/// 14 points, exact to degree 5 (Walkington 2000).
void fineTetPoints(CellRule& rule) {
  addTetOrbit4(1.0 - 3.0 * 0.31088591926330060980, 0.11268792571801585080 / 6.0, rule);
  addTetOrbit4(1.0 - 3.0 * 0.092735250310891226402, 0.073493043116361949544 / 6.0, rule);
  addTetOrbit6(0.045503704125649649492, 0.042546020777081466438 / 6.0, rule);
}

CellRule withFunctions(ElementShape shape, CellRule rule) {
  rule.nodes = nodesOf(shape);
  rule.points = static_cast<int>(rule.point.size());
  const auto n = static_cast<std::size_t>(rule.nodes);
  rule.value.resize(n * rule.point.size());
  rule.gradient.resize(n * rule.point.size());
  for (std::size_t q = 0; q < rule.point.size(); ++q)
    shapeFunctions(shape, rule.point[q], std::span(rule.value).subspan(n * q, n),
                   std::span(rule.gradient).subspan(n * q, n));
  return rule;
}

CellRule makeForceRule(ElementShape shape) {
  CellRule rule{};
  if (dimensionOf(shape) == 2)
    shape == ElementShape::quad4 ? planePoints(gauss2, rule) : planePoints(gauss3, rule);
  else if (shape == ElementShape::hex8)
    brickPoints(gauss2, rule);
  else if (!isTet(shape))
    brickPoints(gauss3, rule);
  else if (shape == ElementShape::tet4)
    rule.point = {{0.25, 0.25, 0.25}}, rule.weight = {1.0 / 6.0};
  else
    addTetOrbit4(0.25 + 0.75 / std::sqrt(5.0), 1.0 / 24.0, rule);
  return withFunctions(shape, std::move(rule));
}

CellRule makeMassRule(ElementShape shape) {
  CellRule rule{};
  if (dimensionOf(shape) == 2)
    planePoints(gauss3, rule);
  else if (!isTet(shape))
    brickPoints(gauss3, rule);
  else
    fineTetPoints(rule);
  return withFunctions(shape, std::move(rule));
}

CellRule makeReducedRule(ElementShape shape) {
  CellRule rule{};
  planePoints(gauss2, rule);
  return withFunctions(shape, std::move(rule));
}

CellRule makeCentreRule(ElementShape shape) {
  CellRule rule{};
  rule.point = {isTet(shape) ? Vec3{0.25, 0.25, 0.25} : Vec3{}};
  rule.weight = {isTet(shape) ? 1.0 / 6.0 : dimensionOf(shape) == 2 ? 4.0 : 8.0};
  return withFunctions(shape, std::move(rule));
}

}  // namespace

const CellRule& forceRule(ElementShape shape) {
  static const auto rules = perShape(makeForceRule);
  return rules[static_cast<std::size_t>(shape)];
}
const CellRule& massRule(ElementShape shape) {
  static const auto rules = perShape(makeMassRule);
  return rules[static_cast<std::size_t>(shape)];
}
const CellRule& reducedRule(ElementShape shape) {
  static const std::array rules = {makeReducedRule(ElementShape::quad4), makeReducedRule(ElementShape::quad8)};
  return rules[shape == ElementShape::quad8];
}
const CellRule& centreRule(ElementShape shape) {
  static const auto rules = perShape(makeCentreRule);
  return rules[static_cast<std::size_t>(shape)];
}
}  // namespace detail

std::span<const Vec3> parentNodes(ElementShape shape) {
  static const auto nodes = detail::perShape([](ElementShape s) {
    if (dimensionOf(s) == 2) return detail::planeNodes(nodesOf(s));
    return detail::isTet(s) ? detail::tetNodes(nodesOf(s)) : detail::brickNodes(nodesOf(s));
  });
  return nodes[static_cast<std::size_t>(shape)];
}

void shapeFunctions(ElementShape shape, const Vec3& xi, std::span<double> value, std::span<Vec3> gradient) {
  if (detail::isTet(shape)) return detail::tetFunctions(shape == ElementShape::tet10, xi, value, gradient);
  if (shape == ElementShape::hex8) {
    std::ranges::copy(shapeValues(xi), value.begin());
    std::ranges::copy(parentGradients(xi), gradient.begin());
    return;
  }
  if (dimensionOf(shape) == 2) return detail::planeFunctions(shape, xi, value, gradient);
  const std::span<const Vec3> nodes = parentNodes(shape);
  for (std::size_t a = 0; a < nodes.size(); ++a)
    if (shape == ElementShape::hex20)
      detail::serendipity(nodes[a], xi, value[a], gradient[a]);
    else
      detail::tensorProduct(nodes[a], xi, shape == ElementShape::hex27, value[a], gradient[a]);
}

Vec3 nearestInParent(ElementShape shape, const Vec3& xi) {
  if (!detail::isTet(shape))
    return {std::clamp(xi.x, -1.0, 1.0), std::clamp(xi.y, -1.0, 1.0), std::clamp(xi.z, -1.0, 1.0)};
  const Vec3 within{std::max(xi.x, 0.0), std::max(xi.y, 0.0), std::max(xi.z, 0.0)};
  return (1.0 / std::max(1.0, within.x + within.y + within.z)) * within;
}

std::vector<double> shapeRow(ElementShape shape, const Vec3& xi) {
  std::vector<double> row(static_cast<std::size_t>(nodesOf(shape)));
  std::array<Vec3, detail::maxCellNodes> gradient;
  shapeFunctions(shape, xi, row, std::span(gradient).first(row.size()));
  return row;
}

std::vector<double> shapeRow(FaceShape shape, double xi, double eta) {
  std::vector<double> row(static_cast<std::size_t>(nodesOf(shape)));
  std::array<double, 9> byXi, byEta;
  detail::faceFunctions(shape, xi, eta, row, std::span(byXi).first(row.size()), std::span(byEta).first(row.size()));
  return row;
}

}  // namespace dovetail::fem
