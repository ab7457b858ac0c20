#include "verification_cases.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/terms/loads.hpp"

namespace dovetail::verification {

namespace {

using fem::ElementShape;
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

const Vec3& displacement(const fem::Model& model, int node) { return model.nodes.u[static_cast<std::size_t>(node)]; }

std::shared_ptr<fem::Solid> addSolid(fem::Model& model, const fem::SolidMesh& mesh, const ElementKind& kind,
                                     std::shared_ptr<const fem::PointMaterial> material) {
  auto solid = fem::makeSolid(mesh, std::move(material), {.formulation = kind.formulation});
  model.add(solid);
  return solid;
}

/// −tr σ/3 of a point.
double pressureAt(const double* F, const double* P) {
  const double J =
      F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
  double trace = 0.0;  // of P Fᵀ = J σ
  for (int k = 0; k < 9; ++k) trace += P[k] * F[k];
  return -trace / (3.0 * J);
}

void addPressures(Membrane& result, const fem::Solid::Sample& sample, std::size_t elementsPerCell) {
  const auto cells = static_cast<std::size_t>(result.perEdge * result.perEdge);
  std::vector<double> volume(cells, 0.0);
  result.pressure.assign(cells, 0.0);
  result.place.assign(cells, {});
  for (std::size_t q = 0; q < sample.volume.size(); ++q) {
    const std::size_t cell = static_cast<std::size_t>(sample.element[q]) / elementsPerCell;
    result.pressure[cell] += sample.volume[q] * pressureAt(&sample.F[9 * q], &sample.P[9 * q]);
    result.place[cell] += sample.volume[q] * sample.X[q];
    volume[cell] += sample.volume[q];
  }
  for (std::size_t cell = 0; cell < cells; ++cell) {
    result.pressure[cell] /= volume[cell];
    result.place[cell] *= 1.0 / volume[cell];
  }
}

}  // namespace

std::string ElementKind::label() const {
  return std::string(name(shape)) + (shape == ElementShape::hex8 || formulation != Formulation::standard
                                         ? std::string(" ") + name(formulation)
                                         : "");
}

const std::vector<ElementKind>& allKinds() {
  static const std::vector<ElementKind> kinds = {{ElementShape::hex8, Formulation::standard},
                                                 {ElementShape::hex8, Formulation::meanDilatation},
                                                 {ElementShape::hex8, Formulation::enhanced},
                                                 {ElementShape::hex8, Formulation::reduced},
                                                 {ElementShape::hex20},
                                                 {ElementShape::hex27},
                                                 {ElementShape::hex20, Formulation::meanDilatation},
                                                 {ElementShape::hex27, Formulation::meanDilatation},
                                                 {ElementShape::tet4},
                                                 {ElementShape::tet10}};
  return kinds;
}

const std::vector<ElementKind>& planeKinds() {
  static const std::vector<ElementKind> kinds = {{ElementShape::quad4},
                                                 {ElementShape::quad4, Formulation::meanDilatation},
                                                 {ElementShape::quad8},
                                                 {ElementShape::quad8, Formulation::reduced},
                                                 {ElementShape::quad8, Formulation::meanDilatation}};
  return kinds;
}

Vec3 beamBehindCylinder(const ElementKind& kind, std::array<int, 2> cells, double shearModulus) {
  constexpr double poissonRatio = 0.4, density = 1000.0;
  // Stresses have no bound at the two corners of the root, so cells are small there.
  const fem::SolidMesh mesh =
      fem::arcClampedBeam(kind.shape, {cells[0], cells[1], 1}, {.grading = 15.0, .sideGrading = 0.8});
  fem::Model model = fem::makeModel(mesh);
  addSolid(
      model, mesh, kind,
      fem::pointMaterial(fem::StVenantKirchhoff{2.0 * shearModulus * (1.0 + poissonRatio), poissonRatio, density}));
  fem::addMass(model);
  model.add(fem::gravity([](double t) { return Vec3{0.0, -2.0 * t, 0.0}; }));
  holdInPlane(model);
  clampInPlane(model, mesh, "clamped");
  fem::solveStatics(model, 1.0, {.firstStep = 0.25});
  return displacement(model, fem::nodeSet(mesh, "tip").front());
}

Membrane cooksMembrane(const ElementKind& kind, int perEdge, double poissonRatio, Sides sides, MembraneLaw law,
                       double force) {
  constexpr double thickness = 1e-3, height = 16e-3, mu = shearModulusOfMembrane;
  const double young = 2.0 * mu * (1.0 + poissonRatio), kappa = young / (3.0 * (1.0 - 2.0 * poissonRatio));
  const fem::SolidMesh mesh = fem::cookMembrane(kind.shape, {perEdge, perEdge}, thickness);
  fem::Model model = fem::makeModel(mesh);
  const auto solid = addSolid(model, mesh, kind,
                              law == MembraneLaw::neoHookean
                                  ? fem::pointMaterial(fem::NeoHookean{kappa, mu, 1000.0})
                                  : fem::pointMaterial(fem::StVenantKirchhoff{young, poissonRatio, 1000.0}));
  model.add(
      fem::deadTraction(mesh, fem::faceSet(mesh, "loaded"), {0.0, force / (thickness * height), 0.0}, proportional));
  if (sides == Sides::held) {
    holdInPlane(model);
    clampInPlane(model, mesh, "clamped");
  } else {
    model.constraints.hold(fem::nodeSet(mesh, "clamped"));
  }
  fem::solveStatics(model, 1.0, {.firstStep = 0.25});
  Membrane result;
  result.perEdge = perEdge;
  result.tip = displacement(model, fem::nodeSet(mesh, "tip").front()).y;
  const auto cells = static_cast<std::size_t>(perEdge * perEdge);
  addPressures(result, solid->sample(model.nodes, {model.t, 0.0}), mesh.elementCount() / cells);
  return result;
}

PressureSteps pressureSteps(const Membrane& membrane, double away) {
  const int n = membrane.perEdge;
  const auto at = [&](int i, int j) { return membrane.pressure[static_cast<std::size_t>(i + n * j)]; };
  const auto counts = [&](int i, int j) {
    Vec3 X = membrane.place[static_cast<std::size_t>(i + n * j)];
    X.z = 0.0;
    return norm(X) > away && norm(X - Vec3{0.0, 44e-3, 0.0}) > away;
  };
  double least = 1e300, most = -1e300, largest = 0.0, alternating = 0.0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      if (!counts(i, j)) continue;
      least = std::min(least, at(i, j));
      most = std::max(most, at(i, j));
      if (i > 0 && counts(i - 1, j)) largest = std::max(largest, std::abs(at(i, j) - at(i - 1, j)));
      if (j > 0 && counts(i, j - 1)) largest = std::max(largest, std::abs(at(i, j) - at(i, j - 1)));
      if (i == 0 || j == 0 || i == n - 1 || j == n - 1) continue;
      // Nothing is left of a bilinear field; of (−1)^(i + j) all of it.
      double sum = 4.0 * at(i, j);
      for (const int d : {-1, 1}) sum += at(i - d, j - d) + at(i - d, j + d) - 2.0 * (at(i - d, j) + at(i, j - d));
      alternating = std::max(alternating, std::abs(sum) / 16.0);
    }
  return {most - least, largest / (most - least), alternating / (most - least)};
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
