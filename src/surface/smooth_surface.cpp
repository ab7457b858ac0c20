#include "dovetail/surface/smooth_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "face_cut.hpp"

namespace dovetail::surface {

namespace {

using Row = std::map<int, double>;  ///< a control point as a combination of skin vertices

struct Crossing {
  int face = -1, edge = -1;
};

/// For every face and edge (corner e to corner e + 1): the face that has the same edge the other way round.
std::vector<std::array<Crossing, 4>> makeCrossings(std::span<const std::array<int, 4>> quads) {
  std::map<std::pair<int, int>, Crossing> byEdge;
  for (std::size_t q = 0; q < quads.size(); ++q)
    for (int e = 0; e < 4; ++e) byEdge[{quads[q][e], quads[q][(e + 1) % 4]}] = {static_cast<int>(q), e};
  std::vector<std::array<Crossing, 4>> crossings(quads.size());
  for (std::size_t q = 0; q < quads.size(); ++q)
    for (int e = 0; e < 4; ++e)
      if (const auto found = byEdge.find({quads[q][(e + 1) % 4], quads[q][e]}); found != byEdge.end())
        crossings[q][e] = found->second;
  return crossings;
}

/// The 4 × 4 net around one face, in the face's own axes.
class ControlNet {
public:
  Row& at(int i, int j) { return rows_[static_cast<std::size_t>((i + 1) + 4 * (j + 1))]; }
  const std::array<Row, 16>& rows() const { return rows_; }

private:
  std::array<Row, 16> rows_;
};

Row continued(const Row& last, const Row& before) {
  Row row;
  for (const auto& [vertex, weight] : last) row[vertex] += 2.0 * weight;
  for (const auto& [vertex, weight] : before) row[vertex] -= weight;
  return row;
}

/// Index pair of the net: corner e of the face, and the outward step across edge e.
constexpr std::array<std::array<int, 2>, 4> cornerIndex{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
constexpr std::array<std::array<int, 2>, 4> outward{{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};

class NetBuilder {
public:
  NetBuilder(std::span<const std::array<int, 4>> quads, const std::vector<std::array<Crossing, 4>>& crossings)
      : quads_(quads), crossings_(crossings) {}

  ControlNet build(int face) const {
    ControlNet net;
    for (int e = 0; e < 4; ++e) cornerRow(net, e, {0, 0}) = Row{{quads_[face][e], 1.0}};
    for (int e = 0; e < 4; ++e) addSide(net, face, e);
    for (int e = 0; e < 4; ++e) addDiagonal(net, face, e);
    return net;
  }

private:
  static Row& cornerRow(ControlNet& net, int corner, std::array<int, 2> step) {
    return net.at(cornerIndex[corner][0] + step[0], cornerIndex[corner][1] + step[1]);
  }

  /// The two control points beyond edge e.
  void addSide(ControlNet& net, int face, int e) const {
    const int next = (e + 1) % 4;
    const auto [neighbour, edge] = crossings_[face][e];
    if (neighbour >= 0) {
      cornerRow(net, e, outward[e]) = Row{{quads_[neighbour][(edge + 2) % 4], 1.0}};
      cornerRow(net, next, outward[e]) = Row{{quads_[neighbour][(edge + 3) % 4], 1.0}};
      return;
    }
    const std::array<int, 2> inward{-outward[e][0], -outward[e][1]};
    cornerRow(net, e, outward[e]) = continued(cornerRow(net, e, {0, 0}), cornerRow(net, e, inward));
    cornerRow(net, next, outward[e]) = continued(cornerRow(net, next, {0, 0}), cornerRow(net, next, inward));
  }

  /// The control point diagonally beyond corner e, between edge e and the edge before it.
  void addDiagonal(ControlNet& net, int face, int e) const {
    const int before = (e + 3) % 4;
    const std::array<int, 2> across{outward[e][0], outward[e][1]}, side{outward[before][0], outward[before][1]};
    const std::array<int, 2> diagonal{across[0] + side[0], across[1] + side[1]};
    Row& target = cornerRow(net, e, diagonal);
    if (crossings_[face][e].face < 0) {
      const std::array<int, 2> inner{side[0] - across[0], side[1] - across[1]};
      target = continued(cornerRow(net, e, side), cornerRow(net, e, inner));
    } else if (crossings_[face][before].face < 0) {
      const std::array<int, 2> inner{across[0] - side[0], across[1] - side[1]};
      target = continued(cornerRow(net, e, across), cornerRow(net, e, inner));
    } else {
      target = Row{{vertexAcross(face, e), 1.0}};
    }
  }

  int vertexAcross(int face, int e) const {
    const auto [first, firstEdge] = crossings_[face][e];
    const auto [second, secondEdge] = crossings_[first][(firstEdge + 1) % 4];
    const auto [beside, besideEdge] = crossings_[face][(e + 3) % 4];
    const int expected = quads_[beside][(besideEdge + 3) % 4];
    if (second < 0 || quads_[second][(secondEdge + 2) % 4] != expected)
      throw InputError("a vertex of face " + std::to_string(face) + " has other than four faces inside a smooth patch",
                       "smooth surface", "use the flat surface for this mesh, or a regular surface mesh");
    return quads_[second][(secondEdge + 3) % 4];
  }

  std::span<const std::array<int, 4>> quads_;
  const std::vector<std::array<Crossing, 4>>& crossings_;
};

/// Numbers equal rows once, so that neighbouring faces share their control points.
class RowNumbers {
public:
  int number(const Row& row) {
    const auto [place, isNew] = numbers_.try_emplace(row, static_cast<int>(numbers_.size()));
    if (isNew) rows.push_back(row);
    return place->second;
  }
  std::vector<Row> rows;

private:
  std::map<Row, int> numbers_;
};

/// The uniform quadratic B-spline has its knots in the middles of the faces: left of the middle it takes the first
/// three of the four control points, from there on the last three.
std::array<double, 4> placed(const std::array<double, 3>& three, double t) {
  return t < 0.5 ? std::array<double, 4>{three[0], three[1], three[2], 0.0}
                 : std::array<double, 4>{0.0, three[0], three[1], three[2]};
}
double sinceKnot(double t) { return t < 0.5 ? t + 0.5 : t - 0.5; }
std::array<double, 4> spline(double t) {
  const double s = sinceKnot(t);
  return placed({0.5 * (1.0 - s) * (1.0 - s), 0.5 + s * (1.0 - s), 0.5 * s * s}, t);
}
std::array<double, 4> splineSlope(double t) {
  const double s = sinceKnot(t);
  return placed({s - 1.0, 1.0 - 2.0 * s, s}, t);
}
std::array<double, 4> splineCurvature(double t) { return placed({1.0, -2.0, 1.0}, t); }

struct PatchJet {
  Vec3 s, sXi, sEta, sXiXi, sXiEta, sEtaEta;
};

PatchJet evaluate(const SmoothSurface& surface, int face, double xi, double eta) {
  const auto b = spline(xi), db = splineSlope(xi), ddb = splineCurvature(xi);
  const auto c = spline(eta), dc = splineSlope(eta), ddc = splineCurvature(eta);
  PatchJet jet;
  for (int j = 0; j < 4; ++j) {
    Vec3 line, slope, curvature;
    for (int i = 0; i < 4; ++i) {
      const Vec3& point = surface.x[surface.control[face][i + 4 * j]];
      line += b[i] * point;
      slope += db[i] * point;
      curvature += ddb[i] * point;
    }
    jet.s += c[j] * line;
    jet.sXi += c[j] * slope;
    jet.sXiXi += c[j] * curvature;
    jet.sEta += dc[j] * line;
    jet.sXiEta += dc[j] * slope;
    jet.sEtaEta += ddc[j] * line;
  }
  return jet;
}

/// One projected Newton step for min ½|s(ξ) − p|² on [0, 1]²; returns the largest change of a parameter.
double newtonStep(const PatchJet& jet, const Vec3& p, std::array<double, 2>& parameter) {
  const Vec3 r = jet.s - p;
  std::array<double, 2> gradient{dot(r, jet.sXi), dot(r, jet.sEta)};
  double a = squaredNorm(jet.sXi) + dot(r, jet.sXiXi), d = squaredNorm(jet.sEta) + dot(r, jet.sEtaEta);
  double b = dot(jet.sXi, jet.sEta) + dot(r, jet.sXiEta);
  if (a <= 0.0 || d <= 0.0 || a * d - b * b <= 0.0) {  // not convex here: Gauss–Newton
    a = squaredNorm(jet.sXi);
    d = squaredNorm(jet.sEta);
    b = dot(jet.sXi, jet.sEta);
  }
  std::array<bool, 2> held{};
  for (int k = 0; k < 2; ++k)
    held[k] = (parameter[k] <= 0.0 && gradient[k] > 0.0) || (parameter[k] >= 1.0 && gradient[k] < 0.0);
  std::array<double, 2> change{};
  if (!held[0] && !held[1]) {
    const double determinant = a * d - b * b;
    change = {-(d * gradient[0] - b * gradient[1]) / determinant, -(a * gradient[1] - b * gradient[0]) / determinant};
  } else if (!held[0]) {
    change[0] = -gradient[0] / a;
  } else if (!held[1]) {
    change[1] = -gradient[1] / d;
  }
  double largest = 0.0;
  for (int k = 0; k < 2; ++k) {
    const double moved = std::clamp(parameter[k] + change[k], 0.0, 1.0);
    largest = std::max(largest, std::abs(moved - parameter[k]));
    parameter[k] = moved;
  }
  return largest;
}

}  // namespace

SmoothSurface makeSmoothSurface(const Skin& whole) {
  Skin skin = whole;
  splitAtSharpEdges(skin);  // changes nothing if it has been done
  const std::vector<std::array<int, 4>> quads = quadsOf(skin.faces, "the smooth surface");
  const auto crossings = makeCrossings(quads);
  const NetBuilder builder(quads, crossings);
  SmoothSurface surface;
  RowNumbers controls;
  for (std::size_t face = 0; face < quads.size(); ++face) {
    const ControlNet net = builder.build(static_cast<int>(face));
    std::array<int, 16> control{};
    for (std::size_t k = 0; k < 16; ++k) control[k] = controls.number(net.rows()[k]);
    surface.control.push_back(control);
    std::array<int, 4> across{};
    for (int e = 0; e < 4; ++e) across[e] = crossings[face][e].face;
    surface.across.push_back(across);
  }
  surface.carrier.columns = skin.carrier.columns;
  surface.carrier.offsets.push_back(0);
  for (const Row& row : controls.rows) {
    Row nodes;
    Vec3 X;
    for (const auto& [vertex, weight] : row) {
      X += weight * skin.X[vertex];
      for (int k = skin.carrier.offsets[vertex]; k < skin.carrier.offsets[vertex + 1]; ++k)
        nodes[skin.carrier.column[k]] += weight * skin.carrier.weight[k];
    }
    for (const auto& [node, weight] : nodes) {
      surface.carrier.column.push_back(node);
      surface.carrier.weight.push_back(weight);
    }
    surface.carrier.offsets.push_back(static_cast<int>(surface.carrier.column.size()));
    surface.X.push_back(X);
  }
  surface.x = surface.X;
  surface.v.resize(surface.X.size());
  return surface;
}

void place(SmoothSurface& surface, std::span<const Vec3> u, std::span<const Vec3> v, std::span<const int> controls) {
  const cg::Projection& map = surface.carrier;
  for (int c : controls) {
    Vec3 displacement, velocity;
    for (int k = map.offsets[c]; k < map.offsets[c + 1]; ++k) {
      displacement += map.weight[k] * u[map.column[k]];
      velocity += map.weight[k] * v[map.column[k]];
    }
    surface.x[c] = surface.X[c] + displacement;
    surface.v[c] = velocity;
  }
}

std::array<double, 16> patchWeights(double xi, double eta) {
  const auto b = spline(xi), c = spline(eta);
  std::array<double, 16> weight{};
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) weight[i + 4 * j] = b[i] * c[j];
  return weight;
}

PatchPoint closestPointOnPatch(const SmoothSurface& surface, int face, const Vec3& p, std::array<double, 2> start) {
  PatchPoint closest;
  closest.parameter = start;
  PatchJet jet = evaluate(surface, face, start[0], start[1]);
  for (int iteration = 0; iteration < 20; ++iteration) {
    if (newtonStep(jet, p, closest.parameter) < 1e-14) break;
    jet = evaluate(surface, face, closest.parameter[0], closest.parameter[1]);
  }
  const auto [xi, eta] = closest.parameter;
  closest.weight = patchWeights(xi, eta);
  closest.point = jet.s;
  closest.squaredDistance = squaredNorm(p - jet.s);
  closest.edge = eta <= 0.0 ? 0 : xi >= 1.0 ? 1 : eta >= 1.0 ? 2 : xi <= 0.0 ? 3 : -1;
  return closest;
}

bool leavesThrough(const SmoothSurface& surface, int face, const PatchPoint& foot, const Vec3& p) {
  const PatchJet jet = evaluate(surface, face, foot.parameter[0], foot.parameter[1]);
  const Vec3 r = jet.s - p;
  const std::array<double, 2> slope{dot(r, jet.sXi), dot(r, jet.sEta)};
  const double along = outward[foot.edge][0] * slope[0] + outward[foot.edge][1] * slope[1];
  const double scale = norm(r) * (foot.edge % 2 == 1 ? norm(jet.sXi) : norm(jet.sEta));
  return along < -1e-12 * scale;
}

Vec3 patchNormal(const SmoothSurface& surface, int face, const PatchPoint& at) {
  const PatchJet jet = evaluate(surface, face, at.parameter[0], at.parameter[1]);
  return normalized(cross(jet.sXi, jet.sEta));
}

}  // namespace dovetail::surface
