// Faces of the cells, their shape functions and quadrature.
#include <cmath>

#include "dovetail/fem/mesh/cell_topology.hpp"
#include "lines.hpp"
#include "shapes.hpp"

namespace dovetail::fem::detail {

namespace {

// x−, x+, y−, y+, z−, z+.
constexpr std::array<std::array<int, 4>, 6> brickFaces = {
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};
constexpr std::array<std::array<int, 3>, 4> tetFaces = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};

int midEdge(ElementShape shape, int a, int b) {
  const auto edges = edgesOf(shape);
  for (std::size_t e = 0; e < edges.size(); ++e)
    if ((edges[e][0] == a && edges[e][1] == b) || (edges[e][0] == b && edges[e][1] == a))
      return cornersOf(shape) + static_cast<int>(e);
  return -1;
}

/// x−, x+, y−, y+, in the sense of the corners.
CellFaces makeLines(ElementShape shape) {
  const bool second = shape == ElementShape::quad8;
  CellFaces faces{second ? FaceShape::line3 : FaceShape::line2, {}};
  for (const int edge : {3, 1, 0, 2}) {
    std::array<int, 9> node;
    node.fill(-1);
    node[0] = edge;
    node[1] = (edge + 1) % 4;
    if (second) node[2] = 4 + edge;
    faces.node.push_back(node);
  }
  return faces;
}

CellFaces makeFaces(ElementShape shape) {
  if (dimensionOf(shape) == 2) return makeLines(shape);
  const bool tet = isTet(shape), second = shape != ElementShape::hex8 && shape != ElementShape::tet4;
  CellFaces faces{};
  faces.shape = tet ? (second ? FaceShape::tri6 : FaceShape::tri3)
                    : (shape == ElementShape::hex27 ? FaceShape::quad9
                       : second                     ? FaceShape::quad8
                                                    : FaceShape::quad4);
  const std::size_t corners = tet ? 3 : 4, count = tet ? 4 : 6;
  for (std::size_t f = 0; f < count; ++f) {
    std::array<int, 9> node;
    node.fill(-1);
    for (std::size_t a = 0; a < corners; ++a) node[a] = tet ? tetFaces[f][a] : brickFaces[f][a];
    for (std::size_t a = 0; second && a < corners; ++a) {
      const int from = node[a], to = node[(a + 1) % corners];
      node[corners + a] = midEdge(shape, from, to);
    }
    if (shape == ElementShape::hex27) node[8] = 20 + static_cast<int>(f);
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

void lineFunctions(bool second, double xi, std::span<double> value, std::span<double> byXi, std::span<double> byEta) {
  constexpr std::array<double, 3> nodes = {-1.0, 1.0, 0.0};
  for (std::size_t a = 0; a < (second ? 3 : 2); ++a) {
    const auto [f, df] = lagrange(nodes[a], xi, second);
    value[a] = f, byXi[a] = df, byEta[a] = 0.0;
  }
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

template <std::size_t count>
void linePoints(const std::array<Point1, count>& line, FaceRule& rule) {
  for (const Point1& x : line) {
    rule.point.push_back({x.at, 0.0});
    rule.weight.push_back(x.weight);
  }
}

FaceRule makeFaceRule(FaceShape shape) {
  FaceRule rule{};
  if (dimensionOf(shape) == 2)
    shape == FaceShape::line2 ? linePoints(gauss2, rule) : linePoints(gauss3, rule);
  else if (shape == FaceShape::quad4)
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

const CellFaces& facesOf(ElementShape shape) {
  static const auto faces = perShape(makeFaces);
  return faces[static_cast<std::size_t>(shape)];
}

void faceFunctions(FaceShape shape, double xi, double eta, std::span<double> value, std::span<double> byXi,
                   std::span<double> byEta) {
  if (shape == FaceShape::tri3 || shape == FaceShape::tri6)
    return triangleFunctions(shape == FaceShape::tri6, xi, eta, value, byXi, byEta);
  if (dimensionOf(shape) == 2) return lineFunctions(shape == FaceShape::line3, xi, value, byXi, byEta);
  for (std::size_t a = 0; a < static_cast<std::size_t>(nodesOf(shape)); ++a)
    quadFunction(shape, a, xi, eta, value[a], byXi[a], byEta[a]);
}

const FaceRule& faceRule(FaceShape shape) {
  static const std::array rules = {makeFaceRule(FaceShape::quad4), makeFaceRule(FaceShape::quad8),
                                   makeFaceRule(FaceShape::quad9), makeFaceRule(FaceShape::tri3),
                                   makeFaceRule(FaceShape::tri6),  makeFaceRule(FaceShape::line2),
                                   makeFaceRule(FaceShape::line3)};
  return rules[static_cast<std::size_t>(shape)];
}

}  // namespace dovetail::fem::detail
