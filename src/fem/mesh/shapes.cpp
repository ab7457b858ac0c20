#include "shapes.hpp"

#include <algorithm>
#include <cmath>

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

struct Point1 {
  double at, weight;
};
const std::array<Point1, 2> gauss2 = {{{-1.0 / std::sqrt(3.0), 1.0}, {1.0 / std::sqrt(3.0), 1.0}}};
const std::array<Point1, 3> gauss3 = {{{-std::sqrt(0.6), 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {std::sqrt(0.6), 5.0 / 9.0}}};

// Edges of the second-order cells, in the order of their mid-edge nodes.
constexpr std::array<std::array<int, 2>, 12> brickEdges = {
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
constexpr std::array<std::array<int, 2>, 6> tetEdges = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
// x−, x+, y−, y+, z−, z+.
constexpr std::array<std::array<int, 4>, 6> brickFaces = {
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};
constexpr std::array<std::array<int, 3>, 4> tetFaces = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};

std::vector<Vec3> brickNodes(int count) {
  std::vector<Vec3> nodes = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                             {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  if (count >= 20)
    for (const auto& [a, b] : brickEdges)
      nodes.push_back(0.5 * (nodes[static_cast<std::size_t>(a)] + nodes[static_cast<std::size_t>(b)]));
  if (count == 27)
    for (const Vec3& X : {Vec3{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}, {0, 0, 0}})
      nodes.push_back(X);
  return nodes;
}

std::vector<Vec3> tetNodes(int count) {
  std::vector<Vec3> nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (count == 10)
    for (const auto& [a, b] : tetEdges)
      nodes.push_back(0.5 * (nodes[static_cast<std::size_t>(a)] + nodes[static_cast<std::size_t>(b)]));
  return nodes;
}

/// Lagrange's polynomial on the nodes −1, 1 (first order) or −1, 0, 1 (second order), and its slope.
std::array<double, 2> lagrange(double node, double x, bool second) {
  if (!second) return {0.5 * (1.0 + node * x), 0.5 * node};
  if (node == 0.0) return {1.0 - x * x, -2.0 * x};
  return {0.5 * x * (x + node), x + 0.5 * node};
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
  for (std::size_t e = 0; e < 6; ++e) {
    const auto a = static_cast<std::size_t>(tetEdges[e][0]), b = static_cast<std::size_t>(tetEdges[e][1]);
    value[4 + e] = 4.0 * l[a] * l[b];
    gradient[4 + e] = 4.0 * l[a] * dl[b] + 4.0 * l[b] * dl[a];
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

CellRule withFunctions(CellShape shape, CellRule rule) {
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

bool isTet(CellShape shape) { return shape == CellShape::tet4 || shape == CellShape::tet10; }

CellRule makeForceRule(CellShape shape) {
  CellRule rule{};
  if (shape == CellShape::hex8)
    brickPoints(gauss2, rule);
  else if (!isTet(shape))
    brickPoints(gauss3, rule);
  else if (shape == CellShape::tet4)
    rule.point = {{0.25, 0.25, 0.25}}, rule.weight = {1.0 / 6.0};
  else
    addTetOrbit4(0.25 + 0.75 / std::sqrt(5.0), 1.0 / 24.0, rule);
  return withFunctions(shape, std::move(rule));
}

CellRule makeMassRule(CellShape shape) {
  CellRule rule{};
  if (!isTet(shape))
    brickPoints(gauss3, rule);
  else
    fineTetPoints(rule);
  return withFunctions(shape, std::move(rule));
}

CellRule makeCentreRule(CellShape shape) {
  CellRule rule{};
  rule.point = {isTet(shape) ? Vec3{0.25, 0.25, 0.25} : Vec3{}};
  rule.weight = {isTet(shape) ? 1.0 / 6.0 : 8.0};
  return withFunctions(shape, std::move(rule));
}

template <class Make>
auto perShape(Make make) {
  return std::array{make(CellShape::hex8), make(CellShape::hex20), make(CellShape::hex27), make(CellShape::tet4),
                    make(CellShape::tet10)};
}

int midEdge(std::span<const std::array<int, 2>> edges, int corners, int a, int b) {
  for (std::size_t e = 0; e < edges.size(); ++e)
    if ((edges[e][0] == a && edges[e][1] == b) || (edges[e][0] == b && edges[e][1] == a))
      return corners + static_cast<int>(e);
  return -1;
}

CellFaces makeFaces(CellShape shape) {
  const bool tet = isTet(shape), second = shape != CellShape::hex8 && shape != CellShape::tet4;
  CellFaces faces{};
  faces.shape = tet ? (second ? FaceShape::tri6 : FaceShape::tri3)
                    : (shape == CellShape::hex27 ? FaceShape::quad9
                       : second                  ? FaceShape::quad8
                                                 : FaceShape::quad4);
  const std::size_t corners = tet ? 3 : 4, count = tet ? 4 : 6;
  for (std::size_t f = 0; f < count; ++f) {
    std::array<int, 9> node;
    node.fill(-1);
    for (std::size_t a = 0; a < corners; ++a) node[a] = tet ? tetFaces[f][a] : brickFaces[f][a];
    for (std::size_t a = 0; second && a < corners; ++a) {
      const int from = node[a], to = node[(a + 1) % corners];
      node[corners + a] = tet ? midEdge(tetEdges, 4, from, to) : midEdge(brickEdges, 8, from, to);
    }
    if (shape == CellShape::hex27) node[8] = 20 + static_cast<int>(f);
    faces.node.push_back(node);
  }
  return faces;
}

constexpr std::array<std::array<double, 2>, 9> quadNodes = {
    {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}, {0, 0}}};

void quadFunction(FaceShape shape, std::size_t a, double xi, double eta, double& value, double& byXi, double& byEta) {
  const auto [p, q] = quadNodes[a];
  if (shape != FaceShape::quad8) {
    const bool second = shape == FaceShape::quad9;
    const auto [f, df] = lagrange(p, xi, second);
    const auto [g, dg] = lagrange(q, eta, second);
    value = f * g, byXi = df * g, byEta = f * dg;
    return;
  }
  const double f = p == 0.0 ? 1.0 - xi * xi : 1.0 + p * xi, df = p == 0.0 ? -2.0 * xi : p;
  const double g = q == 0.0 ? 1.0 - eta * eta : 1.0 + q * eta, dg = q == 0.0 ? -2.0 * eta : q;
  const bool corner = p != 0.0 && q != 0.0;
  const double scale = corner ? 0.25 : 0.5, sum = corner ? p * xi + q * eta - 1.0 : 1.0;
  value = scale * f * g * sum;
  byXi = scale * (df * sum + (corner ? f * p : 0.0)) * g;
  byEta = scale * f * (dg * sum + (corner ? g * q : 0.0));
}

void triangleFunctions(bool second, double xi, double eta, std::span<double> value, std::span<double> byXi,
                       std::span<double> byEta) {
  const std::array<double, 3> l = {1.0 - xi - eta, xi, eta};
  constexpr std::array<double, 3> lx = {-1, 1, 0}, ly = {-1, 0, 1};
  for (std::size_t a = 0; a < 3; ++a) {
    value[a] = second ? l[a] * (2.0 * l[a] - 1.0) : l[a];
    byXi[a] = second ? (4.0 * l[a] - 1.0) * lx[a] : lx[a];
    byEta[a] = second ? (4.0 * l[a] - 1.0) * ly[a] : ly[a];
    if (!second) continue;
    const std::size_t b = (a + 1) % 3;
    value[3 + a] = 4.0 * l[a] * l[b];
    byXi[3 + a] = 4.0 * (lx[a] * l[b] + l[a] * lx[b]);
    byEta[3 + a] = 4.0 * (ly[a] * l[b] + l[a] * ly[b]);
  }
}

template <std::size_t count>
void quadPoints(const std::array<Point1, count>& line, FaceRule& rule) {
  for (const Point1& y : line)
    for (const Point1& x : line) {
      rule.point.push_back({x.at, y.at});
      rule.weight.push_back(x.weight * y.weight);
    }
}

/// Points with one barycentric coordinate 1 − 2a and two a.
void addTriangleOrbit(double a, double weight, FaceRule& rule) {
  for (const auto& p : {std::array{a, a}, std::array{1.0 - 2.0 * a, a}, std::array{a, 1.0 - 2.0 * a}}) {
    rule.point.push_back(p);
    rule.weight.push_back(weight);
  }
}

FaceRule makeFaceRule(FaceShape shape) {
  FaceRule rule{};
  if (shape == FaceShape::quad4)
    quadPoints(gauss2, rule);
  else if (shape == FaceShape::quad8 || shape == FaceShape::quad9)
    quadPoints(gauss3, rule);
  else if (shape == FaceShape::tri3)
    addTriangleOrbit(1.0 / 6.0, 1.0 / 6.0, rule);
  else {  // degree 4 (Dunavant 1985)
    addTriangleOrbit(0.44594849091596488632, 0.22338158967801146570 / 2.0, rule);
    addTriangleOrbit(0.091576213509770743460, 0.10995174365532186764 / 2.0, rule);
  }
  rule.nodes = nodesOf(shape);
  rule.points = static_cast<int>(rule.point.size());
  const auto n = static_cast<std::size_t>(rule.nodes);
  for (std::vector<double>* field : {&rule.value, &rule.byXi, &rule.byEta}) field->resize(n * rule.point.size());
  for (std::size_t q = 0; q < rule.point.size(); ++q)
    faceFunctions(shape, rule.point[q][0], rule.point[q][1], std::span(rule.value).subspan(n * q, n),
                  std::span(rule.byXi).subspan(n * q, n), std::span(rule.byEta).subspan(n * q, n));
  return rule;
}

}  // namespace

const CellRule& forceRule(CellShape shape) {
  static const auto rules = perShape(makeForceRule);
  return rules[static_cast<std::size_t>(shape)];
}
const CellRule& massRule(CellShape shape) {
  static const auto rules = perShape(makeMassRule);
  return rules[static_cast<std::size_t>(shape)];
}
const CellRule& centreRule(CellShape shape) {
  static const auto rules = perShape(makeCentreRule);
  return rules[static_cast<std::size_t>(shape)];
}
const CellFaces& facesOf(CellShape shape) {
  static const auto faces = perShape(makeFaces);
  return faces[static_cast<std::size_t>(shape)];
}

void faceFunctions(FaceShape shape, double xi, double eta, std::span<double> value, std::span<double> byXi,
                   std::span<double> byEta) {
  if (shape == FaceShape::tri3 || shape == FaceShape::tri6)
    return triangleFunctions(shape == FaceShape::tri6, xi, eta, value, byXi, byEta);
  for (std::size_t a = 0; a < static_cast<std::size_t>(nodesOf(shape)); ++a)
    quadFunction(shape, a, xi, eta, value[a], byXi[a], byEta[a]);
}

const FaceRule& faceRule(FaceShape shape) {
  static const std::array rules = {makeFaceRule(FaceShape::quad4), makeFaceRule(FaceShape::quad8),
                                   makeFaceRule(FaceShape::quad9), makeFaceRule(FaceShape::tri3),
                                   makeFaceRule(FaceShape::tri6)};
  return rules[static_cast<std::size_t>(shape)];
}

}  // namespace detail

std::span<const Vec3> parentNodes(CellShape shape) {
  static const auto nodes = detail::perShape(
      [](CellShape s) { return detail::isTet(s) ? detail::tetNodes(nodesOf(s)) : detail::brickNodes(nodesOf(s)); });
  return nodes[static_cast<std::size_t>(shape)];
}

void shapeFunctions(CellShape shape, const Vec3& xi, std::span<double> value, std::span<Vec3> gradient) {
  if (detail::isTet(shape)) return detail::tetFunctions(shape == CellShape::tet10, xi, value, gradient);
  if (shape == CellShape::hex8) {
    std::ranges::copy(shapeValues(xi), value.begin());
    std::ranges::copy(parentGradients(xi), gradient.begin());
    return;
  }
  const std::span<const Vec3> nodes = parentNodes(shape);
  for (std::size_t a = 0; a < nodes.size(); ++a)
    if (shape == CellShape::hex20)
      detail::serendipity(nodes[a], xi, value[a], gradient[a]);
    else
      detail::tensorProduct(nodes[a], xi, shape == CellShape::hex27, value[a], gradient[a]);
}

std::vector<double> shapeRow(CellShape shape, const Vec3& xi) {
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
