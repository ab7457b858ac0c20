#include "verification_cases.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/fem/cell_topology.hpp"
#include "dovetail/fem/loads.hpp"
#include "dovetail/fem/mesh_shapes.hpp"
#include "dovetail/fem/point_laws.hpp"

namespace dovetail::verification {

namespace {

using fem::CellShape;
using fem::Formulation;

constexpr double shearModulusOfMembrane = 422.5e3;

void holdInPlane(fem::Model& model) {
  std::vector<int> all;
  for (std::size_t n = 0; n < model.nodes.X.size(); ++n) all.push_back(static_cast<int>(n));
  model.constraints.hold(all, fem::componentZ);
}

/// Free nodes of the clamp lie in the plane already.
void clampInPlane(fem::Model& model, const fem::SolidMesh& mesh, const std::string& set) {
  model.constraints.hold(fem::nodeSet(mesh, set), fem::componentX | fem::componentY);
}

double proportional(double t) { return t; }

const Vec3& displacement(const fem::Model& model, int node) {
  return model.nodes.u[static_cast<std::size_t>(node)];
}

std::shared_ptr<fem::Solid> addSolid(fem::Model& model, const fem::SolidMesh& mesh, const ElementKind& kind,
                                     std::shared_ptr<const fem::PointMaterial> material) {
  auto solid = fem::makeSolid(mesh, std::move(material), {.formulation = kind.formulation});
  model.add(solid);
  return solid;
}

void addPressures(Membrane& result, fem::Solid& solid, const fem::Model& model, std::size_t elements) {
  const fem::Solid::Sample sample = solid.sample(model.nodes, {model.t, 0.0});
  std::vector<double> volume(elements, 0.0);
  result.pressure.assign(elements, 0.0);
  result.place.assign(elements, {});
  for (std::size_t q = 0; q < sample.volume.size(); ++q) {
    const double* F = &sample.F[9 * q];
    const double* P = &sample.P[9 * q];
    const double J = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
                     F[2] * (F[3] * F[7] - F[4] * F[6]);
    double trace = 0.0;  // of P Fᵀ = J σ
    for (int k = 0; k < 9; ++k) trace += P[k] * F[k];
    const auto e = static_cast<std::size_t>(sample.element[q]);
    result.pressure[e] -= sample.volume[q] * trace / (3.0 * J);
    result.place[e] += sample.volume[q] * sample.X[q];
    volume[e] += sample.volume[q];
    result.volume += sample.volume[q];
  }
  for (std::size_t e = 0; e < elements; ++e) {
    result.pressure[e] /= volume[e];
    result.place[e] *= 1.0 / volume[e];
  }
}

/// Pairs of elements that share a face.
std::vector<std::array<int, 2>> neighbours(const fem::SolidMesh& mesh) {
  std::map<std::vector<int>, int> seen;
  std::vector<std::array<int, 2>> pairs;
  int number = 0;
  for (const fem::CellGroup& group : mesh.groups)
    for (std::size_t e = 0; e < group.size(); ++e, ++number)
      for (std::size_t side = 0; side < fem::localFacesOf(group.shape).size(); ++side) {
        const fem::Face face = fem::faceOf(group, e, side);
        std::vector<int> key(face.node.begin(), face.node.begin() + fem::cornersOf(face.shape));
        std::sort(key.begin(), key.end());
        const auto [entry, isNew] = seen.emplace(key, number);
        if (!isNew) pairs.push_back({entry->second, number});
      }
  return pairs;
}

}  // namespace

std::string ElementKind::label() const {
  return std::string(name(shape)) + (shape == CellShape::hex8 ? std::string(" ") + name(formulation) : "");
}

const std::vector<ElementKind>& allKinds() {
  static const std::vector<ElementKind> kinds = {
      {CellShape::hex8, Formulation::standard}, {CellShape::hex8, Formulation::meanDilatation},
      {CellShape::hex8, Formulation::enhanced}, {CellShape::hex8, Formulation::reduced},
      {CellShape::hex20},                       {CellShape::hex27},
      {CellShape::tet4},                        {CellShape::tet10}};
  return kinds;
}

Vec3 beamBehindCylinder(const ElementKind& kind, std::array<int, 2> cells, double shearModulus) {
  constexpr double poissonRatio = 0.4, density = 1000.0;
  const fem::SolidMesh mesh = fem::arcClampedBeam(kind.shape, {cells[0], cells[1], 1});
  fem::Model model = fem::makeModel(mesh);
  addSolid(model, mesh, kind,
           fem::pointMaterial(fem::StVenantKirchhoff{2.0 * shearModulus * (1.0 + poissonRatio), poissonRatio, density}));
  fem::addMass(model);
  model.add(fem::gravity([](double t) { return Vec3{0.0, -2.0 * t, 0.0}; }));
  holdInPlane(model);
  clampInPlane(model, mesh, "clamped");
  fem::solveStatics(model, 1.0, {.firstStep = 0.25});
  return displacement(model, fem::nodeSet(mesh, "tip").front());
}

Membrane cooksMembrane(const ElementKind& kind, int perEdge, double poissonRatio) {
  constexpr double thickness = 1e-3, height = 16e-3, force = 1.0, mu = shearModulusOfMembrane;
  const double kappa = 2.0 * mu * (1.0 + poissonRatio) / (3.0 * (1.0 - 2.0 * poissonRatio));
  const fem::SolidMesh mesh = fem::cookMembrane(kind.shape, {perEdge, perEdge}, thickness);
  fem::Model model = fem::makeModel(mesh);
  const auto solid = addSolid(model, mesh, kind, fem::pointMaterial(fem::NeoHookean{kappa, mu, 1000.0}));
  model.add(fem::deadTraction(mesh, fem::faceSet(mesh, "loaded"), {0.0, force / (thickness * height), 0.0},
                              proportional));
  holdInPlane(model);
  clampInPlane(model, mesh, "clamped");
  fem::solveStatics(model, 1.0, {.firstStep = 0.25});
  Membrane result;
  result.tip = displacement(model, fem::nodeSet(mesh, "tip").front()).y;
  addPressures(result, *solid, model, mesh.elementCount());
  return result;
}

double pressureJump(const Membrane& result, int perEdge, bool tetrahedra, double away) {
  const auto isAway = [&](int e) {
    return norm(result.place[static_cast<std::size_t>(e)] - Vec3{0.0, 44e-3, 0.5e-3}) > away;
  };
  double jump = 0.0, least = 1e300, most = -1e300;
  const fem::SolidMesh mesh = fem::cookMembrane(tetrahedra ? CellShape::tet4 : CellShape::hex8, {perEdge, perEdge});
  for (std::size_t e = 0; e < result.pressure.size(); ++e) {
    if (!isAway(static_cast<int>(e))) continue;
    least = std::min(least, result.pressure[e]);
    most = std::max(most, result.pressure[e]);
  }
  for (const auto& [a, b] : neighbours(mesh))
    if (isAway(a) && isAway(b))
      jump = std::max(jump, std::abs(result.pressure[static_cast<std::size_t>(a)] -
                                     result.pressure[static_cast<std::size_t>(b)]));
  return jump / (most - least);
}

TipOfBeam bentCantilever(const ElementKind& kind, std::array<int, 2> cells, double alpha, double slenderness) {
  constexpr double modulus = 1e9;
  const double height = 1.0 / slenderness, width = height;
  const fem::SolidMesh mesh = fem::boxOf(kind.shape, {cells[0], cells[1], 1}, {}, {1.0, height, width});
  fem::Model model = fem::makeModel(mesh);
  addSolid(model, mesh, kind, fem::pointMaterial(fem::StVenantKirchhoff{modulus, 0.0, 1000.0}));
  const double load = alpha * modulus * width * height * height * height / 12.0;
  model.add(fem::deadTraction(mesh, fem::faceSet(mesh, "x+"), {0.0, load / (width * height), 0.0}, proportional));
  holdInPlane(model);
  clampInPlane(model, mesh, "x-");
  fem::solveStatics(model, 1.0, {.firstStep = 0.1});
  Vec3 mean;  // of the upper and lower edge of the end
  int count = 0;
  for (const int n : fem::nodeSet(mesh, "x+")) {
    const double y = mesh.X[static_cast<std::size_t>(n)].y;
    if (y != 0.0 && y != height) continue;
    mean += displacement(model, n);
    ++count;
  }
  mean *= 1.0 / count;
  return {mean.y, -mean.x};
}

TipOfBeam elastica(double alpha) {
  // Runge–Kutta steps from the root with curvature k; returns θ, θ', x and y of the tip.
  const auto shoot = [&](double k) {
    using State = std::array<double, 4>;
    const auto rate = [&](const State& s) {
      return State{s[1], -alpha * std::cos(s[0]), std::cos(s[0]), std::sin(s[0])};
    };
    constexpr int steps = 2000;
    constexpr double h = 1.0 / steps;
    State s = {0.0, k, 0.0, 0.0};
    const auto moved = [](const State& a, double factor, const State& b) {
      State c = a;
      for (std::size_t i = 0; i < 4; ++i) c[i] += factor * b[i];
      return c;
    };
    for (int i = 0; i < steps; ++i) {
      const State a = rate(s), b = rate(moved(s, h / 2, a)), c = rate(moved(s, h / 2, b)), d = rate(moved(s, h, c));
      for (std::size_t j = 0; j < 4; ++j) s[j] += h / 6.0 * (a[j] + 2.0 * b[j] + 2.0 * c[j] + d[j]);
    }
    return s;
  };
  double low = 0.0, high = alpha;  // the moment at the root is at most P L
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (shoot(middle)[1] < 0.0 ? low : high) = middle;
  }
  const auto end = shoot(low);
  return {end[3], 1.0 - end[2]};
}

}  // namespace dovetail::verification
